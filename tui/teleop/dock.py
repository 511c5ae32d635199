"""Driving by keys on a screen: the panel below the others, and away again."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from graph.data import GraphUpdate
    from tui.frame.screen import DeckScreen
    from tui.teleop.widget import TeleopPanel

QUICK_S, USUAL_S = 0.1, 0.25
"""Between two updates of the graph while driving, and else."""


class TeleopDock:
    """Brings the panel that drives below the `#board` of a screen.

    The screen tells it what comes, and that something else has the keys now.
    """

    def __init__(self, screen: DeckScreen, leave: Callable[[], None]) -> None:
        """`leave` gives the focus to what has it while nobody drives."""
        self._screen, self._leave = screen, leave
        self._panel: TeleopPanel | None = None

    @property
    def topics(self) -> frozenset[str]:
        """What the panel shows."""
        return frozenset() if self._panel is None else self._panel.topics

    async def open(self) -> None:
        """Bring the panel and give it the focus."""
        if self._panel is None:
            from tui.teleop.widget import TeleopPanel

            self._panel = TeleopPanel()
            await self._screen.mount(self._panel, after="#board")
            self._screen.period_s = QUICK_S
            self._screen.topics_changed()
        self._panel.focus()

    async def close(self) -> None:
        """Take the panel away, and give the focus back."""
        panel, self._panel = self._panel, None
        if panel is not None:
            await panel.remove()
            self._screen.period_s = USUAL_S
            self._screen.topics_changed()
            self._leave()

    def take(self, update: GraphUpdate) -> None:
        """Show what has come."""
        if self._panel is not None:
            self._panel.show(update)

    def release(self) -> None:
        """End what the keys asked for: after a stop, and where another screen has the keys."""
        if self._panel is not None:
            self._panel.release()

    def words_changed(self) -> None:
        """Draw it anew in another language."""
        if self._panel is not None:
            self._panel.words_changed()
