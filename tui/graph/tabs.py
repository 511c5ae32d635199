"""The kinds of the graph as tabs, each with the number of its entries."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import _
from tui.graph.places import LISTED, TITLES, GraphKind
from tui.widgets.tab_line import TabEntry, TabLine

if TYPE_CHECKING:
    from collections.abc import Mapping


class GraphTabs(TabLine):
    """One line; a click chooses another kind."""

    def show(self, front: GraphKind, counts: Mapping[GraphKind, int], worst: str) -> None:
        """Show the number of entries of each kind, and which kind is listed.

        `worst` is the meaning of the worst finding: `bad`, `warn` or none.
        """
        entries = [
            TabEntry(
                kind.value,
                f"{_(TITLES[kind])} {counts.get(kind, 0)}",
                worst if kind is GraphKind.FINDING else "",
            )
            for kind in LISTED
        ]
        self.show_tabs(front.value, entries)
