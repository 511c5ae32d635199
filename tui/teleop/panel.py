"""Driving by keys on a screen: the panel below the others, and away again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from textual import on
from textual.events import ScreenSuspend

from text.i18n import _
from tui.frame.screen import DeckScreen
from tui.session.messages import EmergencyChanged, GraphChanged, LanguageChanged, SessionChanged
from tui.teleop.actions import TELEOP_ACTIONS

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from tui.actions import Action
    from tui.teleop.widget import TeleopPanel

QUICK_S, USUAL_S = 0.1, 0.25
"""Between two updates of the graph while driving, and else."""


class DrivenScreen(DeckScreen):
    """A screen with a `#board` below which the keys can drive.

    Textual calls a message's handlers of this class and of those that inherit it, each in turn.
    """

    def __init__(self) -> None:
        super().__init__()
        self._teleop: TeleopPanel | None = None

    async def open_teleop(self) -> None:
        """Bring the panel and give it the focus."""
        if self._teleop is None:
            from tui.teleop.widget import TeleopPanel

            self._teleop = TeleopPanel()
            await self.mount(self._teleop, after="#board")
            self.period_s = QUICK_S
            self.topics_changed()
        self._teleop.focus()

    async def on_teleop_panel_closed(self) -> None:
        """Take the panel away."""
        await self.close_teleop()

    async def close_teleop(self) -> None:
        """Take the panel away, and give the focus back."""
        panel, self._teleop = self._teleop, None
        if panel is not None:
            await panel.remove()
            self.period_s = USUAL_S
            self.topics_changed()
            self.focus_usual()

    def focus_usual(self) -> None:
        """Give the focus to what has it while nobody drives."""

    def more_keys(self) -> Iterable[tuple[str, Sequence[type[Action[Any]]]]]:
        """The keys that drive."""
        yield _("Keys while driving"), TELEOP_ACTIONS

    def watch_topics(self) -> set[str]:
        """What the panel shows."""
        own = frozenset() if self._teleop is None else self._teleop.topics
        return super().watch_topics() | own

    @on(GraphChanged)
    def _feed_teleop(self, message: GraphChanged) -> None:
        """Feed the panel."""
        if self._teleop is not None and not message.update.error:
            self._teleop.show(message.update)

    def on_emergency_changed(self, message: EmergencyChanged) -> None:
        """A stop is also the end of what the keys asked for; other news of the gate are not."""
        if self._teleop is not None and message.emergency.engaged:
            self._teleop.release()

    @on(SessionChanged)
    async def _session_over(self, message: SessionChanged) -> None:
        """Without a session there is nothing to drive."""
        if message.ended or self.feed.link is None:
            await self.close_teleop()

    def on_screen_suspend(self, event: ScreenSuspend) -> None:
        """Another screen, or a dialog, has the keys."""
        del event
        if self._teleop is not None:
            self._teleop.release()

    def on_language_changed(self, message: LanguageChanged) -> None:
        """Draw it anew."""
        del message
        if self._teleop is not None:
            self._teleop.words_changed()
