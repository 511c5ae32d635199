"""The graph by kind: what is listed, how it is searched, and why a list is empty."""

from __future__ import annotations

import asyncio
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from graph.housekeeping import is_housekeeping
from text.i18n import _, localized
from tui.graph.finding_words import LOOKS, FindingsBook, checked_words, title
from tui.graph.places import LISTED, GraphKind

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from graph.data import ActionRow, GraphUpdate, ServiceRow, TopicRow
    from tui.graph.places import GraphPlace

    Typed = TopicRow | ServiceRow | ActionRow

    from tui.session.feed import Feed


class GraphEntry(NamedTuple):
    """One line of the list."""

    name: str
    detail: str = ""
    """Its type, or for a type the number of its users."""
    housekeeping: bool = False
    label: str = ""
    """What is listed in place of the name."""
    remark: str = ""
    """What is listed beside it if there is room."""
    meaning: str = ""
    """Of its colour, as in `tui.widgets.rows.Cell`."""


class GraphIndex:
    """Everything of each kind, and which of it is listed."""

    def __init__(self) -> None:
        self.everything = False
        """Whether what belongs to ROS itself is listed."""
        self.listed: dict[GraphKind, list[GraphEntry]] = {}
        """Everything of each kind."""
        self.findings = FindingsBook()
        """What is wrong with the graph."""
        self._installed: tuple[str, ...] = ()
        """Every type installed on this computer, once it has been requested."""

    def take(self, update: GraphUpdate | None, failures: Mapping[str, str] = MappingProxyType({})) -> None:
        """Use this graph from now on; `failures`: nodes that have ended for good, and why."""
        self.listed = {kind: entries(update, kind, self._installed) for kind in LISTED}
        self.findings.take(update, failures)
        self.listed[GraphKind.FINDING] = _findings(self.findings)

    def settle(self) -> bool:
        """List findings that have held for long enough by now; return whether that changed any."""
        if not self.findings.settle():
            return False
        self.listed[GraphKind.FINDING] = _findings(self.findings)
        return True

    async def find_installed(self) -> None:
        """Find installed types that nobody uses, for the next `take`."""
        from graph.messages.browse import interfaces

        self._installed = await asyncio.to_thread(interfaces)

    def all_of(self, kind: GraphKind) -> list[GraphEntry]:
        return self.listed.get(kind, [])

    def fitting(self, kind: GraphKind, words: str = "") -> list[GraphEntry]:
        """Return what is listed of a kind for a filter with these words."""
        return chosen_of(self.all_of(kind), words, everything=self.everything)

    def reveal(self, place: GraphPlace, words: str) -> bool:
        """Make sure that a place is listed; return whether it also matches these words."""
        entry = next((one for one in self.all_of(place.kind) if one.name == place.name), None)
        if entry is None:
            return False
        if entry.housekeeping:
            self.everything = True
        return bool(chosen_of([entry], words, everything=True))


def entries(update: GraphUpdate | None, kind: GraphKind, installed: Iterable[str] = ()) -> list[GraphEntry]:
    """Return everything of a kind, sorted by name; types that nobody uses count as ROS's own.

    Findings take time to be sure of: they are not made here.
    """
    if update is None:
        return []
    if kind is GraphKind.NODE:
        found = [GraphEntry(row.name, "", is_housekeeping(row.name)) for row in update.nodes]
    elif kind is GraphKind.SERVICE:
        found = [_typed(row.name, row.type_names) for row in update.services]
    elif kind is GraphKind.ACTION:
        found = [_typed(row.name, row.type_names) for row in update.actions]
    elif kind is GraphKind.TYPE:
        found = _types(update, installed)
    else:
        return []
    return sorted(set(found))


def chosen_of(listed: Iterable[GraphEntry], words: str, *, everything: bool) -> list[GraphEntry]:
    """Return the entries that contain all the words, without ROS's own unless `everything`."""
    parts = words.casefold().split()
    return [
        entry
        for entry in listed
        if (everything or not entry.housekeeping)
        and all(part in f"{entry.name} {entry.detail}".casefold() for part in parts)
    ]


def users_of(update: GraphUpdate | None, type_name: str) -> dict[GraphKind, list[str]]:
    """Return the names of everything that uses this type, by kind."""
    if update is None:
        return {}
    rows: dict[GraphKind, Sequence[Typed]] = {
        GraphKind.TOPIC: update.topics,
        GraphKind.SERVICE: update.services,
        GraphKind.ACTION: update.actions,
    }
    found = {kind: [row.name for row in of_kind if type_name in row.type_names] for kind, of_kind in rows.items()}
    return {kind: names for kind, names in found.items() if names}


def _findings(book: FindingsBook) -> list[GraphEntry]:
    return [
        GraphEntry(
            finding.key,
            f"{finding.place.name} {title(finding)} {localized(finding.what)}",
            label=f"{LOOKS[finding.level][0]} {finding.place.name}",
            remark=title(finding),
            meaning=LOOKS[finding.level][2],
        )
        for finding in book.told
    ]


def _typed(name: str, type_names: tuple[str, ...]) -> GraphEntry:
    return GraphEntry(name, ", ".join(type_names), is_housekeeping(name))


def _types(update: GraphUpdate, installed: Iterable[str]) -> list[GraphEntry]:
    used = dict.fromkeys(installed, True)
    rows: tuple[Typed, ...] = (*update.topics, *update.services, *update.actions)
    for row in rows:
        hidden = is_housekeeping(row.name)
        for type_name in row.type_names:
            used[type_name] = used.get(type_name, True) and hidden
    return [GraphEntry(name, "", hidden) for name, hidden in used.items()]


def why_empty(feed: Feed, kind: GraphKind, listed: Sequence[GraphEntry], *, all_key: str) -> tuple[str, str]:
    """Return headline and advice for a list that shows none of `listed`."""
    update = feed.update
    if feed.link is None:
        return _("no lesson is running"), ""
    if update is None:
        return _("reading the graph"), _("Nodes are starting.")
    if update.error:
        return feed.blind, localized(update.error)
    if any(not entry.housekeeping for entry in listed):
        return _("nothing matches the filter"), _("Escape in the filter shows all again.")
    if listed:
        return _("only what ROS itself needs is here"), _("{key} shows it.").format(key=all_key)
    return _none(kind)


def _none(kind: GraphKind) -> tuple[str, str]:
    if kind is GraphKind.NODE:
        return _("no node in this domain"), _(
            "Nodes of another domain number, or of another computer while discovery is localhost, are not seen."
        )
    if kind is GraphKind.SERVICE:
        return _("nobody serves a service"), _("Start a node that does: head_controller is one.")
    if kind is GraphKind.ACTION:
        return _("nobody serves an action"), _("Start a node that does: drive_to_point is one.")
    if kind is GraphKind.FINDING:
        return _("no findings"), checked_words()
    return _("no type is in use"), _("Types are those of topics, services and actions.")
