"""Places in the graph that the user can go to, and the way back."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, NamedTuple

from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Mapping


class GraphKind(str, Enum):
    """The kind of a place."""

    NODE = "node"
    SERVICE = "service"
    ACTION = "action"
    TYPE = "type"
    TOPIC = "topic"
    FINDING = "finding"


LISTED = (*(GraphKind.NODE, GraphKind.SERVICE, GraphKind.ACTION, GraphKind.TYPE), GraphKind.FINDING)
"""The kinds that the Graph screen itself lists; topics have their own screen."""

TITLES = {
    GraphKind.NODE: N_("Nodes"),
    GraphKind.SERVICE: N_("Services"),
    GraphKind.ACTION: N_("Actions"),
    GraphKind.TYPE: N_("Types"),
    GraphKind.FINDING: N_("Findings"),
}
"""The titles of the tabs."""


class GraphPlace(NamedTuple):
    """A thing in the graph, by its full name."""

    kind: GraphKind
    name: str

    def key(self, section: str = "") -> str:
        """Return the key of a row that links there; `section` tells rows with one target apart."""
        return f"{section}|{self.kind.value}|{self.name}"

    @classmethod
    def of_key(cls, key: str) -> GraphPlace | None:
        """Return the place that the row with this key links to, None if it is not a link."""
        _section, _bar, rest = key.partition("|")
        kind, bar, name = rest.partition("|")
        return cls(GraphKind(kind), name) if bar and name else None


LONGEST = 100


class PlaceHistory:
    """The last chosen place of every kind, and the places from which links were followed."""

    def __init__(self) -> None:
        self.kind = GraphKind.NODE
        """The kind that is listed."""
        self._chosen: dict[GraphKind, str] = {}
        self._been: list[GraphPlace] = []

    @property
    def here(self) -> GraphPlace | None:
        name = self._chosen.get(self.kind, "")
        return GraphPlace(self.kind, name) if name else None

    @property
    def chosen(self) -> Mapping[GraphKind, str]:
        return self._chosen

    def choose(self, name: str) -> None:
        """Choose another place of the same kind, without adding to the history."""
        self._chosen[self.kind] = name

    def go(self, place: GraphPlace) -> None:
        """Follow a link; `back` returns from it."""
        here = self.here
        if here is not None and here != place:
            self._been = [*self._been, here][-LONGEST:]
        self._set(place)

    def back(self) -> bool:
        """Return to where the last link was followed; False if there is none."""
        if self._been:
            self._set(self._been.pop())
            return True
        return False

    def forget(self) -> None:
        self._chosen.clear()
        self._been.clear()

    def _set(self, place: GraphPlace) -> None:
        self.kind = place.kind
        self._chosen[place.kind] = place.name
