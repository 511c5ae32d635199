"""Failures in the screen: reported once, where they occurred, while everything else keeps running.

A fault in a panel must not take the emergency stop away. `tui.isolation` sends every exception that
would make Textual end the app to `Faults.caught`.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterator
from time import monotonic
from types import FrameType
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable
from weakref import WeakKeyDictionary

from textual.events import Resize
from textual.screen import Screen
from textual.widget import Widget

from text.i18n import _
from text.plain import plain
from tui.actions.action import REGISTRY

if TYPE_CHECKING:
    from textual.app import App


Journal = Callable[[str, str], None]
"""Receives a failure as one line, and its traceback."""
TOLD_AGAIN_S = 60.0
"""The same fault is reported at most once in this time, however often it occurs."""
MOST_TOLD = 64
"""This many different faults are reported with a traceback; further ones are only counted."""
UNDRAWN_WITHIN_S = 20.0
MOST_UNDRAWN = 3
"""A screen that could not be drawn this often within that time is given up."""
RETRY_S = 0.2
LAYING_OUT = frozenset({"_refresh_layout", "_compositor_refresh"})
"""The methods in which Textual draws a whole screen."""
COMPOSING = frozenset({"_compose", "_on_compose"})
"""The methods in which Textual creates the widgets of a screen."""


@runtime_checkable
class Failing(Protocol):
    """A panel that can show its own failure."""

    @property
    def title(self) -> str:
        """Its name, marked by `N_`."""

    @property
    def failed(self) -> bool:
        """Whether an error message is shown in its place."""

    def show_fault(self, words: str) -> None:
        """Show an error message in its place; an empty text means it works again."""


class SafetyNet(Protocol):
    """Replaces a screen that cannot be drawn."""

    @property
    def has_begun(self) -> bool:
        """Whether the first frame has been drawn."""

    async def show_safe_screen(self, broken: Screen[Any]) -> None:
        """Discard a screen that cannot be drawn."""

    def is_safe(self, screen: Screen[Any]) -> bool:
        """Whether this is the screen shown in place of a broken one."""

    def give_up(self, words: str) -> None:
        """Exit cleanly: nothing can be drawn any more."""


class Faults:
    """Decides what happens to an exception; without a journal it ends the app, as in tests."""

    def __init__(self, app: App[Any], net: SafetyNet, journal: Journal | None) -> None:
        """Report faults in `app`; `net` replaces screens that cannot be drawn."""
        self._app = app
        self._net = net
        self._journal = journal
        self._told: dict[tuple[type[BaseException], str], float] = {}
        """When each fault was reported."""
        self._undrawn: WeakKeyDictionary[Screen[object], list[float]] = WeakKeyDictionary()
        """Times at which each screen could not be drawn; one below the front one keeps failing."""
        self.given_up = False
        """Whether not even the safe screen can be drawn: then the app exits cleanly."""

    @property
    def isolates(self) -> bool:
        """Whether the app survives an exception now: only between its first frame and its end."""
        return self._journal is not None and self._app.is_running and self._net.has_begun

    def caught(self, error: Exception, place: Widget | None = None) -> str:
        """Handle an uncaught exception, and return it as a message.

        A `place` shows the message itself; otherwise the failed panel shows it, if it was one.
        Re-raises the exception where faults are not isolated.
        """
        if not self.isolates:
            raise error
        try:
            return self._take(error, place)
        except Exception:  # noqa: BLE001 - reporting a fault must not cause another
            return type(error).__name__

    def _take(self, error: Exception, place: Widget | None) -> str:
        cause = _cause(error)
        frames = list(_frames(cause))
        failed = place or _innermost(frames)
        words = words_of(cause, failed)
        if self._is_news(cause, frames):
            self._tell(words, cause)
        if place is None:
            self._put_right(words, failed, frames)
        return words

    def _put_right(self, words: str, failed: Widget | None, frames: list[FrameType]) -> None:
        """Make sure that the next frame can be drawn."""
        panel, screen = _panel_of(failed), _not_drawn(frames)
        hidden = panel is not None and not panel.failed
        if panel is not None:
            panel.show_fault(words)
        if screen is not None and (hidden or not self._give_up(screen, frames)):
            # Textual does not repeat a layout by itself after one has failed.
            size = self._app.size
            self._app.set_timer(RETRY_S, lambda: screen.post_message(Resize(size, size)))

    def _is_news(self, cause: BaseException, frames: list[FrameType]) -> bool:
        where = f"{frames[-1].f_code.co_filename}:{frames[-1].f_lineno}" if frames else ""
        key, now_s = (type(cause), where), monotonic()
        is_new = key not in self._told
        if not is_new and now_s - self._told[key] < TOLD_AGAIN_S:
            return False
        self._told[key] = now_s
        return not is_new or len(self._told) <= MOST_TOLD

    def _tell(self, words: str, cause: BaseException) -> None:
        if self._journal is not None:
            self._journal(words, "".join(traceback.format_exception(cause)))
        self._app.notify(words, severity="error", timeout=15, markup=False)

    def _give_up(self, screen: Screen[object], frames: list[FrameType]) -> bool:
        """Show the substitute for a screen that cannot be drawn, after enough attempts."""
        now_s = monotonic()
        before = self._undrawn.get(screen, [])
        undrawn = [*(at for at in before if now_s - at < UNDRAWN_WITHIN_S), now_s]
        if len(undrawn) < MOST_UNDRAWN and not _is_composing(frames, screen):
            self._undrawn[screen] = undrawn
            return False
        self._undrawn.pop(screen, None)
        self._replace(screen)
        return True

    def _replace(self, screen: Screen[object]) -> None:
        if screen is not self._app.screen or self.given_up:
            return
        if self._net.is_safe(screen):
            self.given_up = True
            self._net.give_up(_("Deck cannot draw its screen any more."))
        else:
            self._app.call_later(self._net.show_safe_screen, screen)


def report_fault(widget: Widget, error: Exception) -> str:
    """Report a failure in `widget`, and return the text to be shown in its place.

    Raises the exception where faults are not isolated.
    """
    faults = faults_of(widget.app)
    if faults is None:
        raise error
    return faults.caught(error, widget)


def faults_of(app: App[object]) -> Faults | None:
    """Return the fault handler of an app; None for one that is not Deck's."""
    faults = getattr(app, "faults", None)
    return faults if isinstance(faults, Faults) else None


