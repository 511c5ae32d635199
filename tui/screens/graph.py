"""Nodes, services, actions and types: who talks to whom."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from tui.i18n import N_
from tui.screens.base import DeckScreen
from tui.widgets.rows import Rows

if TYPE_CHECKING:
    from textual.app import ComposeResult


class GraphScreen(DeckScreen):
    """A list by kind, and the detail of the chosen one."""

    tab: ClassVar[str] = "graph"
    about: ClassVar[str] = N_(
        "Nodes with what they publish, hear, serve and call; services to be called, actions to "
        "be sent goals, types down to their fields."
    )

    def compose_body(self) -> ComposeResult:
        """The list."""
        yield Rows()
