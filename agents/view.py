"""The newest of what the observer has told, on the loop of the server."""

from __future__ import annotations

import asyncio
import math
import time
from collections import Counter
from contextlib import contextmanager
from typing import TYPE_CHECKING

from graph.data import Interest
from robot.topics import BATTERY, HEAD_STATE, LLM_RESULT, MOCK_POSE, ODOMETRY, SONAR_FRONT, SONAR_REAR
from safety.topics import EMERGENCY_STATE, EMERGENCY_STOP, SAFETY_STATE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from graph.data import GraphUpdate, NodeRow, Sample, ServiceRow, TopicRow
    from graph.observer.observer import Observer

WATCHED = frozenset({BATTERY, HEAD_STATE, MOCK_POSE, ODOMETRY, SAFETY_STATE, SONAR_FRONT, SONAR_REAR})
SETTLED_S = 1.0
JOINED_WITHIN_S = 8.0
LOOK_S = 0.1
FOLLOWED = frozenset({EMERGENCY_STOP, EMERGENCY_STATE, LLM_RESULT, SAFETY_STATE})


class GraphView:
    """Topics, nodes, services and newest samples; `take` is called with each update."""

    def __init__(self, observer: Observer) -> None:
        self._observer = observer
        self._update: GraphUpdate | None = None
        self._newest: dict[str, Sample] = {}
        self._watched: Counter[str] = Counter(WATCHED)
        self._followed: Counter[str] = Counter(FOLLOWED)
        self._listeners: list[Callable[[Sample], None]] = []
        self._news = asyncio.Event()
        self._changed_s = math.inf
        """When the ends of topics were last seen to change, on the monotonic clock."""
        self._ends = -1
        self._is_settled = False
        self._ask()

    @property
    def error(self) -> str:
        """Why nothing can be seen; empty if it can."""
        return "" if self._update is None else self._update.error

    @property
    def topics(self) -> tuple[TopicRow, ...]:
        return () if self._update is None else self._update.topics

    @property
    def nodes(self) -> tuple[NodeRow, ...]:
        return () if self._update is None else self._update.nodes

    @property
    def services(self) -> tuple[ServiceRow, ...]:
        return () if self._update is None else self._update.services

    def topic(self, name: str) -> TopicRow | None:
        """Return a topic, None if nobody uses it."""
        return next((row for row in self.topics if row.name == name), None)

    def newest(self, topic: str, within_s: float) -> Sample | None:
        """Return the newest message of a watched topic that is not older than this."""
        sample = self._newest.get(topic)
        if sample is None or time.time() - sample.received_s > within_s:
            return None
        return sample

    def take(self, update: GraphUpdate) -> None:
        if update.error and self._update is not None:
            self._news.set()
            return
        self._update = update
        ends = sum(len(row.published_by) + len(row.subscribed_by) for row in update.topics)
        if ends != self._ends:
            self._ends, self._changed_s = ends, time.monotonic()
        for topic, samples in update.samples.items():
            self._newest[topic] = samples[-1]
            for listener in tuple(self._listeners):
                for sample in samples:
                    listener(sample)
        self._news.set()

    @contextmanager
    def looking_at(self, topic: str) -> Iterator[None]:
        """Watch this topic meanwhile; what was known of it before does not count."""
        if topic not in WATCHED:
            self._newest.pop(topic, None)
        self._watched[topic] += 1
        self._ask()
        try:
            yield
        finally:
            self._watched[topic] -= 1
            self._ask()

    @contextmanager
    def hearing(self, topic: str, heard: Callable[[Sample], None]) -> Iterator[None]:
        """Call `heard` with every message of this topic meanwhile."""

        def listen(sample: Sample) -> None:
            if sample.topic == topic:
                heard(sample)

        self._followed[topic] += 1
        self._listeners.append(listen)
        self._ask()
        try:
            yield
        finally:
            self._listeners.remove(listen)
            self._followed[topic] -= 1
            self._ask()

    async def settled(self, expected: Iterable[str]) -> None:
        """Wait, right after the start, until these nodes are found, and what they have on topics.

        Discovery says nothing of its end: it is over when nothing has come for a while.
        """
        names = frozenset(expected)
        deadline_s = time.monotonic() + JOINED_WITHIN_S
        while not self._is_settled and time.monotonic() < deadline_s:
            found = names <= {node.name for node in self.nodes}
            self._is_settled = found and time.monotonic() - self._changed_s > SETTLED_S
            await self.until(lambda: False, LOOK_S)
        self._is_settled = True

    async def until(self, condition: Callable[[], bool], within_s: float) -> bool:
        """Wait until the condition holds after an update; return whether it does in time."""
        deadline_s = time.monotonic() + within_s
        while not condition():
            left_s = deadline_s - time.monotonic()
            if left_s <= 0:
                return False
            self._news.clear()
            try:
                await asyncio.wait_for(self._news.wait(), left_s)
            except asyncio.TimeoutError:
                return condition()
        return True

    def _ask(self) -> None:
        watched = frozenset(topic for topic, count in self._watched.items() if count > 0)
        followed = frozenset(topic for topic, count in self._followed.items() if count > 0)
        self._observer.want(Interest(watched, followed))
