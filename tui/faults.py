"""What fails on the screen: told once, in the place where it is, while all the rest goes on.

A fault of a panel must not take the emergency stop away. `tui.isolation` brings every
exception that Textual would end the app by to `Faults.caught`.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass
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
"""Takes what has failed, in a line, and its traceback."""
TOLD_AGAIN_S = 60.0
"""The same fault is told so often at most, however often it comes."""
MOST_TOLD = 64
"""So many different faults are told, each with its traceback; of more only their number counts."""
UNDRAWN_WITHIN_S = 20.0
MOST_UNDRAWN = 3
"""A screen that so often within that time could not be drawn is given up."""
RETRY_S = 0.2
LAYING_OUT = frozenset({"_refresh_layout", "_compositor_refresh"})
"""Where Textual draws a whole screen."""
COMPOSING = frozenset({"_compose", "_on_compose"})
"""Where it makes what is on it."""


@dataclass
class Told:
    """When a fault was told, and how often it has come since."""

    at_s: float
    again: int = 0


@runtime_checkable
class Failing(Protocol):
    """A panel: it can say in its own place that it has failed."""

    @property
    def title(self) -> str:
        """Its name, marked by `N_`."""

    @property
    def failed(self) -> bool:
        """Whether words stand in its place."""

    def show_fault(self, words: str) -> None:
        """Say in its place what has failed; nothing has if there are no words."""


class SafetyNet(Protocol):
    """What stands in place of a screen that cannot be drawn."""

    @property
    def has_begun(self) -> bool:
        """Whether the first frame is out."""

    async def show_safe_screen(self, broken: Screen[Any]) -> None:
        """Let go of a screen that cannot be drawn."""

    def is_safe(self, screen: Screen[Any]) -> bool:
        """Whether this is what is shown in place of others."""

    def give_up(self, words: str) -> None:
        """Leave, in order: nothing can be drawn any more."""


class Faults:
    """Decides what becomes of an exception; without a journal it ends the app, as in a test."""

    def __init__(self, app: App[Any], net: SafetyNet, journal: Journal | None) -> None:
        """Tell of faults in `app`; what cannot be drawn is for `net`."""
        self._app = app
        self._net = net
        self._journal = journal
        self._told: dict[tuple[type[BaseException], str], Told] = {}
        self._undrawn: WeakKeyDictionary[Screen[object], list[float]] = WeakKeyDictionary()
        """When each screen could not be drawn; one below the front one fails again and again."""
        self.given_up = False
        """Whether not even the safe screen can be drawn: the app ends, in order."""

    @property
    def isolates(self) -> bool:
        """Whether the app outlives an exception now: not before it has begun, or has ended."""
        return self._journal is not None and self._app.is_running and self._net.has_begun

    def caught(self, error: Exception, place: Widget | None = None) -> str:
        """Take an exception that nobody else takes, and return it in words.

        A `place` shows them itself; else they are shown by the panel that failed, if it was one.
        Raises the exception where faults are not isolated.
        """
        if not self.isolates:
            raise error
        try:
            return self._take(error, place)
        except Exception:  # noqa: BLE001 - who tells of faults must not be one
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
        """See that the next frame can be drawn."""
        panel, screen = _panel_of(failed), _not_drawn(frames)
        hidden = panel is not None and not panel.failed
        if panel is not None:
            panel.show_fault(words)
        if screen is not None and (hidden or not self._give_up(screen, frames)):
            # Textual lays nothing out again by itself after it has failed to.
            size = self._app.size
            self._app.set_timer(RETRY_S, lambda: screen.post_message(Resize(size, size)))

    def _is_news(self, cause: BaseException, frames: list[FrameType]) -> bool:
        where = f"{frames[-1].f_code.co_filename}:{frames[-1].f_lineno}" if frames else ""
        key, now_s = (type(cause), where), monotonic()
        told = self._told.get(key)
        if told is None:
            self._told[key] = Told(now_s)
            return len(self._told) <= MOST_TOLD
        told.again += 1
        if now_s - told.at_s < TOLD_AGAIN_S:
            return False
        told.at_s = now_s
        return True

    def _tell(self, words: str, cause: BaseException) -> None:
        if self._journal is not None:
            self._journal(words, "".join(traceback.format_exception(cause)))
        self._app.notify(words, severity="error", timeout=15, markup=False)

    def _give_up(self, screen: Screen[object], frames: list[FrameType]) -> bool:
        """Show what can be drawn in place of a screen that cannot, if it has been tried enough."""
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


def bear(widget: Widget, error: Exception) -> str:
    """Tell what has failed in `widget`, and return what is to be shown there.

    Raises it where nobody isolates faults.
    """
    faults = faults_of(widget.app)
    if faults is None:
        raise error
    return faults.caught(error, widget)


def faults_of(app: App[object]) -> Faults | None:
    """Return who takes the faults of an app; None for one that is not Deck's."""
    faults = getattr(app, "faults", None)
    return faults if isinstance(faults, Faults) else None


def words_of(cause: BaseException, place: Widget | None) -> str:
    """Say where something has failed, and by what."""
    said = plain(str(cause), 200)
    kind = f"{type(cause).__name__}: {said}" if said else type(cause).__name__
    words = _("{place} has failed ({kind}). The rest goes on.")
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
    """Return the panel that a widget is in, itself perhaps."""
    nodes = () if place is None else place.ancestors_with_self
    return next((node for node in nodes if isinstance(node, Failing)), None)


def _cause(error: BaseException) -> BaseException:
    """Return what failed in a worker, or the exception itself."""
    inner = getattr(error, "error", None)
    return inner if isinstance(inner, BaseException) else error


def _frames(error: BaseException) -> Iterator[FrameType]:
    trace = error.__traceback__
    while trace is not None:
        yield trace.tb_frame
        trace = trace.tb_next


def _innermost(frames: list[FrameType]) -> Widget | None:
    """Return the widget whose method was the last to be called."""
    selves = (frame.f_locals.get("self") for frame in reversed(frames))
    return next((node for node in selves if isinstance(node, Widget)), None)


def _not_drawn(frames: list[FrameType]) -> Screen[object] | None:
    """Return the screen that could not be drawn, or made, because of this."""
    for frame in frames:
        node, method = frame.f_locals.get("self"), frame.f_code.co_name
        if isinstance(node, Screen) and method in LAYING_OUT | COMPOSING:
            return node
    return None


def _is_composing(frames: list[FrameType], screen: Screen[object]) -> bool:
    return any(
        frame.f_locals.get("self") is screen and frame.f_code.co_name in COMPOSING
        for frame in frames
    )
