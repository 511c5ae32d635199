"""The panels that matter of a robot at work, as large as the screen allows, below what the gate does."""

from __future__ import annotations

from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.widgets import Static

from graph.data import GraphUpdate
from launcher.profile.panels import panels_for
from safety.topics import SAFETY_STATE
from text.i18n import N_, _
from text.plain import plain
from tui.actions import bindings
from tui.emergency.messages import EmergencyChanged
from tui.emergency.state import held_reason
from tui.emergency.words import stop_words
from tui.frame.actions.app import emergency_release
from tui.frame.screen import DeckScreen
from tui.panels.panel import is_published
from tui.panels.panel_grid import PanelGrid
from tui.session.messages import GraphChanged, LanguageChanged, SessionChanged
from tui.wall.actions import WALL_ACTIONS

SHOWN = ("sonar", "camera", "wheels", "voice")
"""Panels that can be read across a room, and need no keys."""
LONGEST = 200
_LETTERS = {
    "S": ("▟███▙", "█▖   ", "▝███▖", "   ▝█", "▜███▛"),
    "T": ("█████", "  █  ", "  █  ", "  █  ", "  █  "),
    "O": ("▟███▙", "█   █", "█   █", "█   █", "▜███▛"),
    "P": ("████▙", "█   █", "████▛", "█    ", "█    "),
    "С": ("▟███▙", "█    ", "█    ", "█    ", "▜███▛"),
    "Т": ("█████", "  █  ", "  █  ", "  █  ", "  █  "),
    "О": ("▟███▙", "█   █", "█   █", "█   █", "▜███▛"),
    "П": ("█████", "█   █", "█   █", "█   █", "█   █"),
}


class WallScreen(DeckScreen):
    """The state of the gate above the panels."""

    tab: ClassVar[str] = "wall"
    about: ClassVar[str] = N_(
        "What matters of the robot, to be read across a room: the distances, the picture of the camera, the "
        "wheels, the last words, and what the gate does. What nobody publishes is left out. The emergency stop "
        "shows in large red letters."
    )
    parts: ClassVar[tuple[str, ...]] = ("Panel",)
    BINDINGS: ClassVar = bindings(*WALL_ACTIONS)
    DEFAULT_CSS = """
    WallScreen #wall-state {
        height: auto; width: 1fr; text-align: center; text-style: bold; padding: 0 1;
        &.-free { background: $success-muted; color: $text-success; }
        &.-held { background: #ffb000; color: #000000; }
        &.-stop { background: #b00020; color: #ffffff; padding: 1 1; }
    }
    WallScreen.-low #wall-state.-stop, WallScreen.-flat #wall-state.-stop { padding: 0 1; }
    """

    def __init__(self) -> None:
        super().__init__()
        self.grid: PanelGrid = PanelGrid()
        self._names: tuple[str, ...] = ()

    def compose_body(self) -> ComposeResult:
        yield Static(id="wall-state", markup=False)
        yield self.grid

    def watch_topics(self) -> set[str]:
        return {SAFETY_STATE}.union(*(panel.watched() for panel in self.grid.panels))

    def picture_topics(self) -> set[str]:
        return set().union(*(panel.pictures() for panel in self.grid.panels))

    def follow_topics(self) -> set[str]:
        """What is said, as long as the wall is in front."""
        front = self.feed.front is self
        return set().union(*(panel.followed() for panel in self.grid.panels if front))

    def on_mount(self) -> None:
        self._show_state()

    @on(SessionChanged)
    async def _session_changed(self) -> None:
        await self._choose(None)

    async def on_graph_changed(self, message: GraphChanged) -> None:
        if self.feed.front is not self or message.update.error:
            return
        await self._choose(message.update)
        self._show_state()
        for panel in self.grid.panels:
            panel.take(message.update)

    def on_emergency_changed(self, message: EmergencyChanged) -> None:
        del message
        self._show_state()

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self._show_state()

    async def _choose(self, update: GraphUpdate | None) -> None:
        """Take what can be shown from the session's panels; of a robot of others, from what it publishes."""
        names = () if self.feed.session is None else self.feed.session.panels
        if update is not None and self.feed.watching:
            names = panels_for({row.name for row in update.topics if row.publishers})
        shown = tuple(name for name in SHOWN if name in names)
        if shown != self._names:
            self._names = shown
            await self.grid.put_up(shown)
            self.topics_changed()

    def _show_state(self) -> None:
        emergency, update = self.deck.emergency.state, self.feed.update
        words = look = ""
        if emergency.engaged:
            look = "stop"
            words = stop_words(emergency, self.deck.keys_of(emergency_release)[0])[-1]
            words = f"{big_word(_('STOP'))}\n\n{words}"
        elif emergency.blocked:
            look, words = "held", _("⚠ The gate holds the wheels: {reason}")
            words = words.format(reason=plain(held_reason(emergency), LONGEST))
        elif update is not None and is_published(update, SAFETY_STATE):
            look, words = "free", _("● The gate lets the wheels turn")
        elif not self._names:
            words = _(
                "Nothing that the wall could show is published here: no distances, no wheels, no picture, no words."
            )
        state = self.query_one("#wall-state", Static)
        state.display = bool(words)
        if words != state.content:
            state.update(words)
        for name in ("stop", "held", "free"):
            state.set_class(name == look, f"-{name}")


def big_word(word: str) -> str:
    """Return a word in letters five lines high; one that lacks a letter as it is."""
    if not all(letter in _LETTERS for letter in word):
        return word
    return "\n".join("  ".join(_LETTERS[letter][row] for letter in word) for row in range(5))
