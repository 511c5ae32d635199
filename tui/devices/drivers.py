"""The drivers that report their state on /diagnostics: in a table, in words, and trouble made for them."""

from __future__ import annotations

import asyncio
import re
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from rich.cells import cell_len

from graph.diagnostics import StatusLevel
from graph.observer.requests import ReadParameters, SetParameters
from text.figures import elapsed, whole
from text.i18n import N_, _, localized
from text.plain import plain
from text.ros_names import DIAGNOSTICS
from tui.panels.panel import row_of
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from graph.data import GraphUpdate, TopicRow
    from graph.diagnostics import DiagnosticsBook, DiagnosticStatus
    from tui.session.feed import Feed
    from tui.session.ports import GraphLink

STALE_S = 3.0
"""A driver that has been silent for this long is stale: each reports once a second."""
MOST = 200
"""Maximum number of drivers shown."""
_ISO = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d")
STATES = {
    StatusLevel.OK: (N_("● fine"), "good"),
    StatusLevel.WARN: (N_("▲ warning"), "warn"),
    StatusLevel.ERROR: (N_("✗ error"), "bad"),
    StatusLevel.STALE: (N_("○ stale"), "dim"),
}
"""Words and meaning (`tui.widgets.rows.Cell`) of each level."""
NOTHING = Cell("–", "dim")


@dataclass(frozen=True)
class Device:
    """A driver: its last report, and what that tells of a port."""

    report: DiagnosticStatus
    heard_s: float
    """From when on it has been silent, unix time."""

    @property
    def port(self) -> str:
        return self.report.values.get("port") or self.report.hardware

    @property
    def connected(self) -> bool | None:
        """Whether its port is open, None if it does not say."""
        return {"true": True, "false": False}.get(self.report.values.get("connected", "").lower())

    @property
    def since(self) -> str:
        """Local date and time of the connection; empty without one."""
        since = self.report.values.get("connected_since", "")
        return since[:19].replace("T", " ") if _ISO.match(since) else ""

    def number(self, key: str) -> float | None:
        """The value as a number, None if it is not one."""
        try:
            return float(self.report.values[key])
        except (KeyError, ValueError):
            return None

    def age_s(self, now_s: float) -> float:
        """Seconds since its last report."""
        return max(0.0, now_s - self.heard_s)


def devices_of(book: DiagnosticsBook) -> list[Device]:
    devices = [Device(record.status, book.heard_s(record)) for record in book.records[:MOST]]
    return sorted(devices, key=lambda device: device.report.name)


def frames_topic(device: Device, topics: Iterable[TopicRow]) -> str | None:
    """The topic on which this driver publishes its frames, None if there is none.

    /diagnostics names a node without its namespace, so the shortest matching topic is taken.
    """
    name = device.report.name.strip("/")
    fitting = [
        row.name
        for row in topics
        if row.name.endswith(f"/{name}/frames") and "std_msgs/msg/String" in row.type_names and row.publishers
    ]
    return min(fitting, key=len, default=None) if name else None


class DevicesTable(Rows):
    """One row for each driver."""

    def show_devices(self, devices: Sequence[Device], now_s: float) -> None:
        """Show these drivers; ages are as of `now_s` (Unix seconds)."""
        # The table is as wide as the screen, but has no width of its own before it is first shown.
        columns = _columns(self.screen.size.width, now_s)
        rows = [Row(one.report.name, tuple(cell(one) for _column, cell in columns)) for one in devices]
        self.show([column for column, _cell in columns], rows)


