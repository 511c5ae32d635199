"""Where every frame was over the last seconds, and where one of them is in another.

It answers as tf2 does (tf2::BufferCore): the newest answer is that of the newest time at which the
whole way is known; between two times it interpolates, and beyond what it knows it refuses.
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass
from typing import TYPE_CHECKING

from space.transform import IDENTITY, Transform
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterable

KEEP_S = 10.0
"""As long as tf2 does."""


class NoTransformError(Exception):
    """Why a frame cannot be given in another; its text is a sentence for the user."""


@dataclass(frozen=True)
class Stamped:
    """Where a frame was in its parent at one time."""

    parent: str
    child: str
    stamp_s: float
    """By the publisher's clock."""
    transform: Transform
    static: bool = False
    """A static one holds for all times."""


class TransformBuffer:
    """The history of every frame; frame names are without a leading slash."""

    def __init__(self, keep_s: float = KEEP_S) -> None:
        """Keep transforms until newer ones of the same frame are `keep_s` younger."""
        self._keep_s = keep_s
        self._frames: dict[str, _History] = {}

    def add(self, found: Iterable[Stamped]) -> None:
        """Keep transforms; one of a time that is known already replaces it."""
        for one in found:
            history = self._frames.get(one.child)
            if history is None or history.static != one.static:
                history = self._frames[one.child] = _History(one.static)
            history.add(one, self._keep_s)

    def clear(self) -> None:
        self._frames.clear()

    @property
    def frames(self) -> frozenset[str]:
        """The names of all frames, roots as well."""
        return frozenset(self._frames) | {history.newest.parent for history in self._frames.values()}

    def newest(self, frame: str) -> Stamped | None:
        """Return where a frame is in its parent; None for a root or an unknown frame."""
        history = self._frames.get(frame)
        return history.newest if history else None

    def way_up(self, frame: str) -> list[str]:
        """Return a frame, its parent and so on up to the root; a loop ends before it closes."""
        way = {frame: None}
        while (history := self._frames.get(frame)) and history.newest.parent not in way:
            frame = history.newest.parent
            way[frame] = None
        return list(way)

    def find(self, target: str, source: str, time_s: float | None = None) -> Transform:
        """Return where `source` is in `target`: what turns its coordinates into the target's.

        Without a time, it is that of the newest time at which the whole way is known. Raises
        NoTransformError.
        """
        if target == source:
            return IDENTITY
        up, across = self._way(target, source)
        if time_s is None:
            moving = [self._frames[step] for step in (*up, *across) if not self._frames[step].static]
            time_s = min((history.newest.stamp_s for history in moving), default=0.0)
        return self._along(across, time_s).inverse() @ self._along(up, time_s)

    def _way(self, target: str, source: str) -> tuple[list[str], list[str]]:
        """Return the frames from each of both up to, but without, the one they share."""
        known = self.frames
        for frame in (target, source):
            if frame not in known:
                raise NoTransformError(say("there is no frame {frame}", frame=frame))
        from_source, from_target = self.way_up(source), self.way_up(target)
        meeting = next((step for step in from_source if step in from_target), None)
        if meeting is None:
            raise NoTransformError(
                say(
                    "{source} and {target} are in two trees: nothing joins {first} and {second}",
                    source=source,
                    target=target,
                    first=from_source[-1],
                    second=from_target[-1],
                )
            )
        return (from_source[: from_source.index(meeting)], from_target[: from_target.index(meeting)])

    def _along(self, steps: list[str], time_s: float) -> Transform:
        whole = IDENTITY
        for step in steps:
            whole = self._frames[step].at(time_s) @ whole
        return whole


class _History:
    """One frame over time, oldest first; a static frame has one place for all times."""

    def __init__(self, static: bool) -> None:
        self.static = static
        self._stamps: list[float] = []
        self._found: list[Stamped] = []

    @property
    def newest(self) -> Stamped:
        return self._found[-1]

    def add(self, one: Stamped, keep_s: float) -> None:
        if self.static:
            self._found = [one]
            return
        if self._found and one.parent != self.newest.parent:
            # Where it was in the other parent is of no use for a place between the two.
            self._stamps, self._found = [], []
        at = bisect_left(self._stamps, one.stamp_s)
        if at < len(self._stamps) and self._stamps[at] == one.stamp_s:
            self._found[at] = one
            return
        self._stamps.insert(at, one.stamp_s)
        self._found.insert(at, one)
        old = bisect_left(self._stamps, self._stamps[-1] - keep_s)
        del self._stamps[:old], self._found[:old]

    def at(self, time_s: float) -> Transform:
        """Return where it was; raises NoTransformError beyond what is known."""
        if self.static or time_s == self._stamps[-1]:
            return self.newest.transform
        at = bisect_left(self._stamps, time_s)
        if at in {0, len(self._stamps)} and self._stamps[at % len(self._stamps)] != time_s:
            raise NoTransformError(
                say(
                    "where {frame} was is known for {first} s to {last} s, and not for {asked} s",
                    frame=self.newest.child,
                    first=f"{self._stamps[0]:.3f}",
                    last=f"{self._stamps[-1]:.3f}",
                    asked=f"{time_s:.3f}",
                )
            )
        after = self._found[at]
        if after.stamp_s == time_s:
            return after.transform
        before = self._found[at - 1]
        share = (time_s - before.stamp_s) / (after.stamp_s - before.stamp_s)
        return before.transform.between(after.transform, share)
