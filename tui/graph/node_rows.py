"""A node as rows of links: what it says, hears, serves and calls, and with whom."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import _
from tui.deck.nodes_table import looks, memory, percent, why
from tui.graph.links import heading, link, short
from tui.graph.neighbours import neighbours

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import GraphUpdate, NodeRow
    from launcher.status import NodeStatus
    from tui.graph.neighbours import Way
    from tui.widgets.rows import Row


def node_rows(update: GraphUpdate, node: NodeRow, *, everything: bool) -> list[Row]:
    """Return a section for each thing that the node does."""
    around = neighbours(update, node, everything=everything)
    sections: tuple[tuple[str, str, tuple[Way, ...], str], ...] = (
        ("says", _("Publishes"), around.said, "→"),
        ("hears", _("Subscribes to"), around.heard, "←"),
        ("serves", _("Serves"), around.served, "←"),
        ("calls", _("Calls"), around.called, "→"),
        ("takes", _("Takes goals of"), around.goals_taken, "←"),
        ("sends", _("Sends goals to"), around.goals_sent, "→"),
    )
    rows: list[Row] = []
    for section, title, ways, arrow in sections:
        if ways:
            rows.append(heading(title))
            rows += [link(way.place, section, _with(way, arrow)) for way in ways]
    return rows


def _with(way: Way, arrow: str) -> str:
    """Return who is at the other end; of a topic nobody there is worth a word."""
    names = ", ".join(short(name) for name in way.nodes)
    return f"{arrow} {names}" if names else _("nobody")


def status_of(name: str, nodes: Mapping[str, NodeStatus]) -> NodeStatus | None:
    """Return the process of a node of this full name, if Deck has started one that is called so."""
    return nodes.get(name.removeprefix("/")) or nodes.get(name.rpartition("/")[2])


def process_words(status: NodeStatus | None) -> str:
    """Return which process of ours a node is, and what it costs."""
    if status is None:
        return _("not started by Deck")
    sign, word, _meaning = looks(status)
    if not status.state.alive:
        return f"{sign} {_(word)} · {why(status)}"
    parts = [f"{sign} {_(word)}"]
    if status.pid is not None:
        parts.append(_("process {pid}").format(pid=status.pid))
    if status.cpu_percent is not None:
        parts.append(_("CPU {share}").format(share=percent(status.cpu_percent)))
    if status.memory_bytes is not None:
        parts.append(memory(status.memory_bytes))
    return " · ".join(parts)
