"""A finding: how bad it is, where, what is wrong, and what to do about it; and how names stand in it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from functools import lru_cache
from typing import TYPE_CHECKING, Literal, NamedTuple

from graph.data import NAMELESS
from graph.ros import NAME_PREFIX
from text.plain import plain
from text.sentences import say
from text.suggestions import near

if TYPE_CHECKING:
    from collections.abc import Iterable


PlaceKind = Literal["topic", "service", "action", "node", "frame"]
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
    """One thing that is wrong with the graph, or with its frames."""

    level: FindingLevel
    rule: str
    """A stable key for programs: `two-types`."""
    place: FindingPlace
    what: str
    """What is wrong, a sentence (`text.sentences.say`)."""
    mend: str
    """What to do about it, a sentence."""
    nodes: tuple[str, ...] = ()
    """Full names of the nodes that take part in it; the frames that it is about."""
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


MOST = 4
"""Names that are written out; the others are only counted."""
LONGEST = 60
"""Characters of a name in a sentence."""
ALIKE = 0.75
"""How similar two words are of which one may be the other mistyped: `frnt` and `front` are 0.89,
`rear` and `front` 0.22, `left` and `right` 0.22."""
_WORDS = re.compile(r"[/_]+")
_DIGITS = re.compile(r"\d+")


def is_deck(node: str) -> bool:
    """Return whether a node is that of another screen or command of Deck's."""
    return node.startswith(f"/{NAME_PREFIX}")


def listed(names: Iterable[str]) -> str:
    """Return names for a sentence, each once, with the number of its endpoints if several."""
    counted = Counter(names)
    nameless = sum(counted.pop(name) for name in list(counted) if name.endswith(NAMELESS))
    words = [plain(name, LONGEST) + (f" ×{count}" if count > 1 else "") for name, count in sorted(counted.items())]
    more = len(words) - MOST
    told = ", ".join(words[:MOST]) + (f" +{more}" if more > 0 else "")
    if not nameless:
        return told
    if not told:
        return say("a program without a node's name")
    return say("{nodes} and a program without a node's name", nodes=told)


def meant(name: str, known: Iterable[str]) -> str:
    """Return the known name of which `name` may be a misspelling; empty if there is none.

    Names that differ in a number, or in a whole word, are different things: `left` and `right`.
    """
    scored = sorted((score, other) for other in known if other != name and (score := _likeness(name, other)) > 0.0)
    return scored[-1][1] if scored else ""


def _words(name: str) -> list[str]:
    return [word for word in _WORDS.split(name.casefold()[: 4 * LONGEST]) if word]


@lru_cache(maxsize=1 << 16)
def _likeness(name: str, known: str) -> float:
    """Return how alike two names are, 0 if they do not mean the same, 1 at most.

    The same pairs are asked for with every update of the graph.
    """
    one, other = _words(name), _words(known)
    if one == other or "".join(one) == "".join(other):
        return 1.0
    if len(one) == len(other):
        differing = [pair for pair in zip(one, other, strict=True) if pair[0] != pair[1]]
        if all(_mistyped(*pair) for pair in differing):
            return 1.0 - 0.5 * len(differing) / len(one)
        return 0.0
    short, long = sorted((one, other), key=len)
    # The same name in another namespace: /scan and /robot/scan.
    return 0.25 if long[-len(short) :] == short else 0.0


def _mistyped(one: str, other: str) -> bool:
    if _DIGITS.sub("", one) == _DIGITS.sub("", other):
        return False
    return bool(near(one, [other], cutoff=ALIKE))
