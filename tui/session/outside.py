"""The nodes of a session's domain that Deck has not started: who they are, and what they say.

A learner's `python my_node.py` is on the same graph as the lesson. It is shown and heard, and is
nobody's to start, stop or count. What tells it from Deck's own is its process: whatever Deck has
started, under whatever name, carries the mark of its run. Only where the middleware does not tell
of the process does the name decide.
"""

from __future__ import annotations

from collections import deque
from enum import Enum
from typing import TYPE_CHECKING

from graph.data import PROCESS_NUMBERS
from graph.housekeeping import is_housekeeping
from text.plain import plain
from tui.session.rosout import RosoutReader

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from graph.data import GraphUpdate, NodeRow, Sample
    from launcher.status import LogLine, NodeStatus

KEPT_UNKNOWN = 256
"""Lines of those who speak before the graph knows them, which they do for a moment."""
KEPT_HEARD = 4096
"""Lines by which one that comes again is known; a node keeps its last 1000 for who comes late."""


class _Owner(Enum):
    DECK = 1
    ANOTHER = 2
    GONE = 3
    """It has ended and is in the tables still, or it is on another machine."""


class Outside:
    """Those there are now."""

    def __init__(self) -> None:
        """Begin with nobody."""
        self.forget()

    def forget(self) -> None:
        """Start anew with another session."""
        self.now: tuple[str, ...] = ()
        """Their names without the first slash; with it where a node of Deck's is called so."""
        self._rows: tuple[NodeRow, ...] = ()
        self._owners: dict[int, _Owner] = {}
        self._speakers: dict[str, str] = {}
        """Logger to the name of who is outside, empty for others."""
        self._reader = RosoutReader()
        self._unknown: deque[Sample] = deque(maxlen=KEPT_UNKNOWN)
        self._heard: dict[tuple[str, ...], None] = {}

    def see(self, update: GraphUpdate, nodes: Mapping[str, NodeStatus], run_id: str) -> bool:
        """Look at the graph of the run with these nodes; tell whether there are others now."""
        if update.error or update.nodes is self._rows:
            return False
        before, self._rows = self.now, update.nodes
        # Where it tells of processes at all, that of a node may come a little after its name.
        rows = [row for row in update.nodes if row.processes] or update.nodes
        numbers = {number for row in rows for number in row.processes}
        # A mark that was seen holds; a number may have become another's.
        known = {n: owner for n, owner in self._owners.items() if owner is _Owner.DECK}
        self._owners = known | {n: _owner(n, run_id) for n in numbers - known.keys()}
        self._speakers = {row.name[1:].replace("/", "."): self._called(row, nodes) for row in rows}
        self.now = tuple(sorted(name for name in self._speakers.values() if name))
        return self.now != before

    def lines(
        self, samples: Iterable[Sample], nodes: Mapping[str, NodeStatus]
    ) -> tuple[LogLine, ...]:
        """Read what they say on /rosout; Deck's own nodes are heard by their output."""
        found: list[LogLine] = []
        waiting = (*self._unknown, *samples)
        self._unknown.clear()
        for sample in waiting:
            name = self._speaker(str(sample.value.get("name", "")), nodes)
            if name is None:
                self._unknown.append(sample)
            elif name and self._is_new(sample):
                found += self._reader.lines((sample,), name)
        return tuple(found)

    def _called(self, row: NodeRow, nodes: Mapping[str, NodeStatus]) -> str:
        """Return its name if it is outside, else nothing."""
        name = row.name[1:]
        owners = {self._owners[number] for number in row.processes}
        is_named = name in nodes
        is_ours = _Owner.DECK in owners or is_named
        if is_housekeeping(row.name) or (is_ours and _Owner.ANOTHER not in owners):
            return ""
        return plain(row.name if is_named else name, 200)

    def _speaker(self, logger: str, nodes: Mapping[str, NodeStatus]) -> str | None:
        """Return who is outside and has this logger, empty for others, None for nobody known."""
        while logger:
            if logger in self._speakers:
                name = self._speakers[logger]
                own = nodes.get(name.removeprefix("/")) if name.startswith("/") else None
                # Of two by one name nobody can tell who has spoken.
                return "" if own is not None and own.state.alive else name
            logger = logger.rpartition(".")[0]
        return None

    def _is_new(self, sample: Sample) -> bool:
        """Whether it was not heard before: a subscription opened anew hears all that is kept."""
        value = sample.value
        line = tuple(str(value.get(field)) for field in ("stamp", "name", "line", "msg"))
        if line in self._heard:
            return False
        self._heard[line] = None
        if len(self._heard) > KEPT_HEARD:
            self._heard.pop(next(iter(self._heard)))
        return True


def _owner(number: int, run_id: str) -> _Owner:
    """Return whose process of this machine has this number, as far as the middleware tells it."""
    from launcher.processes.table import RUN_MARK, process_numbers, read_marks

    found = [pid for pid in process_numbers() if pid % PROCESS_NUMBERS == number]
    if any((read_marks(pid) or {}).get(RUN_MARK) == run_id for pid in found):
        return _Owner.DECK
    return _Owner.ANOTHER if found else _Owner.GONE
