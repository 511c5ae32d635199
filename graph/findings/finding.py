"""A finding: how bad it is, where, what is wrong, and what to do about it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import Literal, NamedTuple

PlaceKind = Literal["topic", "service", "action", "node"]
SETTLED_S = 4.0
"""A graph in which nodes start or end looks wrong for a moment: who is still to come is missing."""
FORGOTTEN_S = 25.0
"""For so long the middleware may still report the endpoints of a node that was killed."""


class FindingLevel(IntEnum):
    """How bad a finding is; the worst is the least."""

    ERROR = 0
    """Something does not arrive, or two things contradict each other."""
    WARNING = 1
    """It works, but not reliably; or it is most likely a mistake."""


class FindingPlace(NamedTuple):
    """The thing in the graph that a finding is about, by its full name."""

    kind: PlaceKind
    name: str


@dataclass(frozen=True)
class GraphFinding:
    """One thing that is wrong with the graph."""

    level: FindingLevel
    rule: str
    """A stable key for programs: `two-types`."""
    place: FindingPlace
    what: str
    """What is wrong, a sentence (`text.sentences.say`)."""
    mend: str
    """What to do about it, a sentence."""
    nodes: tuple[str, ...] = ()
    """Full names of the nodes that take part in it."""
    settled_s: float = SETTLED_S
    """It is only told once it has held for so long."""

    @property
    def key(self) -> str:
        """Tell it apart from all others of one graph."""
        return f"{self.rule} {self.place.kind} {self.place.name}"

    @property
    def rank(self) -> tuple[int, str, str]:
        """Sort by this: the worst first, then by place."""
        return int(self.level), self.place.name, self.rule


def _moves_nothing(_topic: str, _type_name: str) -> bool:
    return False


@dataclass(frozen=True)
class GraphNorms:
    """What is normal in the graph of this robot, as plain data: `graph` knows no robot."""

    moves: Callable[[str, str], bool] = _moves_nothing
    """Whether a topic of this name and type commands the robot: it may rest, or wait for somebody,
    but two must not command at once."""
    sole: frozenset[str] = frozenset()
    """Topics that must not even have a second publisher."""
    of_many: frozenset[str] = frozenset()
    """Topics that many publish together, each a part."""
    may_wait: frozenset[str] = frozenset()
    """Other topics that nobody need publish."""
