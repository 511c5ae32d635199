"""What the judge sees: the graph, the messages since the nodes last started, the log, the nodes."""

from __future__ import annotations

import asyncio
import math
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

from graph.data import PROCESS_NUMBERS, GraphUpdate, NodeRow, Sample, TopicRow
from graph.observer.observer import Observer
from graph.observer.requests import Request
from graph.ros import ONLY_LISTENING
from launcher.client.client import SupervisorClient
from launcher.events import ClosedEvent, LogEvent, StatusEvent
from launcher.processes.table import TICKS_PER_S, read_process
from launcher.profile.steps.expressions import Drawn
from launcher.status import LogLine, NodeStatus

T = TypeVar("T")
KEPT_BYTES = 32_000_000
"""Most bytes of messages that are kept of one topic."""
KEPT = 2000
KEPT_LINES = 2000
MARGIN_S = 0.02
"""How much later than it began a node may be known to have begun."""
TICK_S = 0.1
LONGER_S = 1.0
"""So much longer than the last one must a process live, after a crash, not to be about to crash."""


@dataclass(frozen=True)
class Observation:
    """What a look at the evidence has shown."""

    met: bool
    seen: str = ""
    """What there is instead, a sentence; empty if met."""
    final: bool = False
    """Whether waiting longer cannot change it."""
    look: str = ""
    """Where the learner should look, if something better than usual can be said."""


MET = Observation(met=True)


def missed(seen: str, look: str = "", *, final: bool = False) -> Observation:
    return Observation(met=False, seen=seen, final=final, look=look)


@dataclass(frozen=True)
class Crash:
    """The end of a process by a mistake."""

    pid: int
    heard_s: float
    """When that was heard first, unix time."""
    lived_s: float
    """How old the process was."""
    status: NodeStatus
    """What it was reported with."""


