"""The app: its screens, its languages and themes, and the session opened, closed and left."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from textual.app import App
from textual.binding import Binding, BindingType
from textual.events import Key, Paste
from textual.widget import Widget

from text.i18n import LANGUAGES, _, language, set_language
from text.plain import plain, plain_lines
from tui.actions import REGISTRY, Acting, Action, bindings
from tui.dialogs.opening import OpeningScreen
from tui.emergency.control import EmergencyControl
from tui.faults import Faults
from tui.frame.actions.app import APP_ACTIONS, EmergencyStop
from tui.frame.actions.recording import RECORDING_ACTIONS
from tui.frame.actions.replay import REPLAY_ACTIONS
from tui.frame.replay_bar import ReplayBar
from tui.lifecycle.sessions import Sessions
from tui.recording.recording import Recording
from tui.session.feed import Feed, GraphReady
from tui.session.messages import EmergencyChanged, LanguageChanged
from tui.session.requests import OpenRequest
from tui.session.strangers import Strangers
from tui.terminal.bandwidth import Bandwidth
from tui.terminal.harmless import Harmless
from tui.terminal.key_queue import KeyQueue
from tui.terminal.stall_detector import KeyStallDetector
from tui.themes import HIGH_CONTRAST, after, few_colours

if TYPE_CHECKING:
    from textual.command import Provider
    from textual.driver import Driver
    from textual.events import Event
    from textual.filter import LineFilter
    from textual.notifications import SeverityLevel
    from textual.screen import Screen

    from tui.faults import Journal
    from tui.session.ports import SessionOpener

SCREENS = {
    "picker": ("tui.picker.screen", "PickerScreen"),
    "deck": ("tui.deck.screen", "LessonDeck"),
    "topics": ("tui.topics.screen", "TopicsScreen"),
    "composer": ("tui.composer.screen", "ComposerScreen"),
    "logs": ("tui.logs.screen", "LogsScreen"),
    "graph": ("tui.graph.screen", "GraphScreen"),
    "flow": ("tui.flow.screen", "FlowScreen"),
    "devices": ("tui.devices.screen", "DevicesScreen"),
}
"""Imported when first shown: the first frame needs only one of them."""

DIALOGS = (
    "tui.lifecycle.end_session",
    "tui.lifecycle.stopping",
    "tui.help.screen",
    "tui.lifecycle.domain_taken",
    "tui.lifecycle.refused",
    "tui.lifecycle.strays",
)
"""With actions of their own, imported when first shown."""

STRANGERS_S = 20.0
"""How long it is told beside the title who publishes past the gate."""


def _commands() -> type[Provider]:
    from tui.palette import Commands

    return Commands


class DeckApp(App[int], Acting):
    """One screen for the lessons."""

    TITLE = "Deck"
    BINDINGS: ClassVar[list[BindingType]] = bindings(
        *APP_ACTIONS, *REPLAY_ACTIONS, *RECORDING_ACTIONS
    )
    COMMANDS: ClassVar = {_commands}
    ENABLE_COMMAND_PALETTE = False
    """Textual's own key for it; ours speaks the language of the screen."""

    def __init__(
        self,
        opener: SessionOpener,
        request: OpenRequest,
        first_screen: str = "deck",
        driver_class: type[Driver] | None = None,
        journal: Journal | None = None,
    ) -> None:
        """`opener` lists and opens; a `request` that names nothing is asked for by the picker.

        With a `journal` the app outlives what its widgets raise, see `tui.faults`.
        """
        super().__init__(driver_class=driver_class)
        self.faults = Faults(self, journal)
        self.has_begun = False
        """Whether the first frame is out."""
        self.sessions = Sessions(self, opener, request)
        self.feed = Feed(self)
        self.emergency = EmergencyControl(self)
        self.strangers = Strangers()
        self.recording = Recording(self)
        self.stall_detector = KeyStallDetector()
        self.bandwidth = Bandwidth()
        """What is written to the terminal, and how much of pictures that may be."""
        self._harmless = Harmless()
        self._key_queue = KeyQueue(self)
        self._first_screen = "picker" if self.sessions.picking else first_screen
        self.register_theme(HIGH_CONTRAST)

    def get_default_screen(self) -> Screen[Any]:
        """Begin with a screen that costs next to nothing: nobody waits for a first frame."""
        opening = self.sessions.opening
        words = _("opening {name}…").format(name=plain(opening)) if opening else _("Lessons")
        return OpeningScreen(words)

    def on_mount(self) -> None:
        """Go on when the first frame is out."""
        self.stall_detector.watch()
        # A moment of rest lets the threads that write to the terminal have their turn.
        self.call_after_refresh(self.set_timer, 0.01, self._begin)

    def on_unmount(self) -> None:
        """Leave no thread behind."""
        self.stall_detector.end()

    async def on_event(self, event: Event) -> None:
        """Take keys one after the other; the emergency stop waits for none."""
        if not isinstance(event, (Key, Paste)) or event.is_forwarded:
            await super().on_event(event)
        elif not self._key_queue.must_wait(event):
            target = self.focused or self.screen
            await super().on_event(event)
            self._key_queue.given(event, target)
        elif not await self._stopped_by(event):
            self._key_queue.wait(event)

    async def _stopped_by(self, event: Key | Paste) -> bool:
        """Stop the wheels if that is what this key, where it is pressed, is for."""
        keys = self._keymap.get(EmergencyStop.id, EmergencyStop.key).split(",")
        return (
            isinstance(event, Key)
            and event.key in map(str.strip, keys)
            and await self._check_bindings(event.key, priority=True)
        )

    async def _begin(self) -> None:
        """Show the lesson, or the picker if none was named, and open what was asked for."""
        self.has_begun = True
        await self.push_screen(self._made_screen(self._first_screen))
        self.sessions.begin()

    async def show_screen(self, name: str) -> None:
        """Bring one of `SCREENS` to the front."""
        await self.switch_screen(self._made_screen(name))

    def _made_screen(self, name: str) -> Screen[Any]:
        """Return the screen called `name`, made when first asked for."""
        if not self.is_screen_installed(name):
            module, made = SCREENS[name]
            self.install_screen(getattr(import_module(module), made)(), name)
        return self.get_screen(name)

    def lesson_opened(self, name: str) -> None:
        """Take note of the profile that has been started."""
        self.sessions.last_lesson = name

    async def forget_screens(self) -> None:
        """Take away the screens of a session that is over."""
        for name in SCREENS:
            if name != "picker" and self.is_screen_installed(name):
                old = self.get_screen(name)
                self.uninstall_screen(old)
                if old.is_running:
                    # What they have drawn would be held, by a cache of Textual's own.
                    for widget in (old, *old.walk_children(Widget)):
                        widget.refresh()
                    await old.remove()
        # Who watches the theme, as each TextArea does, is held until it changes, gone or not.
        self.mutate_reactive(DeckApp.theme)

    def get_css_variables(self) -> dict[str, str]:
        """Return the colours of the theme, as far as the terminal can tell them apart."""
        variables = super().get_css_variables()
        if self.console.color_system == "standard":
            variables = {**variables, **few_colours(dark=self.current_theme.dark)}
            self.theme_variables = variables
        return variables

    def get_line_filters(self) -> Sequence[LineFilter]:
        """Look at every line once more before it goes to the terminal."""
        return [*super().get_line_filters(), self._harmless]

    def notify(
        self,
        message: str,
        *,
        title: str = "",
        severity: SeverityLevel = "information",
        timeout: float | None = None,
        markup: bool = False,
    ) -> None:
        """Tell something in a corner, as the text that it is."""
        message, title = plain_lines(message), plain(title)
        super().notify(message, title=title, severity=severity, timeout=timeout, markup=markup)

    def copy_to_clipboard(self, text: str) -> None:
        """Copy lines of text, which may be pasted where they would be obeyed."""
        super().copy_to_clipboard(plain_lines(text))

    async def show_safe_screen(self, broken: Screen[Any]) -> None:
        """Let go of a screen that cannot be drawn; it is made anew when it is asked for again."""
        from tui.dialogs.safe import SafeScreen

        if broken is not self.screen:
            return
        await self.switch_screen(SafeScreen())
        if self.is_screen_installed(broken):
            self.uninstall_screen(broken)
            await broken.remove()

    def _handle_exception(self, error: Exception) -> None:
        """Go on, where faults are isolated: Textual would end the app by any of them."""
        if self.faults.isolates:
            self.faults.caught(error)
        else:
            super()._handle_exception(error)

    def show_help(self) -> None:
        """Explain the screen in front."""
        from tui.help.screen import HelpScreen

        if not isinstance(self.screen, HelpScreen):
            self.push_screen(HelpScreen(self.screen))

    @property
    def crashed(self) -> bool:
        """Whether the app ended by a fault of its own."""
        return self._exception is not None

    def on_graph_ready(self, message: GraphReady) -> None:
        """Take the update that waits; a fault of the stop does not keep it from the screens."""
        del message
        before, update = self.feed.update, self.feed.take_update()
        if update is None:
            return
        try:
            self.emergency.see(update)
        finally:
            self.feed.hand_over(update)
        front = self.feed.front
        if self.feed.watching and front and (before is None or before.nodes != update.nodes):
            # Their number stands in the title.
            front.show_frame()
        if self.strangers.see(update, self.feed.nodes):
            self._tell_of_strangers()

    def _tell_of_strangers(self) -> None:
        """Name in every title, and once beside it, who publishes past the gate."""
        if words := self.strangers.words():
            self.notify(words[0], severity="error", timeout=STRANGERS_S, markup=False)
        self.feed.tell(lambda: EmergencyChanged(self.emergency.state))

    def emergency_changed(self) -> None:
        """Tell every screen, and the keys: a release is possible only when engaged."""
        self.feed.tell(lambda: EmergencyChanged(self.emergency.state))
        self.refresh_bindings()

    def replay_changed(self) -> None:
        """Show at once where the recording is now."""
        for bar in self.screen.query(ReplayBar):
            bar.look()

    def keys_of(self, action: type[Action[Any]]) -> list[str]:
        """Return how the keys of `action` are written, those of the user's keymap."""
        keys = self._keymap.get(action.id, action.key).split(",")
        return [self.key_text(key.strip()) for key in keys]

    def key_text(self, key: str) -> str:
        """Return how a key is written."""
        return self.get_key_display(Binding(key, ""))

    def show_palette(self) -> None:
        """Open the palette in the language spoken now."""
        from textual.command import CommandPalette

        if not isinstance(self.screen, CommandPalette):
            words = _("What would you like to do?")
            self.push_screen(CommandPalette(placeholder=words, id="--command-palette"))

    def action_help_quit(self) -> None:
        """Ctrl+C copies elsewhere: say how to leave."""
        self.notify(_("Press q, or Ctrl+Q in a text field, to leave."), markup=False)

    def speak(self, code: str) -> None:
        """Speak this language from now on, and draw every text anew."""
        set_language(code)
        for screen in self.screen_stack:
            screen.post_message(LanguageChanged())
        self.feed.tell(LanguageChanged)
        self.refresh_bindings()

    def switch_language(self) -> None:
        """Speak the next language."""
        self.speak(LANGUAGES[(LANGUAGES.index(language()) + 1) % len(LANGUAGES)])

    def redraw(self) -> None:
        """Draw everything anew."""
        self.refresh(layout=True)

    def get_key_display(self, binding: Binding) -> str:
        """Return how a key is written, in the language spoken now."""
        return _("space") if binding.key == "space" else super().get_key_display(binding)

    def next_theme(self) -> None:
        """Take the next theme of the cycle."""
        self.theme = after(self.theme)


def every_action() -> frozenset[str]:
    """Return the binding id of every action there is; it takes every screen to know them."""
    for module, _made in SCREENS.values():
        import_module(module)
    for dialog in DIALOGS:
        import_module(dialog)
    return frozenset(REGISTRY)


def run_screen(
    profile: Path | None,
    *,
    hardware: str = "mock",
    overrides: Sequence[str] = (),
    domain: int | None = None,
    lang: str | None = None,
    attach: str | None = None,
    bandwidth: int | None = None,
) -> int:
    """Show the screen until it is left; return the exit code of the program.

    With a `profile` that is started, with `attach` that session is shown, else one is picked.
    `bandwidth` is as in `run_live`.
    """
    from tui.live import run_live

    request = OpenRequest(profile, attach, hardware, tuple(overrides), domain)
    return run_live(request, lang, bandwidth)
