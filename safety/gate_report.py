"""What the safety gate reports about itself on /safety_state, read for screens and agents."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

NODE = "safety_stop"
STOPPED = "emergency_stop"
HELD = frozenset({"blocked_forward", "blocked_backward", "blocked", STOPPED, "starting"})
PLACES = ("front", "rear")


@dataclass(frozen=True)
class Gate:
    """The gate's report, as received."""

    verdict: str = ""
    """`free`, or why it holds the robot: `blocked_forward`, `emergency_stop`..."""
    states: Mapping[str, str] = field(default_factory=dict)
    """`front` and `rear` to `free`, `close`, `invalid` or `silent`; only for existing sensors."""
    metres: Mapping[str, float] = field(default_factory=dict)
    """`front` and `rear` to the newest distance, if there is one."""
    too_rare: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """`front` and `rear` to who speaks too rarely there; one of them if there are more."""
    source: str = ""
    """The topic that it obeys now, empty if there is none."""
    ignored: str = ""
    """A topic that it ignores because its priority is lower."""
    share: float = 1.0
    """The share of the requested speed that it allows, 0 to 1."""
    message: str = ""
    refused: str = ""
    """What was recently requested and refused: `0.8 m/s, limit 0.5 m/s`."""
    critical_m: float | None = None
    """The distance below which it stops; None if it does not say."""
    slow_m: float | None = None
    """The distance below which it slows down; it never does if that is at most `critical_m`."""

    @property
    def is_held(self) -> bool:
        """Whether it keeps the robot from driving in one direction or the other."""
        return self.verdict in HELD

    @property
    def is_slowed(self) -> bool:
        """Whether it allows only a part of the speed."""
        return 0.0 < self.share < 1.0


def gate_in(value: Mapping[str, Any]) -> Gate | None:
    """Read a diagnostic_msgs/DiagnosticArray; None if it is not from the gate."""
    statuses: Any = value.get("status", ())
    for status in statuses if isinstance(statuses, (list, tuple)) else ():
        if isinstance(status, Mapping) and status.get("name") == NODE:
            return _read(status)
    return None


def _read(status: Mapping[str, Any]) -> Gate:
    values: dict[str, str] = {}
    for pair in status.get("values", ()):
        if isinstance(pair, Mapping):
            values[str(pair.get("key", ""))] = str(pair.get("value", ""))
    metres = {place: _number(values.get(f"{place}_m", "")) for place in PLACES}
    share = _number(values.get("allowed", ""))
    return Gate(
        values.get("verdict", ""),
        {place: values[place] for place in PLACES if place in values},
        {place: number for place, number in metres.items() if number is not None},
        {place: tuple(values.get(f"{place}_too_rare", "").split()) for place in PLACES},
        values.get("source", ""),
        values.get("ignored", ""),
        1.0 if share is None else share,
        str(status.get("message", "")),
        values.get("refused", ""),
        _number(values.get("critical_m", "")),
        _number(values.get("slow_m", "")),
    )


def _number(text: str) -> float | None:
    try:
        number = float(text)
    except ValueError:
        return None
    return None if math.isnan(number) else number
