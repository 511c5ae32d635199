"""Places in the graph that one can go to, and where one has been, to go back."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, NamedTuple

from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Mapping


class GraphKind(str, Enum):
    """What stands there."""

    NODE = "node"
    SERVICE = "service"
    ACTION = "action"
    TYPE = "type"
    TOPIC = "topic"


LISTED = (GraphKind.NODE, GraphKind.SERVICE, GraphKind.ACTION, GraphKind.TYPE)
"""The kinds that the screen of the graph lists itself; topics have a screen of their own."""

TITLES = {
    GraphKind.NODE: N_("Nodes"),
    GraphKind.SERVICE: N_("Services"),
    GraphKind.ACTION: N_("Actions"),
    GraphKind.TYPE: N_("Types"),
}
"""As the tab of the list says it."""


class GraphPlace(NamedTuple):
    """One of them by its full name."""

    kind: GraphKind
    name: str

    def key(self, section: str = "") -> str:
        """Return the key of a row that leads there; `section` tells rows with one aim apart."""
        return f"{section}|{self.kind.value}|{self.name}"

    @classmethod
    def of_key(cls, key: str) -> GraphPlace | None:
        """Return where the row of this key leads, None for a row that leads nowhere."""
        _section, _bar, rest = key.partition("|")
        kind, bar, name = rest.partition("|")
        return cls(GraphKind(kind), name) if bar and name else None


LONGEST = 100


class PlaceHistory:
    """The place of every kind that was chosen last, and the places that a link led away from."""

    def __init__(self) -> None:
        self.kind = GraphKind.NODE
        """What is listed."""
        self._chosen: dict[GraphKind, str] = {}
        self._been: list[GraphPlace] = []

    @property
    def here(self) -> GraphPlace | None:
        """The chosen place."""
        name = self._chosen.get(self.kind, "")
        return GraphPlace(self.kind, name) if name else None

    @property
    def chosen(self) -> Mapping[GraphKind, str]:
        """What was chosen last of each kind."""
        return self._chosen

    def choose(self, name: str) -> None:
        """Choose another of the same kind, as one does who walks down the list."""
        self._chosen[self.kind] = name

    def go(self, place: GraphPlace) -> None:
        """Follow a link; `back` returns from there."""
        here = self.here
        if here is not None and here != place:
            self._been = [*self._been, here][-LONGEST:]
        self._set(place)

    def back(self) -> bool:
        """Return to where the newest link was followed; False if there is none."""
        if self._been:
            self._set(self._been.pop())
            return True
        return False

    def forget(self) -> None:
        """Begin anew."""
        self._chosen.clear()
        self._been.clear()

    def _set(self, place: GraphPlace) -> None:
        self.kind = place.kind
        self._chosen[place.kind] = place.name
