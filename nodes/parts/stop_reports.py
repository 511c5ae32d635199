"""/emergency_stop_state: what a node says of the stop that it obeys, made and read."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any, NamedTuple

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from robot.safety.stop_file import KeptStop
from robot.safety.stop_record import Stop, StopRecord, read_record
from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Iterator

HELD = N_("emergency stop until it is released")
FREE = N_("no emergency stop")
_TRUE = {True: "true", False: "false"}


class StopReport(NamedTuple):
    """What one node says."""

    node: str
    """Its full name."""
    record: StopRecord
    stop: KeptStop | None
    """The stop that it obeys."""
    is_of_old: bool = False
    """Whether it is from a Deck that names no stops, and can learn of none this way."""


def report_message(
    status: DiagnosticStatus, record: StopRecord, stop: KeptStop | None, released_s: float, *, contradicted: bool
) -> DiagnosticArray:
    """Return the message, with `status` for its name and sentence; its header is left empty."""
    status.level = DiagnosticStatus.OK if stop is None else DiagnosticStatus.ERROR
    values = {"engaged": _TRUE[stop is not None]}
    if stop is None:
        values["since"] = f"{released_s:.3f}"
    else:
        values.update(
            since=f"{stop.since_s:.3f}",
            by=stop.by,
            publishers=stop.publishers,
            remembered=_TRUE[stop.remembered],
            contradicted=_TRUE[contradicted],
        )
    values.update(record.texts())
    status.values = [KeyValue(key=key, value=value) for key, value in values.items()]
    return DiagnosticArray(status=[status])


def read_reports(message: DiagnosticArray) -> Iterator[StopReport]:
    """Yield what is said in a message; anybody may publish anything there."""
    for status in message.status:
        values = {pair.key: pair.value for pair in status.values}
        engaged = values.get("engaged")
        if engaged not in ("true", "false"):
            continue
        record = read_record(values.get("stops", ""), values.get("released", ""))
        since_s = _seconds(values.get("since", ""))
        is_of_old = "stops" not in values
        if engaged == "true" and not record.engaged:
            record = record.stopped(Stop(int(since_s * 1e9)))
        stop = KeptStop(since_s, values.get("by", ""), values.get("publishers", ""))
        yield StopReport(status.name, record, stop if record.engaged else None, is_of_old)


def named(info: dict[str, Any]) -> Stop:
    """Return by what all hearers know a message; by its arrival where the middleware says nothing.

    Source: rmw/types.h, `rmw_message_info_t`.
    """
    said_ns, number = info.get("source_timestamp"), info.get("publication_sequence_number")
    return Stop(said_ns or time.time_ns(), number or 0)


def _seconds(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        return 0.0
    return seconds if math.isfinite(seconds) and 0.0 <= seconds < 1e9 * 4 else 0.0
