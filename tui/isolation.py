"""The places where an exception would make Textual end the app, redirected to `Faults`.

Textual 8 has no hook for them: an exception in a message handler ends the widget's own loop and the
app, and a widget that cannot be drawn leaves the whole screen undrawn. All private parts of Textual
that this needs are used in this file and `tui.faults`; a test fails when one of them disappears.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING
from weakref import WeakSet

from rich.style import Style
from textual.message_pump import MessagePump
from textual.strip import Strip
from textual.widget import Widget

from tui.faults import faults_of, report_fault

if TYPE_CHECKING:
    from textual.geometry import Region
    from textual.message import Message

_dispatch = MessagePump._dispatch_message  # noqa: SLF001 - see above
_render_lines = Widget.render_lines
_failed: WeakSet[Widget] = WeakSet()
"""Widgets that show an error message in their place."""


@contextmanager
def isolating() -> Iterator[None]:
    """Stop exceptions at the widget that raised them, in apps that have `Faults`."""
    MessagePump._dispatch_message = _guarded_dispatch  # type: ignore[method-assign]  # noqa: SLF001
    Widget.render_lines = _guarded_lines  # type: ignore[method-assign]
    try:
        yield
    finally:
        MessagePump._dispatch_message = _dispatch  # type: ignore[method-assign]  # noqa: SLF001
        Widget.render_lines = _render_lines  # type: ignore[method-assign]


async def _guarded_dispatch(self: MessagePump, message: Message) -> None:
    """Handle a message; a widget that fails on one message still gets the next."""
    try:
        await _dispatch(self, message)
    except Exception as error:
        faults = faults_of(self.app)
        if faults is None:
            raise
        faults.caught(error)


def _guarded_lines(self: Widget, crop: Region) -> list[Strip]:
    """Draw a widget; if that fails, show an error message in its place."""
    try:
        strips = _render_lines(self, crop)
    except Exception as error:  # noqa: BLE001 - raised again where faults are not isolated
        words = report_fault(self, error)
        _failed.add(self)
        return _in_its_place(self, words, crop)
    if self in _failed:
        _failed.discard(self)
        # Remnants of the error message may surround what is drawn now.
        self.refresh()
    return strips


def _in_its_place(widget: Widget, words: str, crop: Region) -> list[Strip]:
    # Not needed for the first frame.
    from tui.widgets.words import word_strips

    width, base = widget.outer_size.width, _style_of(widget)
    lines = word_strips((words, ""), width, base, widget.app.console)
    blank = Strip.blank(width, base)
    return [(lines[y] if y < len(lines) else blank).crop(crop.x, crop.right) for y in crop.line_range]


def _style_of(widget: Widget) -> Style:
    """Return the widget's own style, unless that is what failed."""
    try:
        style: Style = widget.rich_style
    except Exception:  # noqa: BLE001 - words in any style are better than none
        return Style()
    return style
