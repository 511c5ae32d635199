"""Drivers in a table: their state, what they are connected to, and the traffic."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from graph.diagnostics import StatusLevel
from text.figures import whole
from text.i18n import N_, _
from text.plain import plain
from tui.devices.reading import STALE_S, Device
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from collections.abc import Sequence

STATES = {
    StatusLevel.OK: (N_("● fine"), "good"),
    StatusLevel.WARN: (N_("▲ warning"), "warn"),
    StatusLevel.ERROR: (N_("✗ error"), "bad"),
    StatusLevel.STALE: (N_("○ stale"), "dim"),
}
"""Words and meaning (`tui.widgets.rows.Cell`) of each level."""
_HOME, _WIDE = 100, 160
"""Widths from which on there is a column for the message, and for more figures."""
NOTHING = Cell("–", "dim")


class _Layout(NamedTuple):
    """Widths of the columns; 0 leaves one out."""

    name: int
    port: int
    since: int
    frames: int
    message: bool


def _layout(width: int) -> _Layout:
    if width >= _WIDE:
        return _Layout(24, 44, 19, 8, message=True)
    if width >= _HOME:
        return _Layout(18, 20, 8, 0, message=True)
    return _Layout(15, 0, 8, 0, message=False)


class DevicesTable(Rows):
    """One row for each driver."""

    def show_devices(self, devices: Sequence[Device], now_s: float) -> None:
        """Show these drivers; ages are as of `now_s` (Unix seconds)."""
        # The table is as wide as the screen, but has no width of its own before it is first shown.
        layout = _layout(self.screen.size.width)
        self.show(_columns(layout), [_row(device, layout, now_s) for device in devices])


def _columns(layout: _Layout) -> list[Column]:
    frames = [Column(_("frames/s"), layout.frames, right=True)] if layout.frames else []
    return [
        Column(_("driver"), layout.name),
        Column(_("state"), 12),
        Column(_("port"), layout.port),
        Column(_("since"), layout.since),
        Column(_("B/s in"), 7, right=True),
        Column(_("B/s out"), 8, right=True),
        *frames,
        Column(_("errors"), 9, right=True),
        *([Column(_("message"))] if layout.message else []),
    ]


def _row(device: Device, layout: _Layout, now_s: float) -> Row:
    frames = [figure(device, "frames_in_per_s")] if layout.frames else []
    cells = (
        Cell(plain(device.report.name)),
        state(device, now_s),
        _port(device, layout.port or 14),
        _since(device, layout.since),
        figure(device, "bytes_in_per_s"),
        figure(device, "bytes_out_per_s"),
        *frames,
        errors(device),
        *([Cell(device.report.message)] if layout.message else []),
    )
    return Row(device.report.name, cells)


def state(device: Device, now_s: float) -> Cell:
    """The state that it reports, as long as the report is recent."""
    age_s = device.age_s(now_s)
    if age_s > STALE_S:
        return Cell(_("○ stale {seconds} s").format(seconds=round(min(age_s, 9999.0))), "dim")
    words, meaning = STATES[device.report.level]
    return Cell(_(words), meaning)


def _port(device: Device, width: int) -> Cell:
    """The port; of a long path the last part, and of that the end, which tells devices apart."""
    port = device.port
    if len(port) > width:
        port = port.rsplit("/", 1)[-1]
    if not port:
        return NOTHING
    return Cell(port if len(port) <= width else f"…{port[1 - width :]}")


def _since(device: Device, width: int) -> Cell:
    if device.connected is False:
        return Cell(_("no link"), "bad")
    return Cell(device.since[-width:]) if device.since else NOTHING


def figure(device: Device, key: str) -> Cell:
    """A number as it was reported."""
    value = device.number(key)
    return NOTHING if value is None else Cell(grouped(value))


def errors(device: Device) -> Cell:
    """The total, and how many a second now."""
    total, rate = device.number("errors"), device.number("errors_per_s")
    if total is None:
        return NOTHING
    if not rate:
        return Cell(grouped(total))
    return Cell(f"{grouped(total)} +{whole(rate)}" if rate >= 1 else f"{grouped(total)} +", "bad")


def grouped(value: float) -> str:
    """A whole number with blanks between thousands; anything else unchanged."""
    return f"{value:,.0f}".replace(",", "\N{NO-BREAK SPACE}")
