"""Messages on /rosout as log lines: the only log of nodes that others have started."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from text.plain import plain

if TYPE_CHECKING:
    from collections.abc import Iterable

    from graph.data import Sample
    from launcher.status import LogLine, Severity

TOPIC = "/rosout"
LONGEST = 4000
"""Characters kept of a line."""


class RosoutReader:
    """Numbers the lines of each node, as a supervisor does."""

    def __init__(self) -> None:
        self._numbers: dict[str, int] = {}

    def lines(self, samples: Iterable[Sample], node: str = "") -> tuple[LogLine, ...]:
        """Read messages of rcl_interfaces/msg/Log; malformed ones are ignored.

        `node` has sent them; if empty, the node that the logger is named after.
        """
        return tuple(self._line(one, node) for one in samples if "msg" in one.value)

    def _line(self, sample: Sample, node: str) -> LogLine:
        from launcher.status import LogLine

        value: Any = sample.value
        logger = plain(str(value.get("name", "")), 200) or "?"
        node = node or logger
        number = self._numbers[node] = self._numbers.get(node, 0) + 1
        text = plain(str(value["msg"]), LONGEST)
        time_s = stamp_s(value.get("stamp")) or sample.received_s
        severity = _severity(value.get("level"))
        return LogLine(node, number, time_s, severity, text, logger=logger, source="rosout")


def _severity(level: object) -> Severity:
    """Rcutils' levels are 10 for DEBUG to 50 for FATAL; a node may have others in between."""
    from launcher.status import Severity

    rank = int(level) // 10 - 1 if isinstance(level, int) else 1
    return tuple(Severity)[max(0, min(len(Severity) - 1, rank))]


def stamp_s(stamp: Any) -> float:  # noqa: ANN401
    """Unix time, 0 if there is none."""
    try:
        seconds = float(stamp["sec"]) + float(stamp["nanosec"]) * 1e-9
    except (TypeError, ValueError, KeyError):
        return 0.0
    return seconds if math.isfinite(seconds) and seconds > 0 else 0.0