def _columns(width: int, now_s: float) -> list[tuple[Column, Callable[[Device], Cell]]]:
    wide, home = width >= 160, width >= 100
    name, port, since = (24, 44, 19) if wide else (18, 20, 8) if home else (15, 0, 8)
    columns: list[tuple[Column, Callable[[Device], Cell]]] = [
        (Column(_("driver"), name), lambda device: Cell(plain(device.report.name))),
        (Column(_("state"), 12), lambda device: state(device, now_s)),
        (Column(_("port"), port), lambda device: _port(device, port or 14)),
        (Column(_("since"), since), lambda device: _since(device, since)),
        (Column(_("B/s in"), 7, right=True), lambda device: _figure(device, "bytes_in_per_s")),
        (Column(_("B/s out"), 8, right=True), lambda device: _figure(device, "bytes_out_per_s")),
        (Column(_("frames/s"), 8, right=True), lambda device: _figure(device, "frames_in_per_s")),
        (Column(_("errors"), 9, right=True), _errors),
        (Column(_("message")), lambda device: Cell(device.report.message)),
    ]
    if wide:
        return columns
    return [*columns[:6], columns[7], *(columns[8:] if home else ())]


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


def _figure(device: Device, key: str) -> Cell:
    value = device.number(key)
    return NOTHING if value is None else Cell(grouped(value))


def _errors(device: Device) -> Cell:
    """The total, and how many a second now."""
    total, rate = device.number("errors"), device.number("errors_per_s")
    if total is None:
        return NOTHING
    if not rate:
        return Cell(grouped(total))
    return Cell(f"{grouped(total)} +{whole(rate)}" if rate >= 1 else f"{grouped(total)} +", "bad")


def grouped(value: float) -> str:
    return f"{value:,.0f}".replace(",", "\N{NO-BREAK SPACE}")


def report_words(device: Device, now_s: float, width: int) -> str:
    """Return the message, and below it as many figures as fit into one line of `width` cells."""
    line = ""
    for figure in _figures(device):
        longer = f"{line} · {figure}" if line else figure
        if cell_len(longer) <= width:
            line = longer
    head = f"{plain(device.report.name)} · {state(device, now_s).text} · {device.report.message}"
    return f"{head}\n{line}" if line else head


def _figures(device: Device) -> list[str]:
    parts = [device.port] if device.port else []
    if device.since and device.connected:
        parts.append(_("since {since}").format(since=device.since))
        if (seconds := device.number("seconds")) is not None:
            parts[-1] += " " + _("({seconds} s)").format(seconds=grouped(seconds))
    for key, words in (
        ("bytes_in_per_s", _("in {count} B/s")),
        ("bytes_out_per_s", _("out {count} B/s")),
        ("frames_in_per_s", _("{count} frames/s")),
        ("errors_per_s", _("{count} errors/s")),
        ("errors", _("{count} errors in total")),
        ("reconnects", _("reconnects: {count}")),
    ):
        if (value := device.number(key)) is not None:
            parts.append(words.format(count=grouped(value)))
    return parts


def no_frames(device: Device, topic: str | None, now_s: float) -> str:
    """Say why no frame of this driver has arrived, and what to do."""
    name, age_s = plain(device.report.name), device.age_s(now_s)
    if age_s > STALE_S:
        words = _("{name} has said nothing for {seconds} s: has it ended? See Deck (1) or Logs (4).")
        return words.format(name=name, seconds=elapsed(age_s))
    if topic is None:
        words = _(
            "{name} reports its state, but does not publish {topic}: it has no serial port, or it "
            "is not one of Deck's drivers."
        )
        return words.format(name=name, topic=f"…/{name}/frames")
    if device.connected is False:
        return _("Nothing is connected, so no data arrives. The driver keeps trying.")
    return _("Listening on {topic}: traffic on the port, if any, appears within a second.").format(topic=topic)


