"""The app on a real terminal: signals, hang-ups, stray output, and saved settings."""

from __future__ import annotations

import asyncio
import gc
import os
import signal
import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from textual.theme import BUILTIN_THEMES

from graph.memory import GIVEN_BACK_EVERY_S, give_back_free_memory, keep_room_for_large_messages
from launcher.errors import LauncherError
from launcher.processes.interrupts import run
from launcher.rundir import log_dir
from launcher.status import LogLine, Severity
from text.i18n import _, detect, set_language
from text.output import say_error
from text.plain import plain
from tui import clock
from tui.app import DeckApp
from tui.isolation import isolating
from tui.lifecycle.opener import LiveOpener
from tui.screens import every_action
from tui.session.requests import OpenRequest
from tui.settings import Settings, SettingsError, load, save, settings_path
from tui.terminal.bandwidth import Bandwidth, default_limit
from tui.terminal.driver import DeckDriver
from tui.terminal.pixels import Pixels, are_wanted, most_bytes
from tui.terminal.stray_output import StrayOutput
from tui.themes import HIGH_CONTRAST

if TYPE_CHECKING:
    from collections.abc import Sequence

LOOK_S = 0.5
"""How often to check that the terminal is still there."""
PATIENCE_S = 15.0
"""How long a session may take to stop once its terminal is gone."""
GARBAGE_AFTER = 10_000
"""New objects before a garbage collection; a screen creates and drops thousands a second."""
COLLECTED_EVERY_S = 120.0
"""How often all garbage is collected, which takes 0.1 s. Left alone, Python waits until what has
come is a quarter of everything: some megabytes, after many minutes."""
SIGNALS = (signal.SIGHUP, signal.SIGTERM, signal.SIGINT)


class RealTerminal:
    """Makes the app exit cleanly whatever the terminal does, and saves the settings."""

    def __init__(self, stray: StrayOutput, settings: Settings) -> None:
        """Pass `stray`, which catches output printed outside the screen."""
        self._stray = stray
        self._settings = settings
        self._stray_count = 0
        self._deserted = False
        self._settled = False
        self._app: DeckApp | None = None

    def arrive(self, app: DeckApp) -> None:
        """Apply the settings to the app, and watch the terminal."""
        self._app = app
        if self._settings.theme:
            app.theme = self._settings.theme
        app.set_keymap(self._settings.keys)
        app.sessions.last_lesson = self._settings.lesson
        app.editor = self._settings.editor
        app.recording.left_out = frozenset(filter(None, self._settings.left_out.split(",")))
        app.tour_is_due = not self._settings.tour
        loop = asyncio.get_running_loop()
        for number in SIGNALS:
            loop.add_signal_handler(number, self.desert, 128 + number)
        app.set_interval(LOOK_S, self._look)
        app.set_interval(COLLECTED_EVERY_S, _collect_garbage)
        app.set_interval(GIVEN_BACK_EVERY_S, give_back_free_memory)

    @property
    def app(self) -> DeckApp:
        assert self._app is not None
        return self._app

    @property
    def terminal_fd(self) -> int:
        """File descriptor that the terminal is written to."""
        return self._stray.terminal_fd

    def desert(self, code: int = 128 + signal.SIGHUP) -> None:
        """Exit because the terminal is gone, or because a signal says so."""
        if self._deserted:
            # A terminal that goes is noticed in several ways.
            if code != 128 + signal.SIGHUP:
                self.app.sessions.stop_now()
            return
        self._deserted = True
        self.app.sessions.leave(code)
        self.app.set_timer(PATIENCE_S, self.app.sessions.stop_now)

    def remember(self, **values: str) -> None:
        """Save what was chosen in the settings file."""
        changed: Any = replace(self._settings, **values)  # type: ignore[arg-type]
        if self._app is None or not self._app.is_running or changed == self._settings:
            return
        self._settings = changed
        try:
            save(settings_path(), changed)
        except SettingsError as error:
            self._app.notify(plain(str(error)), severity="warning", markup=False)

    def note_fault(self, words: str, trace: str) -> None:
        """Write a fault to the file of stray output, and report it in the log."""
        self._stray.write(trace)
        self._note([words], Severity.ERROR)

    def _look(self) -> None:
        self._settle()
        if self.app.terminal_is_gone():
            self.desert()
        self._note(self._stray.new_lines(), Severity.INFO)

    def _note(self, texts: Sequence[str], severity: Severity) -> None:
        """Add lines to the log as the node `deck`."""
        first, self._stray_count = self._stray_count + 1, self._stray_count + len(texts)
        if texts:
            self.app.feed.note(_as_lines(texts, first, severity))

    def _settle(self) -> None:
        """Once the first session is shown, exclude all existing objects from garbage collection.

        Most of them are code, and traversing them would delay a key by 0.1 s each time.
        """
        if not self._settled and self.app.feed.update is not None:
            self._settled = True
            gc.freeze()


def _collect_garbage() -> None:
    # Textual calls functions of Python only.
    gc.collect()


def _as_lines(texts: Sequence[str], first: int, severity: Severity) -> list[LogLine]:
    """Return stray output as log lines of the node `deck`."""
    now_s = clock.now()
    return [LogLine("deck", first + at, now_s, severity, plain(text), source="deck") for at, text in enumerate(texts)]


def run_live(request: OpenRequest, lang: str | None, bandwidth: int | None = None, pixels: str | None = None) -> int:
    """Run the app on this terminal; return the exit code of the program.

    `bandwidth` limits pictures, in bytes a second, with 0 for no limit; the default depends on the
    terminal. `pixels` is by default as in the settings.
    """
    gc.set_threshold(GARBAGE_AFTER)
    # Before there are threads, most of which would get a heap of their own.
    keep_room_for_large_messages()
    set_language(detect(lang))
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        return _refused(_("the screen needs a terminal; `deck run` works without one"))
    themes = {*BUILTIN_THEMES, HIGH_CONTRAST.name}
    try:
        settings = load(settings_path(), themes, every_action)
        stray = StrayOutput(log_dir() / f"screen-{os.getpid()}.log")
    except (SettingsError, LauncherError) as error:
        return _refused(str(error))
    set_language(detect(lang, settled=settings.language))
    limit = default_limit(os.environ) if bandwidth is None else bandwidth
    with stray, isolating():
        terminal = RealTerminal(stray, settings)
        app = DeckApp(
            LiveOpener(),
            request,
            driver_class=DeckDriver,
            journal=terminal.note_fault,
            bandwidth=Bandwidth(limit),
            pixels=Pixels(are_wanted(pixels or settings.pixels, limit), most_bytes=most_bytes(limit)),
            environment=terminal,
        )
        run(app.run_async())
    if app.sessions.parting_words:
        return _refused(app.sessions.parting_words, app.return_code or 0)
    if app.crashed:
        words = _("Deck has crashed; details are in {path}")
        return _refused(words.format(path=plain(str(stray.path))), 1)
    return app.return_code or 0


def _refused(words: str, code: int = 2) -> int:
    say_error(words)
    return code
