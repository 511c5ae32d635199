"""The tree that frames and their parents make, if they make one."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence

    from graph.data import FrameRow


class TreeLine(NamedTuple):
    """One line of the drawn tree."""

    frame: str
    parent: str
    """Empty for a root."""
    heard: tuple[FrameRow, ...]
    """The frame in this parent: none for a root, two if it comes on both topics."""
    last: tuple[bool, ...]
    """For itself and each frame above it, the root excluded: whether no sibling follows."""
    again: bool = False
    """Whether its children are drawn elsewhere: below its other parent, or it closes a loop."""

    @property
    def branch(self) -> str:
        """The lines that lead to it, two characters for each level."""
        if not self.last:
            return ""
        above = "".join("  " if last else "│ " for last in self.last[:-1])
        return above + ("└ " if self.last[-1] else "├ ")


class FrameTree:
    """Frames by their parents; there may be several trees, and loops."""

    def __init__(self, heard: Iterable[FrameRow]) -> None:
        """Build it of every frame in each of its parents; a frame without a name is left out."""
        self.edges: dict[tuple[str, str], tuple[FrameRow, ...]] = {}
        """Parent and child to what was heard of it."""
        for one in heard:
            edge = (one.newest.parent, one.newest.child)
            if all(edge) and edge[0] != edge[1]:
                self.edges[edge] = (*self.edges.get(edge, ()), one)
        self.parents = _grouped((child, parent) for parent, child in self.edges)
        """Frame to its parents, roots excluded."""
        self.children = _grouped(self.edges)
        """Parent to its children."""
        self.frames = frozenset(self.parents) | frozenset(self.children)
        self.loops = _loops(self.parents)
        """Frames that are their own ancestors, each loop from parent to child."""
        self.roots = self._sorted_roots()
        """Where the drawing begins, the largest tree first; a loop without a root has one, too."""
        self.parts = self._parts()
        """Of each part that nothing joins to the others, the first root."""

    def root_of(self, frame: str) -> str:
        """Return the last of its ancestors, by the first parent of each."""
        seen = {frame}
        while (above := self.parents.get(frame)) and above[0] not in seen:
            frame = above[0]
            seen.add(frame)
        return frame

    def with_ancestors(self, frames: Iterable[str]) -> frozenset[str]:
        """Return these frames and all above them, by each of their parents."""
        found: set[str] = set()
        waiting = list(frames)
        while waiting:
            frame = waiting.pop()
            if frame not in found:
                found.add(frame)
                waiting += self.parents.get(frame, ())
        return frozenset(found)

    def lines(self, only: Collection[str] | None = None) -> list[TreeLine]:
        """Return the drawn tree, each root followed by what is below it; or `only` some frames."""
        drawn: set[str] = set()
        found: list[TreeLine] = []
        shown = self.frames if only is None else only
        waiting = [TreeLine(root, "", (), ()) for root in reversed(self.roots) if root in shown]
        # Not by recursion: an arm of two thousand joints must not end Deck.
        while waiting:
            line = waiting.pop()
            if line.frame in drawn:
                found.append(line._replace(again=bool(self.children.get(line.frame))))
                continue
            drawn.add(line.frame)
            found.append(line)
            below = [child for child in self.children.get(line.frame, ()) if child in shown]
            waiting += [
                TreeLine(child, line.frame, self.edges[line.frame, child], (*line.last, number == len(below) - 1))
                for number, child in reversed(list(enumerate(below)))
            ]
        return found

    def _sorted_roots(self) -> tuple[str, ...]:
        below = {root: self._below(root) for root in self.frames - self.parents.keys()}
        reached = frozenset[str]().union(*below.values())
        for loop in self.loops:
            if reached.isdisjoint(loop):
                below[loop[0]] = self._below(loop[0])
                reached |= below[loop[0]]
        return tuple(sorted(below, key=lambda root: (-len(below[root]), root)))

    def _parts(self) -> tuple[str, ...]:
        # A frame with two parents joins their trees, in its own bad way.
        found, seen = [], set[str]()
        for root in self.roots:
            if root in seen:
                continue
            found.append(root)
            seen.add(root)
            waiting = [root]
            while waiting:
                frame = waiting.pop()
                near = {*self.children.get(frame, ()), *self.parents.get(frame, ())} - seen
                seen |= near
                waiting += near
        return tuple(found)

    def _below(self, frame: str) -> frozenset[str]:
        found, waiting = {frame}, [frame]
        while waiting:
            for child in self.children.get(waiting.pop(), ()):
                if child not in found:
                    found.add(child)
                    waiting.append(child)
        return frozenset(found)


def _grouped(pairs: Iterable[tuple[str, str]]) -> dict[str, tuple[str, ...]]:
    found: dict[str, list[str]] = {}
    for key, value in pairs:
        found.setdefault(key, []).append(value)
    return {key: tuple(sorted(values)) for key, values in found.items()}


def _loops(parents: Mapping[str, Sequence[str]]) -> tuple[tuple[str, ...], ...]:
    """Return each loop once, beginning with its first name; of loops that touch, one at least."""
    found: list[tuple[str, ...]] = []
    done: set[str] = set()
    for start in sorted(parents):
        way: list[str] = []
        places: dict[str, int] = {}
        # Depth first: the frames on the way to `start`, and for each the parents still to be tried.
        trying = [iter((start,))]
        while trying:
            frame = next(trying[-1], None)
            if frame is None:
                trying.pop()
                if way:
                    done.add(left := way.pop())
                    del places[left]
            elif frame in places:
                found.append(_from_its_first(way[places[frame] :][::-1]))
            elif frame not in done:
                places[frame] = len(way)
                way.append(frame)
                trying.append(iter(parents.get(frame, ())))
    return tuple(dict.fromkeys(found))


def _from_its_first(loop: list[str]) -> tuple[str, ...]:
    at = loop.index(min(loop))
    return (*loop[at:], *loop[:at])