def nobody(feed: Feed, update: GraphUpdate | None, lessons: tuple[str, ...]) -> list[str]:
    """Say why there is no driver at all, and what to do."""
    if feed.session is None:
        return [_("no lesson is running")]
    if update is not None and update.error:
        return [feed.blind, plain(localized(update.error))]
    row = row_of(update, DIAGNOSTICS) if update else None
    if row is not None and row.publishers:
        said_by = ", ".join(dict.fromkeys(plain(end.node) for end in row.published_by))
        words = _("{topic} is published by {nodes}; waiting for the first message.")
        return [words.format(topic=DIAGNOSTICS, nodes=said_by or "?")]
    drivers = [name for name, node in feed.nodes.items() if "driver" in node.roles]
    if drivers:
        words = _("{nodes} have not said anything on {topic} yet: see Deck (1) and Logs (4).")
        return [words.format(nodes=", ".join(map(plain, drivers)), topic=DIAGNOSTICS)]
    lines = [_("No driver says anything on {topic}.").format(topic=DIAGNOSTICS)]
    if feed.replay is not None:
        return [*lines, _("This recording has none of its messages.")]
    if not feed.watching:
        lines.append(_("This lesson has no drivers: its nodes simulate their readings."))
    if lessons:
        lines.append(_("Drivers run in: {lessons}.").format(lessons=", ".join(lessons)))
    return lines


def lessons_with_drivers() -> tuple[str, ...]:
    """The names of the profiles in which a driver runs; this reads all of them."""
    from launcher.errors import LauncherError
    from launcher.profile.catalog import list_profiles
    from launcher.profile.load import load_profile

    found: list[str] = []
    for entry in list_profiles():
        try:
            nodes = load_profile(entry.path).nodes.values()
        except LauncherError:
            continue
        if any("driver" in node.roles for node in nodes):
            found.append(entry.name)
    return tuple(found)


LINES = frozenset({"pico", "tof_front", "tof_rear", "lsc16"})
"""The pseudo-terminals of the simulated robot, and the parameters of its node for the trouble of each: set as
`ros2 param` does, with values of their own."""
POWERED = frozenset({"pico", "lsc16"})
"""The devices that measure the battery."""
_REAL = PurePosixPath("/dev")


@dataclass(frozen=True)
class SimulatedTrouble:
    """The values of a parameter with and without the trouble."""

    wrong: str | float
    fine: str | float
    told: str
    """Sentence with {device}, marked by `N_`."""
    over: str
    """The same for when it is cleared; it names only this trouble, as there may be others."""
    parameter: str = ""
    """Empty: the parameter named after the device."""
    devices: frozenset[str] = LINES
    """Devices that can have it."""


UNPLUGGED = SimulatedTrouble(
    "unplugged", "fine", N_("{device}: the cable is pulled."), N_("{device}: the cable is plugged in again.")
)
NOISE = SimulatedTrouble(
    "noise", "fine", N_("{device}: there is noise on the line."), N_("{device}: the noise is gone.")
)
SILENCE = SimulatedTrouble(
    "silent", "fine", N_("{device}: it has gone silent."), N_("{device}: it sends data again.")
)
BATTERY = SimulatedTrouble(5.8, 7.4, N_("The battery has 5.8 V."), N_("The battery has 7.4 V."), "battery", POWERED)


def simulated(device: Device | None, feed: Feed) -> tuple[str, str] | None:
    """Return the full name of the simulated robot's node, and which of its lines the device is.

    None for a device that is not simulated, and while the robot is not in the graph.
    """
    if device is None or feed.graph is None or feed.replay is not None or feed.update is None:
        return None
    port = PurePosixPath(device.port)
    if port.name not in LINES or _REAL in port.parents:
        return None
    robots = {name for name, node in feed.nodes.items() if "simulator" in node.roles}
    names = [row.name for row in feed.update.nodes if row.name.rpartition("/")[2] in robots]
    return (names[0], port.name) if names else None


async def switch(graph: GraphLink, node: str, device: str, trouble: SimulatedTrouble) -> tuple[bool, str]:
    """Cause the trouble, or clear it; return whether it is present now, or why that failed."""
    name = trouble.parameter or device
    read = await asyncio.wrap_future(graph.ask(ReadParameters(node)))
    now = next((row.value for row in read.parameters if row.name == name), None)
    if read.error or now is None:
        return False, read.error or name
    made = now != trouble.wrong
    done = await asyncio.wrap_future(graph.ask(SetParameters(node, {name: trouble.wrong if made else trouble.fine})))
    return made, done.error or done.refused.get(name, "")
