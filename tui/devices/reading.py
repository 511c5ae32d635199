"""One `Device` for each driver that reports its state on /diagnostics."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from graph.data import TopicRow
    from graph.diagnostics import DiagnosticsBook, DiagnosticStatus, StatusRecord

STALE_S = 3.0
"""A driver that has been silent for this long is stale: each reports once a second."""
MOST = 200
"""Maximum number of drivers shown."""
_STRING = "std_msgs/msg/String"
_ISO = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d")


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
        said = self.report.values.get("connected", "").lower()
        return said == "true" if said in {"true", "false"} else None

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
    """Return the drivers that have reported, sorted by name."""
    records = sorted(book.records[:MOST], key=lambda record: record.status.name)
    return [device_of(book, record) for record in records]


def device_of(book: DiagnosticsBook, record: StatusRecord) -> Device:
    """Return the driver that a record is of."""
    return Device(record.status, book.heard_s(record))


def frames_topic(device: Device, topics: Iterable[TopicRow]) -> str | None:
    """The topic on which this driver publishes its frames, None if there is none.

    /diagnostics names a node without its namespace, so the shortest matching topic is taken.
    """
    name = device.report.name.strip("/")
    fitting = [
        row.name
        for row in topics
        if row.name.endswith(f"/{name}/frames") and _STRING in row.type_names and row.publishers
    ]
    return min(fitting, key=len, default=None) if name else None
