"""Containers of components, and which container a component is in, as links."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import _, localized
from text.plain import plain
from tui.graph.links import heading, link
from tui.graph.places import GraphKind, GraphPlace

if TYPE_CHECKING:
    from graph.data import GraphUpdate
    from tui.widgets.rows import Row

LONGEST = 300


def component_rows(update: GraphUpdate, node: str) -> list[Row]:
    """Return what the node of this full name holds, and what holds it; nothing for most nodes."""
    rows: list[Row] = []
    for container in update.containers:
        if container.node == node:
            title = _("Contains") if container.components else _("An empty container")
            if container.error:
                title += f" · {plain(localized(container.error), LONGEST)}"
            rows.append(heading(title))
            rows += [
                link(_place(each.node), "holds", _("component {n}").format(n=each.unique_id))
                for each in container.components
            ]
        elif any(each.node == node for each in container.components):
            rows += [heading(_("Is in the container")), link(_place(container.node), "in", "")]
    return rows


def _place(node: str) -> GraphPlace:
    return GraphPlace(GraphKind.NODE, node)
