"""Shows the panel for driving with keys below the others, and removes it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from graph.data import GraphUpdate
    from tui.frame.screen import DeckScreen
    from tui.teleop.widget import TeleopPanel

QUICK_S, USUAL_S = 0.1, 0.25
"""Seconds between two updates of the graph, while driving and otherwise."""


class TeleopDock:
    """Shows the panel for driving below the `#desk` of a screen.

    The screen passes it updates, and tells it when something else receives the keys.
    """

    def __init__(self, screen: DeckScreen, leave: Callable[[], None]) -> None:
        """Pass `leave`, which gives the focus back when driving ends."""
        self._screen, self._leave = screen, leave
        self._panel: TeleopPanel | None = None

    @property
    def topics(self) -> frozenset[str]:
        return frozenset() if self._panel is None else self._panel.topics

    async def open(self) -> None:
        """Show the panel and focus it."""
        if self._panel is None:
            from tui.teleop.widget import TeleopPanel

            self._panel = TeleopPanel()
            await self._screen.mount(self._panel, after="#desk")
            self._screen.period_s = QUICK_S
            self._screen.topics_changed()
        self._panel.focus()

    async def close(self) -> None:
        """Remove the panel, and give the focus back."""
        panel, self._panel = self._panel, None
        if panel is not None:
            await panel.remove()
            self._screen.period_s = USUAL_S
            self._screen.topics_changed()
            self._leave()

    def take(self, update: GraphUpdate) -> None:
        if self._panel is not None:
            self._panel.show(update)

    def release(self) -> None:
        """Release all keys: after a stop, or when another screen receives them."""
        if self._panel is not None:
            self._panel.release()
