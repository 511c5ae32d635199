"""A place in the graph that one can go to: a node, a service, an action, a type, a topic."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from text.i18n import N_


class Kind(str, Enum):
    """What stands there."""

    NODE = "node"
    SERVICE = "service"
    ACTION = "action"
    TYPE = "type"
    TOPIC = "topic"


LISTED = (Kind.NODE, Kind.SERVICE, Kind.ACTION, Kind.TYPE)
"""The kinds that the screen of the graph lists itself; topics have a screen of their own."""

TITLES = {
    Kind.NODE: N_("Nodes"),
    Kind.SERVICE: N_("Services"),
    Kind.ACTION: N_("Actions"),
    Kind.TYPE: N_("Types"),
}
"""As the tab of the list says it."""


class Place(NamedTuple):
    """One of them by its full name."""

    kind: Kind
    name: str

    def key(self, section: str = "") -> str:
        """Return the key of a row that leads there; `section` tells rows with one aim apart."""
        return f"{section}|{self.kind.value}|{self.name}"

    @classmethod
    def of_key(cls, key: str) -> Place | None:
        """Return where the row of this key leads, None for a row that leads nowhere."""
        _section, _bar, rest = key.partition("|")
        kind, bar, name = rest.partition("|")
        return cls(Kind(kind), name) if bar and name else None
