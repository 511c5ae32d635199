"""Places in the graph that the user can go to, and the way back."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from text.i18n import N_


class GraphKind(str, Enum):
    """The kind of a place."""

    NODE = "node"
    SERVICE = "service"
    ACTION = "action"
    TYPE = "type"
    TOPIC = "topic"
    FINDING = "finding"


TITLES = {
    GraphKind.NODE: N_("Nodes"),
    GraphKind.SERVICE: N_("Services"),
    GraphKind.ACTION: N_("Actions"),
    GraphKind.TYPE: N_("Types"),
    GraphKind.FINDING: N_("Findings"),
}
"""The kinds that the Graph screen itself lists, and the titles of their tabs; topics have their own screen."""
LISTED = (*TITLES,)


class GraphPlace(NamedTuple):
    """A thing in the graph, by its full name."""

    kind: GraphKind
    name: str

    def key(self, section: str = "") -> str:
        """Return the key of a row that links there; `section` tells rows with one target apart."""
        return f"{section}|{self.kind.value}|{self.name}"

    @classmethod
    def of_key(cls, key: str) -> GraphPlace | None:
        _section, _bar, rest = key.partition("|")
        kind, bar, name = rest.partition("|")
        return cls(GraphKind(kind), name) if bar and name else None


LONGEST = 100


class PlaceHistory:
    """The last chosen place of every kind, and the places from which links were followed."""

    def __init__(self) -> None:
        self.kind = GraphKind.NODE
        """The kind that is listed."""
        self.chosen: dict[GraphKind, str] = {}
        self._been: list[GraphPlace] = []

    @property
    def here(self) -> GraphPlace | None:
        name = self.chosen.get(self.kind, "")
        return GraphPlace(self.kind, name) if name else None

    def choose(self, name: str) -> None:
        """Choose another place of the same kind, without adding to the history."""
        self.chosen[self.kind] = name

    def go(self, place: GraphPlace) -> None:
        here = self.here
        if here is not None and here != place:
            self._been = [*self._been, here][-LONGEST:]
        self.kind, self.chosen[place.kind] = place

    def back(self) -> bool:
        """Return to where the last link was followed; False if there is none."""
        if not self._been:
            return False
        place = self._been.pop()
        self.kind, self.chosen[place.kind] = place
        return True

    def forget(self) -> None:
        self.chosen.clear()
        self._been.clear()