def words_of(cause: BaseException, place: Widget | None) -> str:
    """Say what failed, and where."""
    said = plain(str(cause), 200)
    kind = f"{type(cause).__name__}: {said}" if said else type(cause).__name__
    words = _("{place} has failed ({kind}). Everything else keeps working.")
    return words.format(place=_name_of(place), kind=kind)


def _name_of(place: Widget | None) -> str:
    panel = _panel_of(place)
    if panel is not None:
        return _(panel.title)
    if place is None:
        return "Deck"
    shown_by = REGISTRY.get(f"screen.{getattr(place, 'tab', '')}")
    return type(place).__name__ if shown_by is None else _(shown_by.title)


def _panel_of(place: Widget | None) -> Failing | None:
    """Return the panel that contains a widget, which may be the widget itself."""
    nodes = () if place is None else place.ancestors_with_self
    return next((node for node in nodes if isinstance(node, Failing)), None)


def _cause(error: BaseException) -> BaseException:
    """Return the cause of a worker's failure, or the exception itself."""
    inner = getattr(error, "error", None)
    return inner if isinstance(inner, BaseException) else error


def _frames(error: BaseException) -> Iterator[FrameType]:
    trace = error.__traceback__
    while trace is not None:
        yield trace.tb_frame
        trace = trace.tb_next


def _innermost(frames: list[FrameType]) -> Widget | None:
    """Return the widget whose method was called last."""
    selves = (frame.f_locals.get("self") for frame in reversed(frames))
    return next((node for node in selves if isinstance(node, Widget)), None)


def _not_drawn(frames: list[FrameType]) -> Screen[object] | None:
    """Return the screen that could not be drawn, or created, because of this."""
    for frame in frames:
        node, method = frame.f_locals.get("self"), frame.f_code.co_name
        if isinstance(node, Screen) and method in LAYING_OUT | COMPOSING:
            return node
    return None


def _is_composing(frames: list[FrameType], screen: Screen[object]) -> bool:
    return any(frame.f_locals.get("self") is screen and frame.f_code.co_name in COMPOSING for frame in frames)
