"""The emergency stop for a node that moves nothing itself, and what is said of it on /emergency_stop_state."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Bool

from nodes.parts.node import DEPTH, LessonNode
from safety.stop_file import NOT_PASSED, PASSED_EVERY_S, TOPIC, KeptStop, StopFile
from safety.stop_record import Stop, StopRecord, read_record
from safety.topics import EMERGENCY_STATE, EMERGENCY_STOP
from text.i18n import N_

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


OF_MANY = QoSProfile(depth=64, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""Every node that obeys publishes its state, and all of them at once."""


class StopNews:
    """Hears the topic, and what those say that obey it: they may have heard what this node missed.

    What it broke off must not come back after the release. What it has heard itself it passes on by the
    disk: it may be the only one that has.
    """

    def __init__(self, node: LessonNode, stopped: Callable[[], None]) -> None:
        """`stopped` is called for each stop, for some more than once."""
        self._node, self._stopped = node, stopped
        self._record: StopRecord | None = None
        self._file = StopFile(node.context.get_domain_id(), node.get_fully_qualified_name())
        self._passed_s = 0.0
        self._waiting: Stop | None = None
        """The newest that was heard and not yet passed on."""
        node.every(PASSED_EVERY_S, self._pass_on)
        hear: Any = self._hear  # With what the middleware says, as in nodes.parts.emergency.
        node.create_subscription(Bool, EMERGENCY_STOP, hear, DEPTH)
        node.create_subscription(DiagnosticArray, EMERGENCY_STATE, self._hear_of, OF_MANY)

    def _hear(self, message: Bool, info: dict[str, Any]) -> None:
        if not message.data:
            return
        self._stopped()
        self._waiting = named(info)
        if time.monotonic() - self._passed_s > PASSED_EVERY_S:
            self._pass_on()

    def _pass_on(self) -> None:
        stop, self._waiting = self._waiting, None
        if stop is None:
            return
        self._passed_s = time.monotonic()
        problem = self._file.give(stop, TOPIC)
        if problem:
            self._node.say.error(NOT_PASSED, every_s=10.0, problem=problem)

    def _hear_of(self, message: DiagnosticArray) -> None:
        for report in read_reports(message):
            if self._record is None:
                # What was released before the first word is none of this node's.
                self._record = StopRecord(released=report.record.released)
            known = self._record.held | self._record.released.keys()
            self._record = self._record.merged(report.record)
            # Also one that is over already.
            if (report.record.held | report.record.released.keys()) - known:
                self._stopped()