@dataclass
class Evidence:
    """Everything the judge knows at the moment; lives on the judge's event loop."""

    observer: Observer
    client: SupervisorClient
    folder: Path
    """That of the lesson."""
    values: Mapping[str, Drawn]
    functions: Mapping[str, Callable[[Any], object]] = field(default_factory=dict)
    """Those of the lesson that have been loaded, by the name that checks give them."""
    update: GraphUpdate = field(default_factory=lambda: GraphUpdate(0.0))
    restarts: int = 0
    """How often nodes were started by the learner: not by the judge, nor after a crash."""
    touched: set[str] = field(default_factory=set)
    """Nodes that the judge itself is restarting."""
    ended: str = ""
    """Why the session is over; empty while it runs."""
    _messages: dict[str, deque[Sample]] = field(default_factory=dict)
    """By topic; `received_s` is when each arrived at the middleware."""
    _bytes: dict[str, int] = field(default_factory=dict)
    _lines: dict[str, deque[LogLine]] = field(default_factory=dict)
    _born: dict[str, tuple[int, float]] = field(default_factory=dict)
    """Of each node its process, and when that began, unix time."""
    _crashed: dict[str, Crash] = field(default_factory=dict)
    """Of each node that has crashed, the last time it did."""
    _policy_restarts: dict[str, int] = field(default_factory=dict)
    _again: set[str] = field(default_factory=set)
    """Nodes whose process was started by their policy, after a crash."""
    _changed: asyncio.Event = field(default_factory=asyncio.Event)

    def __post_init__(self) -> None:
        self._note(self.client.nodes.values())
        self.restarts = 0

    @property
    def nodes(self) -> Mapping[str, NodeStatus]:
        return self.client.nodes

    def take(self, update: GraphUpdate) -> None:
        self.update = update
        for topic, samples in update.samples.items():
            kept = self._messages.setdefault(topic, deque())
            for sample in samples:
                kept.append(replace(sample, received_s=sample.received_s - sample.age_s, age_s=0.0))
                self._bytes[topic] = self._bytes.get(topic, 0) + sample.size_bytes
            while len(kept) > KEPT or (self._bytes[topic] > KEPT_BYTES and len(kept) > 2):
                self._bytes[topic] -= kept.popleft().size_bytes
        self._changed.set()

    async def listen(self) -> None:
        """Take the events of the supervisor until the session ends."""
        async for event in self.client.events(past=KEPT_LINES):
            if isinstance(event, LogEvent):
                for line in event.lines:
                    self._lines.setdefault(line.node, deque(maxlen=KEPT_LINES)).append(line)
            elif isinstance(event, StatusEvent):
                self._note(event.nodes)
            elif isinstance(event, ClosedEvent):
                self.ended = event.reason or "closed"
            self._changed.set()

    def _note(self, nodes: Iterable[NodeStatus]) -> None:
        """Take what the supervisor says of the nodes: which processes are new, by whom, and which crashed."""
        for node in nodes:
            before, began_s = self._born.get(node.name, (None, math.inf))
            if node.pid is not None and node.pid != before:
                self._born[node.name] = (node.pid, _began_s(node.pid, node.uptime_s or 0.0))
                again = node.restarts > self._policy_restarts.get(node.name, 0)
                self._policy_restarts[node.name] = node.restarts
                (self._again.add if again else self._again.discard)(node.name)
                if node.name in self.touched:
                    self.touched.discard(node.name)
                    # Its file may have been saved meanwhile: then one start serves both.
                    self.restarts += _written_s(node.file) > began_s
                else:
                    self.restarts += not again
            if node.crashed:
                now_s, crash = time.time(), self._crashed.get(node.name)
                pid, began_s = self._born.get(node.name, (0, now_s))
                if crash is None or crash.pid != pid:
                    crash = Crash(pid, now_s, now_s - began_s, node)
                self._crashed[node.name] = replace(crash, status=node)

    def trouble(self, name: str, since_s: float) -> NodeStatus | None:
        """Return how a node was when it crashed, or is if it ails; None if it did not since then.

        One that has crashed and was started again afterwards has crashed.
        """
        now = self.nodes[name]
        if now.ails or now.crashed:
            return now
        crash = self._crashed.get(name)
        return crash.status if crash is not None and crash.heard_s >= since_s else None

    def forget_earlier_crash(self, name: str) -> None:
        """Forget the crash of another process of a node than the one that runs.

        It may have been heard of in the moment in which this one began.
        """
        crash = self._crashed.get(name)
        if crash is not None and crash.pid != self._born[name][0]:
            del self._crashed[name]

    def may_crash_again(self, name: str) -> bool:
        """Whether a node that was started again after a crash has not lived longer than before."""
        crash = self._crashed.get(name)
        if crash is None or name not in self._again or self._born[name][0] == crash.pid:
            return False
        return self.lived_s(name) < crash.lived_s + LONGER_S

    def lived_s(self, node: str) -> float:
        """Return how long a node's process has run, or the one that crashed last."""
        pid, began_s = self._born.get(node, (0, time.time()))
        crash = self._crashed.get(node)
        return crash.lived_s if crash and crash.pid == pid else time.time() - began_s

    def began_s(self, node: str) -> float:
        """Return when the process of a node began, unix time; 0 if there has been none."""
        return self._born.get(node, (0, 0.0))[1]

    def fresh_s(self, topic: str, *, latched: bool = False) -> float:
        """Return the unix time since which messages on a topic count: not those of earlier runs.

        It is when the last of those nodes began that publish it, of all nodes if none does. Of a
        `latched` topic it is when the first began, since each publishes only once.
        """
        row = self.topic(topic)
        ends = row.published_by if row is not None else ()
        starts = {name: began_s for name, (_, began_s) in self._born.items()}
        publishing = [starts[name] for end in ends if (name := end.node.lstrip("/")) in starts]
        return (min if latched else max)(publishing or starts.values(), default=0.0)

    def messages(self, topic: str, since_s: float) -> list[Sample]:
        return [each for each in self._messages.get(topic, ()) if each.received_s >= since_s]

    def lines(self, node: str, since_s: float) -> list[LogLine]:
        """Return what a node has logged since then; since it was started, if that is 0."""
        since_s = since_s or self.began_s(node)
        lines = self._lines.get(node, ())
        return [line for line in lines if line.time_s >= since_s and line.source != "deck"]

    def topic(self, name: str) -> TopicRow | None:
        return next((row for row in self.update.topics if row.name == name), None)

    def node(self, name: str) -> NodeRow | None:
        return next((row for row in self.update.nodes if row.name == name), None)

    def has_found_everybody(self) -> bool:
        """Whether every process that runs is known: some endpoints of it, and the node of each.

        The name of a node comes apart from its endpoints. Either may be seconds late on a busy
        machine: the middleware repeats what was lost only every 3 s.
        """
        known = {number for node in self.update.nodes for number in node.processes}
        unnamed = {
            end.process
            for row in self.update.topics
            for end in (*row.published_by, *row.subscribed_by)
            if not end.is_named
        }
        running = {self.number(node.pid) for node in self.nodes.values() if node.state.alive and node.pid is not None}
        return running <= known - unnamed

    @staticmethod
    def number(pid: int) -> int:
        """Return the number by which the middleware knows a node's process: its own pid, of which there are so many.

        bwrap, which confines it, is the first process where it is, and the node the next.
        """
        process = read_process(pid)
        return 2 if process is not None and process.name == "bwrap" else pid % PROCESS_NUMBERS

    async def ask(self, request: Request[T]) -> T:
        return await asyncio.wrap_future(self.observer.ask(request))

    async def holds(self, condition: Callable[[], bool], within_s: float) -> bool:
        """Wait until something holds; return whether it does in time."""
        return (await self.until(lambda: MET if condition() else None, within_s)).met

    async def until(self, look: Callable[[], Observation | None], within_s: float) -> Observation:
        """Look again whenever something changes, until it is met, final, or time is up.

        `look` returns None for as long as nothing can be said; that is not met in the end.
        """
        deadline_s = time.monotonic() + within_s
        while True:
            observation = look()
            if observation is not None and (observation.met or observation.final):
                return observation
            left_s = deadline_s - time.monotonic()
            if left_s <= 0 or self.ended:
                return observation or Observation(met=False)
            await self.wait(min(left_s, TICK_S))

    async def let_pass(self, seconds: float) -> None:
        """Wait so long, or until the session ends."""
        until_s = time.monotonic() + seconds
        while (left_s := until_s - time.monotonic()) > 0 and not self.ended:
            await self.wait(left_s)

    async def wait(self, longest_s: float) -> None:
        self._changed.clear()
        try:
            await asyncio.wait_for(self._changed.wait(), longest_s)
        except asyncio.TimeoutError:
            return


def _written_s(file: str) -> float:
    """Return when a learner's file was written, unix time; long ago if there is none."""
    try:
        return Path(file).stat().st_mtime if file else -math.inf
    except OSError:
        return -math.inf


def _began_s(pid: int, uptime_s: float) -> float:
    """Return when a process began, unix time: by the kernel, for a status arrives late.

    Of a process that is no more, by the uptime it was reported with.
    """
    process = read_process(pid)
    if process is not None:
        now_s = time.clock_gettime(time.CLOCK_BOOTTIME)
        uptime_s = max(uptime_s, now_s - process.started_ticks / TICKS_PER_S)
    return time.time() - uptime_s - MARGIN_S


def same_name(one: str, other: str) -> bool:
    """Whether two names of nodes or topics mean the same, with or without the leading slash."""
    return one.lstrip("/") == other.lstrip("/")


def is_decks(node: str) -> bool:
    """Whether a node of the graph is an observer of Deck's, by which the learner publishes."""
    return node.startswith(ONLY_LISTENING)
