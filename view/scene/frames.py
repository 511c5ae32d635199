"""The tree of frames: every transform as the place of a frame, with its axes and its name.

Rerun takes the place of a frame from one entity only, so that of a root, which nobody publishes, is
reported at the entity of its transform.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from space.reading.fields import NotDrawnError, field, listed, transform
from text.sentences import reason_of, say
from view.scene.drawn import WORLD, Drawn, each, frame_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from view.scene.drawn import Message

FRAMES = "frames"
"""The root of all frames in the tree of entities."""
AXIS_M = 0.08


class Frames:
    """All frames that have been heard of."""

    def __init__(self) -> None:
        self._parents: dict[str, str] = {}
        self._shown: set[str] = set()

    def moved(self, topic: str, message: Message) -> Iterator[Drawn]:
        """Yield the transforms of a message of /tf. Raises NotDrawnError."""
        del topic
        return each(listed(message, "transforms"), partial(self._joined, static=False))

    def fixed(self, topic: str, message: Message) -> Iterator[Drawn]:
        """Yield those of /tf_static, which hold for all times. Raises NotDrawnError."""
        del topic
        return each(listed(message, "transforms"), partial(self._joined, static=True))

    def need(self, frame: str) -> list[Drawn]:
        """Return what puts a frame into the view that no transform has named so far."""
        return [*self._axes(frame), _root(frame)] if frame not in self._shown else []

    def roots(self) -> list[Drawn]:
        """Return what keeps the roots in the view: told again, as a viewer forgets what is old."""
        return [_root(frame) for frame in sorted(self._shown - self._parents.keys())]

    def _joined(self, value: Message, *, static: bool) -> Iterator[Drawn]:
        import rerun

        parent = frame_name(field(value, "header.frame_id"))
        child = frame_name(field(value, "child_frame_id"))
        self._check(parent, child)
        try:
            at = transform(value, "transform")
        except NotDrawnError as error:
            raise NotDrawnError(
                say("{child} in {parent}: {reason}", child=child, parent=parent, reason=reason_of(error))
            ) from None
        self._parents[child] = parent
        place = rerun.Transform3D(
            translation=at.translation, quaternion=at.rotation, parent_frame=parent, child_frame=child
        )
        yield from self.need(parent)
        yield from self._axes(child)
        yield Drawn((FRAMES, child), (place,), static=static)

    def _check(self, parent: str, child: str) -> None:
        if not parent or not child or parent == child:
            raise NotDrawnError(
                say("a transform from '{parent}' to '{child}' joins no two frames", parent=parent, child=child)
            )
        if self._would_close_a_loop(parent, child):
            raise NotDrawnError(
                say(
                    "{child} in {parent} closes a loop of frames: nobody knows where they are",
                    child=child,
                    parent=parent,
                )
            )

    def _would_close_a_loop(self, parent: str, child: str) -> bool:
        above: str | None = parent
        while above is not None and above != child:
            above = self._parents.get(above)
        return above == child

    def _axes(self, frame: str) -> Iterator[Drawn]:
        import rerun

        if frame not in self._shown:
            self._shown.add(frame)
            axes = rerun.TransformAxes3D(AXIS_M, show_frame=True)
            yield Drawn((FRAMES, frame), (axes,), frame=frame, static=True)


def newest_of(messages: Sequence[Message]) -> Message:
    """Return one message with the newest transform of every frame in these, oldest first."""
    found = {str(one["child_frame_id"]): one for message in messages for one in message["transforms"]}
    return {"transforms": list(found.values())}


def _root(frame: str) -> Drawn:
    import rerun

    place = rerun.Transform3D(parent_frame=WORLD, child_frame=frame)
    return Drawn((FRAMES, frame), (place,))
