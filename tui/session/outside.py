"""The nodes in a session's domain that Deck did not start: their names, and their log lines, read from /rosout.

A learner's `python my_node.py` is on the same graph as the lesson. Its state and its log are shown, but it cannot be
started or stopped here and is not counted. It is recognised by its process: everything that Deck has started, under
whatever name, carries the mark of its run. The name decides only if the middleware does not report the process.
"""

from __future__ import annotations

import math
from collections import deque
from enum import Enum
from typing import TYPE_CHECKING, Any

from graph.data import PROCESS_NUMBERS
from graph.housekeeping import is_housekeeping
from text.plain import plain
from tui import clock

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from graph.data import GraphUpdate, NodeRow, Sample
    from launcher.status import LogLine, NodeStatus, Severity


ROSOUT = "/rosout"
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


KEPT_UNKNOWN = 256
"""Lines from nodes that the graph does not know yet, which is so only for a moment."""
HELD_S = 1.0
"""The output of a node of Deck's arrives by so much later than what it says on /rosout."""
KEPT_HEARD = 4096
"""Lines kept to recognise repetitions; a node keeps its last 1000 for late subscribers."""


class _Owner(Enum):
    DECK = 1
    ANOTHER = 2
    GONE = 3
    """It has ended but is still listed, or it is on another machine."""


class Outside:
    """The current nodes of others."""

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        """Reset for another session."""
        self.now: tuple[str, ...] = ()
        """Their names without the first slash; with it if one of Deck's nodes has the same name."""
        self._rows: tuple[NodeRow, ...] = ()
        self._owners: dict[int, _Owner] = {}
        self._speakers: dict[str, str] = {}
        """Maps a logger to the name of its outside node, empty for other nodes."""
        self._reader = RosoutReader()
        self._unknown: deque[Sample] = deque(maxlen=KEPT_UNKNOWN)
        self._heard: dict[tuple[str, ...], None] = {}
        self._printed: dict[tuple[str, int], None] = {}
        """Node and time, in microseconds, of what Deck's own nodes have logged by their output."""

    def see(self, update: GraphUpdate, nodes: Mapping[str, NodeStatus], run_id: str) -> bool:
        """Examine the graph of a run with these nodes; return whether the outside nodes changed."""
        if update.error or update.nodes is self._rows:
            return False
        before, self._rows = self.now, update.nodes
        # Where processes are reported, that of a node may arrive slightly later than its name.
        rows = [row for row in update.nodes if row.processes] or update.nodes
        numbers = {number for row in rows for number in row.processes}
        # A mark that was found stays valid; a process number may be reused.
        known = {n: owner for n, owner in self._owners.items() if owner is _Owner.DECK}
        self._owners = known | {n: _owner(n, run_id) for n in numbers - known.keys()}
        self._speakers = {row.name[1:].replace("/", "."): self._called(row, nodes) for row in rows}
        self.now = tuple(sorted(name for name in self._speakers.values() if name))
        return self.now != before

    def note(self, lines: Iterable[LogLine]) -> None:
        """Remember what Deck's own nodes say: all of them say it on /rosout, too."""
        for line in lines:
            if line.logger:
                self._printed[line.node, round(line.time_s * 1e6)] = None
        while len(self._printed) > KEPT_HEARD:
            self._printed.pop(next(iter(self._printed)))

    def lines(self, samples: Iterable[Sample], nodes: Mapping[str, NodeStatus]) -> tuple[LogLine, ...]:
        """Read their messages on /rosout; the output of Deck's own nodes is read elsewhere."""
        found: list[LogLine] = []
        waiting = (*self._unknown, *samples)
        self._unknown.clear()
        for sample in waiting:
            name = self._speaker(str(sample.value.get("name", "")))
            own = nodes.get(name[1:]) if name and name.startswith("/") else None
            if name is None:
                self._unknown.append(sample)
            elif own is not None and own.state.alive and self._is_printed(sample, own.name):
                continue
            elif own is not None and own.state.alive and _is_fresh(sample):
                self._unknown.append(sample)
            elif name and self._is_new(sample):
                found += self._reader.lines((sample,), name)
        return tuple(found)

    def _called(self, row: NodeRow, nodes: Mapping[str, NodeStatus]) -> str:
        """Return its name if it is outside, otherwise an empty text."""
        name = row.name[1:]
        owners = {self._owners[number] for number in row.processes}
        is_named = name in nodes
        is_ours = _Owner.DECK in owners or is_named
        if is_housekeeping(row.name) or (is_ours and _Owner.ANOTHER not in owners):
            return ""
        return plain(row.name if is_named else name, 200)

    def _is_printed(self, sample: Sample, node: str) -> bool:
        """Whether Deck's node of this name has logged it, not the other one."""
        time_us = round(stamp_s(sample.value.get("stamp")) * 1e6)
        # Both are read from decimals, and may be rounded differently.
        return any((node, time_us + off) in self._printed for off in (0, -1, 1))

    def _speaker(self, logger: str) -> str | None:
        """Return the outside node with this logger, empty for other nodes, None if unknown."""
        while logger:
            if logger in self._speakers:
                return self._speakers[logger]
            logger = logger.rpartition(".")[0]
        return None

    def _is_new(self, sample: Sample) -> bool:
        """Whether it was not received before: a new subscription receives old messages again."""
        value = sample.value
        line = tuple(str(value.get(field)) for field in ("stamp", "name", "line", "msg"))
        if line in self._heard:
            return False
        self._heard[line] = None
        if len(self._heard) > KEPT_HEARD:
            self._heard.pop(next(iter(self._heard)))
        return True


def _is_fresh(sample: Sample) -> bool:
    """Whether it came so lately that a node's output may not have come yet."""
    return clock.now() - sample.received_s < HELD_S


def _owner(number: int, run_id: str) -> _Owner:
    """Return who started the process with this number, as far as the middleware reports it."""
    from launcher.processes.table import RUN_MARK, process_numbers, read_marks

    found = [pid for pid in process_numbers() if pid % PROCESS_NUMBERS == number]
    if any((read_marks(pid) or {}).get(RUN_MARK) == run_id for pid in found):
        return _Owner.DECK
    return _Owner.ANOTHER if found else _Owner.GONE
