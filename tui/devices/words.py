"""The sentences of the Devices screen: about the chosen driver, and why nothing is shown."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from rich.cells import cell_len

from robot.topics import DIAGNOSTICS
from text.figures import elapsed
from text.i18n import _, localized
from text.plain import plain
from tui.devices.reading import STALE_S, Device
from tui.devices.table import grouped, state

if TYPE_CHECKING:
    from graph.data import GraphUpdate
    from tui.session.feed import Feed

DRIVERS = frozenset({"nodes.chassis", "nodes.tof_sonar", "nodes.camera", "nodes.audio"})
"""Nodes that report on /diagnostics, whatever their parameters."""
HEAD = "nodes.head_controller"
"""Reports as well, if it has a port."""


def whole(device: Device, now_s: float, width: int) -> str:
    """Return the message, and below it as many figures as fit into one line of `width` cells."""
    word = state(device, now_s).text
    lines = [f"{plain(device.report.name)} · {word} · {device.report.message}", ""]
    for figure in _figures(device):
        longer = f"{lines[1]} · {figure}" if lines[1] else figure
        if cell_len(longer) <= width:
            lines[1] = longer
    return "\n".join(line for line in lines if line)


def _figures(device: Device) -> list[str]:
    parts = [device.port] if device.port else []
    since, seconds = device.since, device.number("seconds")
    if since and device.connected:
        words = _("since {since}")
        parts.append(words.format(since=since))
        if seconds is not None:
            parts[-1] += " " + _("({seconds} s)").format(seconds=grouped(seconds))
    for key, words in (
        ("bytes_in_per_s", _("in {count} B/s")),
        ("bytes_out_per_s", _("out {count} B/s")),
        ("frames_in_per_s", _("{count} frames/s")),
        ("errors_per_s", _("{count} errors/s")),
        ("errors", _("{count} errors in total")),
        ("reconnects", _("reconnects: {count}")),
    ):
        value = device.number(key)
        if value is not None:
            parts.append(words.format(count=grouped(value)))
    return parts


def no_frames(device: Device, topic: str | None, now_s: float) -> str:
    """Say why no frame of this driver has arrived, and what to do."""
    name = plain(device.report.name)
    age_s = device.age_s(now_s)
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
    words = _("Listening on {topic}: traffic on the port, if any, appears within a second.")
    return words.format(topic=topic)


def nobody(feed: Feed, update: GraphUpdate | None, lessons: tuple[str, ...]) -> list[str]:
    """Say why there is no driver at all, and what to do."""
    if feed.session is None:
        return [_("no lesson is running")]
    if update is not None and update.error:
        return [feed.blind, plain(localized(update.error))]
    row = next((row for row in update.topics if row.name == DIAGNOSTICS), None) if update else None
    if row is not None and row.publishers:
        said_by = ", ".join(dict.fromkeys(plain(end.node) for end in row.published_by))
        return [
            _("{topic} is published by {nodes}; waiting for the first message.").format(
                topic=DIAGNOSTICS, nodes=said_by or "?"
            )
        ]
    drivers = [name for name, node in feed.nodes.items() if node.command in DRIVERS]
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


async def lessons_with_drivers() -> tuple[str, ...]:
    """The names of the profiles in which a driver runs."""
    return await asyncio.to_thread(_lessons_with_drivers)


def _lessons_with_drivers() -> tuple[str, ...]:
    from launcher.errors import LauncherError
    from launcher.profile.catalog import list_profiles
    from launcher.profile.load import load_profile

    found: list[str] = []
    for entry in list_profiles():
        try:
            nodes = load_profile(entry.path).nodes.values()
        except LauncherError:
            continue
        if any(node.run in DRIVERS or (node.run == HEAD and "port" in node.params) for node in nodes):
            found.append(entry.name)
    return tuple(found)
