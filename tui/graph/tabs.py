"""The kinds of the graph as tabs, each with the number of its entries."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import _
from tui.graph.places import LISTED, TITLES, GraphKind
from tui.widgets.tab_line import TabEntry

if TYPE_CHECKING:
    from collections.abc import Mapping


def tab_entries(counts: Mapping[GraphKind, int], worst: str) -> list[TabEntry]:
    """Return a tab for each kind, with the number of its entries.

    `worst` is the meaning of the worst finding: `bad`, `warn` or none.
    """
    return [
        TabEntry(kind.value, f"{_(TITLES[kind])} {counts.get(kind, 0)}", worst if kind is GraphKind.FINDING else "")
        for kind in LISTED
    ]
