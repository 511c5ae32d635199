"""/diagnostics read into plain data: one `Device` for each driver that reports its state.

Several drivers publish on one topic, so every message is needed, not only the newest.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from graph.diagnostics.reading import StatusLevel, statuses

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from graph.data import Sample, TopicRow

STALE_S = 3.0
"""A driver that has been silent for this long is stale: each reports once a second."""
MOST = 200
"""Maximum number of drivers kept."""
_STRING = "std_msgs/msg/String"
_ISO = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d")


@dataclass(frozen=True)
class Device:
    """The last report of a driver: what a `DiagnosticStatus` has, and what it tells of a port."""

    name: str
    level: StatusLevel
    message: str
    hardware: str
    values: Mapping[str, str]
    heard_s: float
    """Unix time."""

    @property
    def port(self) -> str:
        """The port that it is connected to."""
        return self.values.get("port") or self.hardware

    @property
    def connected(self) -> bool | None:
        """Whether its port is open, None if it does not say."""
        said = self.values.get("connected", "").lower()
        return said == "true" if said in {"true", "false"} else None

    @property
    def since(self) -> str:
        """Local date and time of the connection; empty without one."""
        since = self.values.get("connected_since", "")
        return since[:19].replace("T", " ") if _ISO.match(since) else ""

    def number(self, key: str) -> float | None:
        """The value as a number, None if it is not one."""
        try:
            return float(self.values[key])
        except (KeyError, ValueError):
            return None

    def age_s(self, now_s: float) -> float:
        """Seconds since its last report."""
        return max(0.0, now_s - self.heard_s)


class DeviceBook:
    """Keeps the newest report of every driver."""

    def __init__(self) -> None:
        self._devices: dict[str, Device] = {}

    @property
    def devices(self) -> Sequence[Device]:
        """All drivers, sorted by name."""
        return sorted(self._devices.values(), key=lambda device: device.name)

    def get(self, name: str) -> Device | None:
        """The driver of this name."""
        return self._devices.get(name)

    def clear(self) -> None:
        """Forget all drivers."""
        self._devices.clear()

    def excuse(self, now_s: float) -> None:
        """Do not count the time before `now_s` as silence: nobody was listening."""
        for name, device in self._devices.items():
            self._devices[name] = replace(device, heard_s=max(device.heard_s, now_s))

    def take(self, samples: Iterable[Sample]) -> None:
        """Read messages of diagnostic_msgs/DiagnosticArray; malformed ones are ignored."""
        for sample in samples:
            for status in statuses(sample):
                if status.name in self._devices or len(self._devices) < MOST:
                    self._devices[status.name] = Device(**vars(status))


def frames_topic(device: Device, topics: Iterable[TopicRow]) -> str | None:
    """The topic on which this driver publishes its frames, None if there is none.

    /diagnostics names a node without its namespace, so the shortest matching topic is taken.
    """
    name = device.name.strip("/")
    fitting = [
        row.name
        for row in topics
        if row.name.endswith(f"/{name}/frames") and _STRING in row.type_names and row.publishers
    ]
    return min(fitting, key=len, default=None) if name else None
