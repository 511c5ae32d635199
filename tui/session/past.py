"""What is kept of a session for the screens: the waiting update, messages, log lines, and what remains at its end.

While the app is busy updates are merged, so that at most one waits: a slow screen draws less often, but does not
fall behind. What a session leaves that has ended by itself is not updated any more, and must not look as if it were
current.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from graph.data import TopicRow, Trouble
from graph.observer.updates import merged
from text.robot import robot

if TYPE_CHECKING:
    from graph.data import GraphUpdate, Sample, Value
    from launcher.status import LogLine, NodeStatus


class GraphInbox:
    """Holds the one waiting update; `wake` is called when an update arrives in an empty inbox."""

    def __init__(self, wake: Callable[[], object]) -> None:
        """Pass a `wake` that may be called from any thread."""
        self._wake = wake
        self._lock = threading.Lock()
        self._waiting: GraphUpdate | None = None

    def put(self, update: GraphUpdate) -> None:
        """Add an update, on the observer's thread."""
        with self._lock:
            first = self._waiting is None
            self._waiting = update if self._waiting is None else merged(self._waiting, update)
        if first:
            self._wake()

    def take(self) -> GraphUpdate | None:
        """Return the waiting update, on the app's thread."""
        with self._lock:
            update, self._waiting = self._waiting, None
        return update


TRENDS = tuple(robot().frames)
"""The distances, of which a panel shows the course."""
KEPT = 240
"""Messages of a topic, as many as a trend shows."""
KEPT_BYTES = 2_000_000
"""Of a topic: sound is long."""


class Past:
    """The newest messages of some topics; of commands that are repeated the first two."""

    def __init__(self) -> None:
        self._kept: dict[str, deque[Sample]] = {}
        self._bytes: dict[str, int] = {}

    def clear(self) -> None:
        """Forget all, for another session."""
        self._kept.clear()
        self._bytes.clear()

    def take(self, update: GraphUpdate) -> None:
        for topic in (*robot().story, *TRENDS):
            for sample in update.samples.get(topic, ()):
                self._keep(topic, sample)

    def _keep(self, topic: str, sample: Sample) -> None:
        kept = self._kept.setdefault(topic, deque())
        if topic not in TRENDS and len(kept) > 1:
            said = _said(sample)
            if said == _said(kept[-1]) == _said(kept[-2]):
                return
        kept.append(sample)
        size = self._bytes.get(topic, 0) + sample.size_bytes
        while len(kept) > KEPT or (size > KEPT_BYTES and len(kept) > 1):
            size -= kept.popleft().size_bytes
        self._bytes[topic] = size

    def before(self, update: GraphUpdate, topics: set[str]) -> GraphUpdate:
        """Return the update with all that is kept of these topics in the place of what it has."""
        past = {topic: tuple(self._kept[topic]) for topic in topics & self._kept.keys()}
        return replace(update, samples={**update.samples, **past}) if past else update


def _said(sample: Sample) -> object:
    """Return a message without its time stamp, so that it can be compared."""
    return {name: _comparable(field) for name, field in sample.value.items() if name != "header"}


def _comparable(value: Value) -> object:
    """Return a field with lists in place of arrays; before the first frame there is no numpy."""
    if isinstance(value, Mapping):
        return {name: _comparable(field) for name, field in value.items()}
    if isinstance(value, list):
        return [_comparable(each) for each in value]
    to_list = getattr(value, "tolist", None)
    return value if to_list is None else to_list()


KEPT_LINES = 2000
"""As many as a log view shows: a screen has several, and is to take no more memory after hours."""
KEPT_CHARACTERS = 8_000_000


class LogHistory:
    """Lines in order of arrival, limited in number and in characters."""

    def __init__(self, lines: int = KEPT_LINES, characters: int = KEPT_CHARACTERS) -> None:
        self._lines: deque[LogLine] = deque()
        self._most_lines = lines
        self._most_characters = characters
        self._characters = 0

    def add(self, lines: Iterable[LogLine]) -> None:
        """Append lines, and drop the oldest ones beyond the limits."""
        for line in lines:
            self._lines.append(line)
            self._characters += len(line.text)
        while len(self._lines) > self._most_lines or self._characters > self._most_characters:
            self._characters -= len(self._lines.popleft().text)

    def __len__(self) -> int:
        return len(self._lines)

    def all(self) -> tuple[LogLine, ...]:
        """Return the stored lines, oldest first."""
        return tuple(self._lines)

    def clear(self) -> None:
        self._lines.clear()
        self._characters = 0


def ended_nodes(nodes: Mapping[str, NodeStatus], reason: str) -> dict[str, NodeStatus]:
    """Return the nodes, with those that were still running marked as ended for this `reason`."""
    return {name: _ended(node, reason) for name, node in nodes.items()}


def _ended(node: NodeStatus, reason: str) -> NodeStatus:
    from launcher.status import NodeState

    if node.state in {NodeState.EXITED, NodeState.FAILED}:
        return node
    return replace(
        node, state=NodeState.EXITED, detail=reason, pid=None, uptime_s=None, cpu_percent=None, memory_bytes=None
    )


def silent_graph(update: GraphUpdate) -> GraphUpdate:
    """Return the graph with no publishers and no subscribers."""
    topics = tuple(map(_silent, update.topics))
    return replace(update, samples={}, seen_goals=(), frames=(), topics=topics)


def _silent(row: TopicRow) -> TopicRow:
    # Without an age, since nothing would update it.
    return TopicRow(row.name, row.type_names, 0, 0, count=row.count, trouble=Trouble.NO_PUBLISHER)
