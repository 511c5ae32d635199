"""The app: its screens, languages and themes, and opening, closing and leaving the session."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterator, Sequence
from contextvars import copy_context
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from textual.app import App
from textual.binding import Binding, BindingType
from textual.events import InputEvent, Key, Paste
from textual.keys import key_to_character
from textual.widget import Widget

from graph.observer.requests import StopCommanding
from text.i18n import LANGUAGES, _, language, set_language
from text.plain import plain, plain_lines
from text.program import typable
from tui.actions import Acting, Action, Keys, bindings
from tui.agents.control import AgentControl
from tui.dialogs.opening import OpeningScreen
from tui.emergency.control import EmergencyControl
from tui.emergency.messages import EmergencyChanged
from tui.emergency.state import FOLLOWED
from tui.faults import Faults
from tui.frame.actions.agents import AGENT_ACTIONS
from tui.frame.actions.app import APP_ACTIONS, emergency_release, emergency_stop
from tui.frame.actions.recording import RECORDING_ACTIONS, record_toggle
from tui.frame.actions.replay import REPLAY_ACTIONS
from tui.frame.actions.ros2 import copy_as_ros2
from tui.frame.actions.view import open_view
from tui.frame.replay_bar import ReplayBar
from tui.lifecycle.sessions import Sessions
from tui.recording.recording import Recording
from tui.screens import Screens
from tui.session.bypass import BypassDetector
from tui.session.feed import Feed, GraphReady
from tui.session.messages import LanguageChanged, LessonOpened
from tui.settings import SEEN
from tui.terminal.bandwidth import Bandwidth
from tui.terminal.driver import DeckDriver
from tui.terminal.harmless import Harmless
from tui.terminal.key_queue import KeyQueue
from tui.terminal.pixels import GraphicsChanged, Pixels
from tui.terminal.stall_detector import KeyStallDetector
from tui.themes import HIGH_CONTRAST, after, few_colours
from tui.viewing.view import View

if TYPE_CHECKING:
    from textual.command import Provider
    from textual.driver import Driver
    from textual.events import Event
    from textual.filter import LineFilter
    from textual.notifications import SeverityLevel
    from textual.screen import Screen

    from tui.faults import Journal
    from tui.frame.host import SharedLesson
    from tui.recording.recording import RecordingWish
    from tui.session.ports import SessionOpener
    from tui.session.requests import OpenRequest

BYPASS_S = 20.0
"""How long the notification about a publisher that bypasses the gate is shown."""


def _commands() -> type[Provider]:
    from tui.palette import Commands

    return Commands


class AppEnvironment(Protocol):
    """The environment of an app on a real terminal; without a terminal these methods do nothing."""

    @property
    def terminal_fd(self) -> int:
        """File descriptor that the terminal is written to."""

    def arrive(self, app: DeckApp) -> None:
        """Record that the app is now running."""

    def desert(self) -> None:
        """Begin to end, because the terminal is gone."""

    def remember(self, **values: str) -> None:
        """Save what was chosen, such as theme, language and lesson, for the next run."""


class DeckApp(App[int], Acting):
    """The Textual app that shows the lessons."""

    TITLE = "Deck"
    BINDINGS: ClassVar[list[BindingType]] = bindings(
        *APP_ACTIONS, copy_as_ros2, open_view, *REPLAY_ACTIONS, *RECORDING_ACTIONS, *AGENT_ACTIONS
    )
    COMMANDS: ClassVar = {_commands}
    ENABLE_COMMAND_PALETTE = False
    """Disables Textual's own key for it; Deck's palette is in the language of the screen."""

    _environment: AppEnvironment | None = None

    def __init__(
        self,
        opener: SessionOpener,
        request: OpenRequest,
        first_screen: str = "",
        driver_class: type[Driver] | None = None,
        journal: Journal | None = None,
        bandwidth: Bandwidth | None = None,
        pixels: Pixels | None = None,
        environment: AppEnvironment | None = None,
    ) -> None:
        """Start with `opener`, which lists and opens sessions; an empty `request` shows the picker.

        With a `journal`, the app survives exceptions raised by its widgets, see `tui.faults`.
        """
        super().__init__(driver_class=driver_class)
        self._environment = environment
        self.faults = Faults(self, self, journal)
        self.lesson: SharedLesson | None = None
        """What is shown of the session's lesson, once something has shown it."""
        self.editor = ""
        """The editor that the user has chosen, empty if they were not asked yet."""
        self.tour_is_due = False
        """Whether the tour is to be shown above the list of lessons: it never was."""
        self.has_begun = False
        """Whether the first frame has been drawn."""
        self.feed = Feed(self, FOLLOWED, self.faults)
        self.emergency = EmergencyControl(self, self.feed, self._emergency_changed)
        self.agents = AgentControl(self, self.feed)
        self.bypass = BypassDetector()
        self.recording = Recording(self, self.feed, lambda: self.keys_of(record_toggle)[0])
        self.view = View(self, self.feed)
        self._screens = Screens(self)
        self.sessions = Sessions(
            self, self._screens, self.feed, self.recording, self.emergency, self.bypass, opener, request
        )
        self.stall_detector = KeyStallDetector()
        self.bandwidth = bandwidth or Bandwidth()
        """Counts what is written to the terminal, and limits the share of pictures."""
        self.pixels = pixels or Pixels()
        self.stopped_s = -math.inf
        """Keys up to this time of the monotonic clock were typed before the last stop."""
        self._own_context = copy_context()
        """What Textual expects of whoever calls it."""
        self._harmless = Harmless()
        self._key_queue = KeyQueue(self)
        self._first_screen = "picker" if self.sessions.picking else first_screen or request.screen
        self.register_theme(HIGH_CONTRAST)

    def get_default_screen(self) -> Screen[Any]:
        """Start with a screen that costs almost nothing, so that the first frame comes at once."""
        opening = self.sessions.opening
        words = _("opening {name}…").format(name=plain(opening)) if opening else _("Lessons")
        return OpeningScreen(words)

    def on_mount(self) -> None:
        """Continue once the first frame has been drawn."""
        if self._environment is not None:
            self._environment.arrive(self)
        self.stall_detector.watch()
        self._own_context = copy_context()
        # A short pause lets the threads that write to the terminal run.
        self.call_after_refresh(self.set_timer, 0.01, self._begin)

    def on_unmount(self) -> None:
        """Leave no threads behind."""
        self.stall_detector.end()

    async def on_event(self, event: Event) -> None:
        """Handle keys one at a time; only the emergency stop does not wait its turn."""
        # Before the first screen and after the last one there is nobody whom it could be for.
        if self._is_outdated(event) or (isinstance(event, (InputEvent, Paste)) and not self.screen_stack):
            return
        if not isinstance(event, (Key, Paste)) or event.is_forwarded:
            await super().on_event(event)
        elif not self._key_queue.must_wait(event):
            target = self.focused or self.screen
            await super().on_event(event)
            self._key_queue.given(event, target)
        elif not await self._stopped_by(event):
            self._key_queue.wait(event)

    async def _stopped_by(self, event: Key | Paste) -> bool:
        """Stop the wheels if this key means that where it was pressed; return whether it did."""
        return (
            isinstance(event, Key)
            and self._is_key_of(emergency_stop, event.key)
            and await self._check_bindings(event.key, priority=True)
        )

    def _is_key_of(self, action: Action[Any], key: str) -> bool:
        keys = self._keymap.get(action.id, action.key).split(",")
        return key in map(str.strip, keys)

    def _is_outdated(self, event: Event) -> bool:
        """Whether this key would release a stop that was pressed after it: the stop wins."""
        return (
            isinstance(event, Key) and event.time <= self.stopped_s and self._is_key_of(emergency_release, event.key)
        )

    def is_stop(self, key: str) -> bool:
        """Whether this key, pressed now, is the emergency stop; may be asked on any thread."""
        feed = self.feed
        if feed.link is None or feed.replay is not None or not self._is_key_of(emergency_stop, key):
            return False
        try:
            focused = self.focused
            nodes = () if focused is None else focused.ancestors_with_self
            character = key_to_character(key)
            return not any(node.check_consume_key(key, character) for node in nodes)
        except Exception:  # noqa: BLE001 - the screen is just changing: when in doubt, it is
            return True

    def stop_wheels(self) -> None:
        """Engage the emergency stop without waiting for the event loop; on any thread."""
        try:
            press = self.emergency.publish_now()
        except Exception:  # noqa: BLE001 - the thread that reads the keys must not end with it
            self._soon(self.emergency.engage)
        else:
            self._soon(lambda: self.emergency.pressed(press))

    def terminal_lost(self) -> None:
        """Command nothing any more, and begin to end; on any thread."""
        graph = self.feed.graph
        if graph is not None:
            graph.ask(StopCommanding())
        if self._environment is not None:
            self._soon(self._environment.desert)

    def tell_unread(self, sequence: str) -> None:
        """Say that the terminal has sent something that is no key; on any thread."""
        words = _("The terminal has sent {sequence}: Deck knows no such key and ignores it.")
        told = words.format(sequence=repr(sequence))
        self._soon(lambda: self.notify(told, severity="warning", markup=False))

    def keyboard_lost(self, error: Exception) -> None:
        """Stop the wheels, and give the terminal back with a word; on any thread."""
        # Nothing more than the message itself: it ends now.
        with contextlib.suppress(Exception):
            self.emergency.publish_now()
        words = _("deck: the keyboard cannot be read any more ({error}): the wheels were stopped")
        told = words.format(error=plain(repr(error), 200))
        self._soon(lambda: self.exit(return_code=1, message=told))

    def _soon(self, act: Callable[[], object]) -> None:
        """Act on the event loop, before any message that waits; on any thread."""
        if self._loop is not None:
            self._loop.call_soon_threadsafe(act, context=self._own_context)

    async def _begin(self) -> None:
        """Show the lesson, or the picker if none was named, and open what was requested."""
        self.has_begun = True
        await self.push_screen(self._screens.made(self._first_screen))
        self.sessions.begin()
        if self.tour_is_due and self.sessions.picking:
            self.show_tour()

    async def show_screen(self, name: str) -> None:
        """Bring the screen of this name to the front."""
        await self._screens.show(name)

    def get_css_variables(self) -> dict[str, str]:
        """Return the colours of the theme, adapted to what the terminal can distinguish."""
        variables = super().get_css_variables()
        if self.console.color_system == "standard":
            variables = {**variables, **few_colours(dark=self.current_theme.dark)}
            self.theme_variables = variables
        return variables

    def get_line_filters(self) -> Sequence[LineFilter]:
        """Check every line once more before it goes to the terminal."""
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
        """Show a notification as plain text."""
        message, title = plain_lines(typable(message)), plain(title)
        super().notify(message, title=title, severity=severity, timeout=timeout, markup=markup)

    def copy_to_clipboard(self, text: str) -> None:
        """Copy text made safe to paste, since it may be pasted into a shell."""
        super().copy_to_clipboard(plain_lines(text))

    async def show_safe_screen(self, broken: Screen[Any]) -> None:
        """Discard a screen that cannot be drawn; it is created again when next requested."""
        from tui.dialogs.safe import SafeScreen

        if broken is not self.screen:
            return
        await self.switch_screen(SafeScreen())
        if self.is_screen_installed(broken):
            self.uninstall_screen(broken)
            await broken.remove()

    def is_safe(self, screen: Screen[Any]) -> bool:
        """Whether this screen is the substitute for one that cannot be drawn."""
        from tui.dialogs.safe import SafeScreen

        return isinstance(screen, SafeScreen)

    def give_up(self, words: str) -> None:
        """Exit cleanly: nothing can be drawn any more."""
        self.sessions.parting_words = words
        self.sessions.leave(1)

    def _handle_exception(self, error: Exception) -> None:
        """Keep running where faults are isolated; Textual would end the app on any of them."""
        if self.faults.isolates:
            self.faults.caught(error)
        else:
            super()._handle_exception(error)

    def show_help(self) -> None:
        """Open the help page of the screen in front."""
        from tui.help.screen import HelpScreen

        if not isinstance(self.screen, HelpScreen):
            self.push_screen(HelpScreen(self.screen))

    def record(self) -> None:
        """Ask what to record, and start; or stop what is being recorded."""
        from graph.recording.recorder import room_bytes
        from launcher.rundir import new_recording
        from tui.bags.begin import BeginRecordingScreen

        session = self.feed.session
        if self.recording.active:
            self.recording.end_soon()
        elif isinstance(self.screen, BeginRecordingScreen):
            self.screen.begin()
        elif session is not None and self._can_be_covered:
            folder = new_recording(session.name)
            left_out = self.recording.left_out
            dialog = BeginRecordingScreen(folder, room_bytes(folder), left_out)
            self.push_screen(dialog, self._record_as_wished)

    def _record_as_wished(self, wish: RecordingWish | None) -> None:
        if wish is not None:
            self._remember(left_out=",".join(sorted(wish.left_out)))
            self.recording.begin(wish)

    def show_recordings(self) -> None:
        from tui.bags.listing import RecordingsScreen

        if not isinstance(self.screen, RecordingsScreen) and self._can_be_covered:
            self.push_screen(RecordingsScreen())

    @property
    def _can_be_covered(self) -> bool:
        """Whether a dialog may be opened above what is in front: not above one that goes itself."""
        return getattr(self.screen, "can_be_covered", True)

    @property
    def crashed(self) -> bool:
        """Whether the app ended because of a fault of its own."""
        return self._exception is not None

    def on_graph_ready(self, message: GraphReady) -> None:
        """Take the waiting update; the screens get it even if the emergency stop fails on it."""
        del message
        before, update = self.feed.update, self.feed.take_update()
        if update is None:
            return
        try:
            self.emergency.see(update)
        finally:
            self.feed.hand_over(update)
        front = self.feed.front
        grown_old = update.old_since_s != (None if before is None else before.old_since_s)
        counted = self.feed.watching and (before is None or before.nodes != update.nodes)
        if front and (grown_old or counted):
            # The title shows how many there are, and from when that is.
            front.show_frame()
        if self.bypass.see(update, self.feed.nodes):
            self._tell_of_bypass()

    def _tell_of_bypass(self) -> None:
        """Show in every title, and once as a notification, who publishes past the gate."""
        if words := self.bypass.words():
            self.notify(words[0], severity="error", timeout=BYPASS_S, markup=False)
        self.feed.tell(lambda: EmergencyChanged(self.emergency.state))

    def _emergency_changed(self) -> None:
        """Update every screen and the keys: release is possible only while the stop is engaged."""
        if self.emergency.state.engaged:
            self.agents.stopped()
        self.feed.tell(lambda: EmergencyChanged(self.emergency.state))
        self.refresh_bindings()

    def replay_changed(self) -> None:
        """Show at once the new position in the recording."""
        for bar in self.screen.query(ReplayBar):
            bar.look()

    def keys_of(self, action: Action[Any] | Keys) -> list[str]:
        """Return how the keys of `action` are written, following the user's keymap."""
        keys = self._keymap.get(action.id, action.key).split(",")
        return [self.key_text(key.strip()) for key in keys]

    def key_text(self, key: str) -> str:
        return self.get_key_display(Binding(key, ""))

    def show_tour(self) -> None:
        """Show the tour, which does not come by itself another time."""
        from tui.tour.screen import TourScreen

        self._remember(tour=SEEN)
        if not isinstance(self.screen, TourScreen):
            self.push_screen(TourScreen())

    def show_palette(self) -> None:
        """Open the palette in the current language."""
        from textual.command import CommandPalette

        if not isinstance(self.screen, CommandPalette):
            words = _("What would you like to do?")
            self.push_screen(CommandPalette(placeholder=words, id="--command-palette"))

    def action_help_quit(self) -> None:
        """Say how to quit, since Ctrl+C means copy in other programs."""
        self.notify(_("Press q, or Ctrl+Q in a text field, to leave."), markup=False)

    def speak(self, code: str) -> None:
        """Switch to this language; every widget draws itself anew, and those that keep words hear of it."""
        set_language(code)
        self._remember(language=code)
        for widget in self._widgets():
            widget.refresh(layout=True)
            widget.post_message(LanguageChanged())
        self.refresh_bindings()

    def _widgets(self) -> Iterator[Widget]:
        """All of them, also those of screens that are not shown."""
        for screen in {*self.screen_stack, *self._screens.there()}:
            yield screen
            yield from screen.walk_children(Widget)

    def on_graphics_changed(self) -> None:
        for widget in self._widgets():
            widget.post_message(GraphicsChanged())
        self.redraw()

    def switch_language(self) -> None:
        self.speak(LANGUAGES[(LANGUAGES.index(language()) + 1) % len(LANGUAGES)])

    def redraw(self) -> None:
        """Redraw everything, whatever the terminal may be showing."""
        if isinstance(self._driver, DeckDriver):
            self._driver.forget()
        self.refresh(layout=True)

    @property
    def terminal_fd(self) -> int:
        """The descriptor that the driver writes to; standard output without a real terminal."""
        return 1 if self._environment is None else self._environment.terminal_fd

    def terminal_is_gone(self) -> bool:
        """Record that the terminal is gone; nothing is written to it from now on."""
        if not isinstance(self._driver, DeckDriver) or not self._driver.gone:
            return False
        self._driver.give_up()
        return True

    def on_resize(self) -> None:
        """Redraw everything: a window that was made small and large again has lost its cells."""
        if isinstance(self._driver, DeckDriver):
            self.redraw()

    def use_editor(self, name: str) -> None:
        self.editor = name
        self._remember(editor=name)

    def watch_theme(self, theme: str) -> None:
        self._remember(theme=theme)

    def on_agents_changed(self) -> None:
        """Offer the keys that answer agents, and say who needs no answer."""
        self.agents.see()
        self.refresh_bindings()

    def on_lesson_opened(self, message: LessonOpened) -> None:
        """Remember the lesson, where the list begins the next time."""
        self._remember(lesson=message.name)

    def _remember(self, **values: str) -> None:
        if self._environment is not None:
            self._environment.remember(**values)

    def get_key_display(self, binding: Binding) -> str:
        """Return how a key is written in the current language."""
        return _("space") if binding.key == "space" else super().get_key_display(binding)

    def next_theme(self) -> None:
        self.theme = after(self.theme)
