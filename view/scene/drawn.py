"""What a message becomes: archetypes of Rerun at a place in its tree of entities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from space.reading.fields import NotDrawnError, frame
from text.plain import plain

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

LONGEST_NAME = 200
IMPLICIT = "tf#"
"""Rerun's own names of frames begin with it."""
WORLD = "tf#/"
"""The frame of the 3D view, in which the roots of the trees of frames are put."""

SPACE = "space"
"""The root of what is drawn in 3D, apart from frames, markers and the robot itself."""

Message: TypeAlias = "Mapping[str, Any]"
"""A decoded message, see `graph.data.Value`."""


@dataclass(frozen=True)
class Drawn:
    """What is logged at one entity; later ones replace it."""

    path: tuple[str, ...]
    shapes: tuple[Any, ...]
    """Archetypes of Rerun."""
    frame: str = ""
    """The frame they are given in, empty for what is in none."""
    static: bool = False
    """Whether it holds for all times, and is kept however long the viewer runs."""
    recursive: bool = False
    """Whether `shapes` is empty and everything below is removed."""
    lifetime_s: float = 0.0
    """After so long it is removed; 0 for what is kept."""


def frame_name(text: object) -> str:
    """Return a frame's name as it is shown, without a leading slash."""
    name = plain(str(text).lstrip("/"), LONGEST_NAME)
    return f"_{name}" if name.startswith(IMPLICIT) else name


def frame_of(message: Message) -> str:
    """Return the frame in the header of a message. Raises NotDrawnError without one."""
    return frame_name(frame(message))


def each(parts: Iterable[Message], read: Callable[[Message], Iterator[Drawn]]) -> Iterator[Drawn]:
    """Yield what every part draws. Raises NotDrawnError at the end, if one draws nothing."""
    fault: NotDrawnError | None = None
    for part in parts:
        try:
            yield from read(part)
        except NotDrawnError as error:  # noqa: PERF203
            fault = error
    if fault is not None:
        raise fault


def topic_path(root: str, topic: str, *more: str) -> tuple[str, ...]:
    """Return the entity of a topic below `root`."""
    return (root, *(part for part in topic.split("/") if part), *more)
