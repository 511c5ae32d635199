"""The graph by kind: what is listed, what is wrong with it, how it is searched, and where the user is and was."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Mapping
from enum import Enum
from typing import TYPE_CHECKING, NamedTuple

from graph.data import ActionRow, GraphUpdate, ServiceRow, TopicRow
from graph.findings.finding import FindingLevel, GraphFinding
from graph.findings.rules import LastingFindings
from graph.housekeeping import is_housekeeping
from launcher.status import NodeState, NodeStatus
from text.i18n import N_, _, localized
from tui import clock
from tui.session.bypass import NORMS

if TYPE_CHECKING:
    Typed = TopicRow | ServiceRow | ActionRow


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


LOOKS = {FindingLevel.ERROR: ("✗", N_("error"), "bad"), FindingLevel.WARNING: ("▲", N_("warning"), "warn")}
"""Sign, word and meaning (`tui.widgets.rows.Cell`) of a level."""
_TITLES = {
    "clock": N_("another clock"),
    "failed": N_("has failed"),
    "clock-mix": N_("two kinds of time"),
    "fight": N_("publishers that fight"),
    "lost": N_("messages are lost"),
    "namesakes": N_("nodes with one name"),
    "near-name": N_("name nearly matches"),
    "no-clock": N_("no simulated time"),
    "qos": N_("incompatible QoS"),
    "silent": N_("has fallen silent"),
    "two-types": N_("types do not agree"),
    "unfed": N_("nobody publishes"),
    "unknown-type": N_("unknown type"),
    "unserved": N_("nobody serves"),
}


def failures_of(nodes: Iterable[NodeStatus]) -> dict[str, str]:
    return {f"/{node.name}": node.detail for node in nodes if node.state is NodeState.FAILED}


def head_words(finding: GraphFinding) -> str:
    """Return how bad it is and what it is: `✗ error · nobody serves`."""
    sign, word, _meaning = LOOKS[finding.level]
    return f"{sign} {_(word)} · {_(_TITLES[finding.rule])}"


class GraphEntry(NamedTuple):
    """One line of the list."""

    name: str
    detail: str = ""
    """Its type, or for a type the number of its users."""
    housekeeping: bool = False
    label: str = ""
    remark: str = ""
    meaning: str = ""
    """Of its colour, as in `tui.widgets.rows.Cell`."""


class GraphIndex:
    """Everything of each kind, and which of it is listed."""

    def __init__(self) -> None:
        self.everything = False
        """Whether what belongs to ROS itself is listed."""
        self.listed: dict[GraphKind, list[GraphEntry]] = {kind: [] for kind in LISTED}
        self.findings: tuple[GraphFinding, ...] = ()
        """What is wrong with the graph, once it has held for long enough; the worst first."""
        self._lasting = LastingFindings(NORMS)
        self._installed: tuple[str, ...] = ()
        """Every type installed on this computer, once it has been requested."""

    def take(self, update: GraphUpdate | None, failures: Mapping[str, str]) -> None:
        """Use this graph from now on; None if the session has ended.

        `failures`: nodes that have ended for good, and why.
        """
        self.listed |= {kind: [] for kind in LISTED} if update is None else entries(update, self._installed)
        if update is None:
            self._lasting.forget()
        else:
            self._lasting.take(update, clock.steady(), failures)
        self.settle()

    def settle(self) -> bool:
        """List findings that have held for long enough by now; return whether that changed any."""
        before, self.findings = self.findings, self._lasting.told(clock.steady())
        self.listed[GraphKind.FINDING] = [_finding(one) for one in self.findings]
        return before != self.findings

    def finding(self, key: str) -> GraphFinding | None:
        return next((one for one in self.findings if one.key == key), None)

    async def find_installed(self) -> None:
        """Find installed types that nobody uses, for the next `take`."""
        from graph.messages.browse import interfaces

        self._installed = await asyncio.to_thread(interfaces)

    def fitting(self, kind: GraphKind, words: str = "") -> list[GraphEntry]:
        return chosen_of(self.listed[kind], words, everything=self.everything)

    def reveal(self, place: GraphPlace, words: str) -> bool:
        """Make sure that a place is listed; return whether it also matches these words."""
        entry = next((one for one in self.listed[place.kind] if one.name == place.name), None)
        if entry is None:
            return False
        self.everything |= entry.housekeeping
        return bool(chosen_of([entry], words, everything=True))


def entries(update: GraphUpdate, installed: Iterable[str]) -> dict[GraphKind, list[GraphEntry]]:
    """Return everything of each kind, sorted by name; types that nobody uses count as ROS's own."""

    def typed(rows: Iterable[Typed]) -> list[GraphEntry]:
        return [GraphEntry(row.name, ", ".join(row.type_names), is_housekeeping(row.name)) for row in rows]

    found = {
        GraphKind.NODE: [GraphEntry(row.name, "", is_housekeeping(row.name)) for row in update.nodes],
        GraphKind.SERVICE: typed(update.services),
        GraphKind.ACTION: typed(update.actions),
        GraphKind.TYPE: _types(update, installed),
    }
    return {kind: sorted(set(of_kind)) for kind, of_kind in found.items()}


def _types(update: GraphUpdate, installed: Iterable[str]) -> list[GraphEntry]:
    used = dict.fromkeys(installed, True)
    rows: tuple[Typed, ...] = (*update.topics, *update.services, *update.actions)
    for row in rows:
        for type_name in row.type_names:
            used[type_name] = used.get(type_name, True) and is_housekeeping(row.name)
    return [GraphEntry(name, "", hidden) for name, hidden in used.items()]


def _finding(finding: GraphFinding) -> GraphEntry:
    (sign, _word, meaning), title, name = LOOKS[finding.level], _(_TITLES[finding.rule]), finding.place.name
    detail = f"{name} {title} {localized(finding.what)}"
    return GraphEntry(finding.key, detail, label=f"{sign} {name}", remark=title, meaning=meaning)


def chosen_of(listed: Iterable[GraphEntry], words: str, *, everything: bool) -> list[GraphEntry]:
    """Return the entries that contain all the words, without ROS's own unless `everything`."""
    parts = words.casefold().split()
    return [
        entry
        for entry in listed
        if (everything or not entry.housekeeping)
        and all(part in f"{entry.name} {entry.detail}".casefold() for part in parts)
    ]
