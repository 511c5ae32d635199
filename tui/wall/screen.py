"""Big numbers beside a big picture, below them the gate and what was said."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.containers import Container, Vertical
from textual.widgets import Static

from launcher.profile.panels import panels_for
from robot.topics import BATTERY, ODOMETRY, SONAR_FRONT, SONAR_REAR, WHEEL_COMMANDS
from safety.topics import SAFETY_STATE
from text.i18n import N_, _
from text.plain import plain
from tui.actions import bindings
from tui.emergency.state import held_reason
from tui.emergency.words import stop_words
from tui.frame.actions.app import emergency_release
from tui.frame.screen import DeckScreen
from tui.panels.camera import CameraPanel
from tui.panels.panel import row_of
from tui.panels.sonar import COURSE, bounds_of
from tui.panels.voice import VoicePanel
from tui.wall.actions import WALL_ACTIONS
from tui.wall.numbers import BigNumber, WallReader, big_word

if TYPE_CHECKING:
    from collections.abc import Collection

    from textual.app import ComposeResult

    from graph.data import GraphUpdate
    from tui.emergency.messages import EmergencyChanged
    from tui.session.messages import GraphChanged, LanguageChanged, SessionChanged

MOST = 4
"""Numbers on the wall."""
LONGEST = 200
NUMBERS = frozenset({SONAR_FRONT, SONAR_REAR, ODOMETRY, WHEEL_COMMANDS, BATTERY, SAFETY_STATE})


class WallScreen(DeckScreen):
    """Numbers above, or beside, the picture; then the state of the gate, and the last words."""

    tab: ClassVar[str] = "wall"
    about: ClassVar[str] = N_(
        "What matters of the robot in a size that can be read across a room: the distances, the "
        "speed, the battery if it reports, the gate, the picture of the camera and the last words. "
        "What nobody publishes is left out. The emergency stop shows in large red letters."
    )
    parts: ClassVar[tuple[str, ...]] = ("CameraPanel",)
    BINDINGS: ClassVar = bindings(*WALL_ACTIONS)
    DEFAULT_CSS = """
    WallScreen {
        #wall { height: 1fr; layout: vertical; }
        #wall-numbers { height: 5; layout: horizontal; }
        #wall-none { display: none; height: auto; padding: 1 2; color: $text-muted; }
        &.-no-numbers.-no-camera.-no-voice #wall-none { display: block; }
        &.-no-numbers #wall-numbers { display: none; }
        #wall CameraPanel { border: none; padding: 0; }
        #wall-state {
            height: auto; width: 1fr; text-align: center; text-style: bold; padding: 0 1;
            background: $panel;
            &.-free { background: $success-muted; color: $text-success; }
            &.-held { background: #ffb000; color: #000000; }
            &.-stop { background: #b00020; color: #ffffff; padding: 1 1; }
        }
        #wall-said { height: 3; }
        #wall-said VoicePanel { border: none; border-top: solid $panel; }
        &.-home #wall, &.-wide #wall {
            layout: grid; grid-size: 2; grid-columns: 2fr 1fr; grid-rows: 1fr auto;
        }
        &.-wide #wall { grid-columns: 3fr 2fr; }
        &.-home #wall-numbers, &.-wide #wall-numbers {
            height: 1fr; layout: vertical; border-left: solid $panel;
        }
        &.-home #wall-bottom, &.-wide #wall-bottom { column-span: 2; }
        &.-home #wall-state.-free, &.-home #wall-state.-held { padding: 1 1; }
        &.-wide #wall-state.-free, &.-wide #wall-state.-held { padding: 1 1; }
        &.-home #wall-said { height: 4; }
        &.-wide #wall-said { height: 5; }
        #wall-bottom { height: auto; }
        &.-no-camera #wall CameraPanel { display: none; }
        &.-no-camera #wall { layout: vertical; }
        &.-no-camera #wall-numbers { height: 1fr; layout: horizontal; }
        &.-no-voice #wall-said { display: none; }
        &.-low.-stopped #wall-said, &.-flat.-stopped #wall-said { display: none; }
        &.-low #wall-state.-stop, &.-flat #wall-state.-stop { padding: 0 1; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._reader = WallReader()
        self._bounds = COURSE
        self._names: Collection[str] = ()
        """Panels of the session, from which the wall takes what it shows."""

    def compose_body(self) -> ComposeResult:
        """Numbers, picture, state, words."""
        with Container(id="wall"):
            yield Static(id="wall-none", markup=False)
            yield CameraPanel()
            with Container(id="wall-numbers"):
                for _place in range(MOST):
                    yield BigNumber()
            with Vertical(id="wall-bottom"):
                yield Static(id="wall-state", markup=False)
                with Container(id="wall-said"):
                    yield VoicePanel()

    def watch_topics(self) -> set[str]:
        return set(NUMBERS)

    def picture_topics(self) -> set[str]:
        return self.query_one(CameraPanel).pictures() if self._sees and self.is_mounted else set()

    def follow_topics(self) -> set[str]:
        """What is said, as long as the wall is in front."""
        front = self.feed.front is self and self.is_mounted
        return self.query_one(VoicePanel).followed() if front and self._hears else set()

    @property
    def _sees(self) -> bool:
        return "camera" in self._names

    @property
    def _hears(self) -> bool:
        return "voice" in self._names

    def on_mount(self) -> None:
        """Nothing is known yet."""
        self.add_class("-no-numbers")
        self._choose(None)
        self._show_state(None)

    def on_session_changed(self, message: SessionChanged) -> None:
        del message
        self._reader = WallReader()
        self._choose(None)

    def on_graph_changed(self, message: GraphChanged) -> None:
        update = message.update
        if self.feed.front is not self or update.error:
            return
        self._choose(update)
        self._bounds = bounds_of(update, self._bounds)
        self._show_numbers(update)
        self._show_state(update)
        if self._sees:
            self.query_one(CameraPanel).take(update)
        if self._hears:
            self.query_one(VoicePanel).take(update)

    def on_emergency_changed(self, message: EmergencyChanged) -> None:
        """Show the stop at once."""
        del message
        self._show_state(self.feed.update)

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        if self.feed.update is not None:
            self._show_numbers(self.feed.update)
        self._show_state(self.feed.update)

    def _choose(self, update: GraphUpdate | None) -> None:
        """Take from the session's panels what the wall shows; of a robot of others, what it has."""
        session = self.feed.session
        names = set() if session is None else set(session.panels)
        if update is not None and self.feed.watching:
            names = set(panels_for({row.name for row in update.topics if row.publishers}))
        if names != self._names:
            self._names = names
            self.set_class(not self._sees, "-no-camera")
            self.set_class(not self._hears, "-no-voice")
            self.topics_changed()

    def _show_numbers(self, update: GraphUpdate) -> None:
        numbers = self._reader.numbers(update, self._bounds)
        self.set_class(not numbers, "-no-numbers")
        for at, widget in enumerate(self.query(BigNumber)):
            widget.display = at < len(numbers)
            if at < len(numbers):
                widget.show(numbers[at])

    def _say_none(self) -> None:
        words = _(
            "Nothing that the wall could show is published here: no distances, no speed, no "
            "battery, no picture, no words."
        )
        none = self.query_one("#wall-none", Static)
        if words != none.content:
            none.update(words)

    def _show_state(self, update: GraphUpdate | None) -> None:
        self._say_none()
        emergency = self.deck.emergency.state
        gate = None if update is None else row_of(update, SAFETY_STATE)
        has_gate = gate is not None and gate.publishers > 0
        held = emergency.blocked and not emergency.engaged
        look = "stop" if emergency.engaged else "held" if held else "free" if has_gate else ""
        words = ""
        if emergency.engaged:
            short = stop_words(emergency, self.deck.keys_of(emergency_release)[0])[-1]
            words = f"{big_word(_('STOP'))}\n\n{short}"
        elif held:
            words = _("⚠ The gate holds the wheels: {reason}")
            words = words.format(reason=plain(held_reason(emergency), LONGEST))
        elif has_gate:
            words = _("● The gate lets the wheels turn")
        state = self.query_one("#wall-state", Static)
        state.display = bool(words)
        if words != state.content:
            state.update(words)
        self.set_class(emergency.engaged, "-stopped")
        for name in ("stop", "held", "free"):
            state.set_class(name == look, f"-{name}")
