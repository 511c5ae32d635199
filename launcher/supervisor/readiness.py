"""Waiting until a node can be used, that is, its name, topic or service is in the ROS graph: what is said meanwhile.

The graph is watched by a probe process (`launcher.spawn_server.probe`) that exists only while a
node is waited for, and each wait for a lifecycle has a process of its own.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple, Protocol

from launcher.logs.session_log import SessionLog
from launcher.processes.exit import Reaper
from launcher.processes.stop import Clock
from launcher.profile.node import Node, Ready
from launcher.spawn_server import SpawnRequest
from launcher.spawn_server.spawner import Spawner, SpawnError
from launcher.status import NodeFault, NodeState, Severity
from launcher.supervisor.process import NodeProcess, helping
from launcher.supervisor.words import Seen, instead, late, not_brought_up, what
from text.nested import read_json
from text.sentences import say

LATE_S = 60.0
"""How long after its time limit a node may still become ready."""
MAX_PROBES = 3
"""After this many processes have died in a row, the graph counts as unwatchable."""
LINGER_S = 5.0
"""The probe stays this long when nothing is waited for: the next node may come soon."""


class Clash(NamedTuple):
    """A topic that is used with several types, so that messages do not arrive."""

    topic: str
    users: tuple[tuple[str, str], ...]
    """Full name of a node, and the type that it uses."""


class UnwatchableError(Exception):
    """The graph cannot be watched: rclpy is not installed, or does not start."""


class NotBroughtUpError(Exception):
    """The node will not get into the wanted state."""

    def __init__(self, transition: str, state: str) -> None:
        """Store the transition that failed, empty if none was possible, and the state it is in."""
        super().__init__(transition, state)
        self.transition = transition
        self.state = state


class Readiness:
    """Reports when conditions are met."""

    def __init__(
        self,
        conditions: Iterable[Ready],
        spawner: Spawner,
        reaper: Reaper,
        env: Mapping[str, str | None],
        on_clashes: Callable[[Sequence[Clash]], None],
    ) -> None:
        """`conditions`: all that will be waited for; `env`: the variables to watch the right domain.

        `on_clashes` is called with the topics of several types as often as the probe reports.
        """
        self._conditions = list(dict.fromkeys(each for each in conditions if not each.lifecycle))
        self._spawner = spawner
        self._reaper = reaper
        self._env = env
        self._on_clashes = on_clashes
        self._waiters: dict[asyncio.Future[None], tuple[Ready, Callable[[Seen], None]]] = {}
        self._holding: frozenset[Ready] = frozenset()
        self._seen: dict[Ready, Seen] = {}
        self._task: asyncio.Task[None] | None = None
        self._linger: asyncio.TimerHandle | None = None

    def expect(self) -> None:
        """Start watching: a wait will begin in a moment, and the probe takes time to start."""
        if self._task is None:
            self._task = asyncio.create_task(self._watch())
            self._stop_later()

    async def until(self, condition: Ready, tell: Callable[[Seen], None]) -> None:
        """Return once `condition` holds; until then `tell` gets every new state of the topic.

        Raises:
            NotBroughtUpError: if a transition to the state of a lifecycle has failed.
            UnwatchableError: if the graph cannot be watched.
        """
        if condition.lifecycle:
            await self._comes_to_live(condition, tell)
            return
        if condition in self._holding:
            return
        future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiters[future] = condition, tell
        if condition in self._seen:
            tell(self._seen[condition])
        self.expect()
        try:
            await future
        finally:
            self._waiters.pop(future, None)
            self._stop_later()

    async def _comes_to_live(self, condition: Ready, tell: Callable[[Seen], None]) -> None:
        """Wait for the state of a lifecycle by a process of its own, which ends with the wait."""
        wanted = json.dumps([condition.node, condition.lifecycle, condition.goes])
        request = SpawnRequest("lifecycle", "deck_lifecycle", "deck: lifecycle", (wanted,), "/", self._env)
        for _attempt in range(MAX_PROBES):
            with contextlib.suppress(SpawnError, ValueError):
                async with helping(self._spawner, self._reaper, request) as reports:
                    async for line in reports:
                        told = read_json(line)
                        if told["state"] == condition.lifecycle:
                            return
                        if "failed" in told:
                            raise NotBroughtUpError(told["failed"], told["state"])
                        tell(Seen((told["state"],)))
        raise UnwatchableError

    def renew(self) -> None:
        """Start a new probe: one that has seen a node alive keeps seeing it after its death."""
        self._stop()
        if self._waiters:
            self.expect()

    def _stop_later(self) -> None:
        if self._linger is not None:
            self._linger.cancel()
        self._linger = asyncio.get_running_loop().call_later(LINGER_S, self._stop_if_idle)

    def _stop_if_idle(self) -> None:
        if not self._waiters:
            self._stop()

    def _stop(self) -> None:
        self._holding = frozenset()
        self._seen = {}
        if self._task is not None:
            self._task.cancel()
            self._task = None

    async def _watch(self) -> None:
        for _attempt in range(MAX_PROBES):
            with contextlib.suppress(SpawnError, ValueError):
                await self._one_probe()
        self._holding = frozenset()
        for future in self._waiters:
            if not future.done():
                future.set_exception(UnwatchableError)
        self._task = None

    async def _one_probe(self) -> None:
        """Start a probe and listen to it until it ends."""
        wanted = json.dumps([_asked(condition) for condition in self._conditions])
        request = SpawnRequest("probe", "deck_probe", "deck: probe", (wanted,), "/", self._env)
        async with helping(self._spawner, self._reaper, request) as reports:
            async for line in reports:
                told = read_json(line)
                seen = {self._conditions[at]: Seen(tuple(types), rate_hz) for at, types, rate_hz in told["seen"]}
                self._learn(frozenset(self._conditions[at] for at in told["met"]), seen)
                if told["clashes"] is not None:
                    self._on_clashes([Clash(topic, tuple(map(tuple, users))) for topic, users in told["clashes"]])

    def _learn(self, holding: frozenset[Ready], seen: dict[Ready, Seen]) -> None:
        before, self._holding, self._seen = self._seen, holding, seen
        for future, (condition, tell) in self._waiters.items():
            if future.done():
                continue
            if condition in holding:
                future.set_result(None)
            elif condition in seen and seen[condition] != before.get(condition):
                tell(seen[condition])


def _asked(condition: Ready) -> tuple[str, str | None, str, float]:
    """Return a condition as the probe takes it: kind, name, type and rate."""
    kind = "topic" if condition.topic else "service" if condition.service else "node"
    return kind, getattr(condition, kind), condition.type or "", condition.rate or 0.0


def clash_of(node: str, file: str, clashes: Sequence[Clash]) -> NodeFault | None:
    """Return the first topic that this node (full name) uses with another type than others do.

    It neither hears the others nor is heard.
    """
    for topic, users in clashes:
        own = [kind for user, kind in users if user == node]
        others = [(user, kind) for user, kind in users if user != node and kind not in own]
        if own and others:
            user, kind = others[0]
            return NodeFault(
                "warning",
                file,
                exception=say(
                    "{topic} is {own} here, and {other} in {node}", topic=topic, own=own[0], other=kind, node=user
                ),
                meaning=say("A topic has one type: messages of another do not arrive."),
            )
    return None


class NodeSession(Protocol):
    """What a node uses of its session."""

    clock: Clock
    log: SessionLog
    readiness: Readiness

    async def launch(self, plan: Node) -> NodeProcess:
        """Start the process of a node; raises `SpawnError`."""

    def missing(self, plan: Node) -> str:
        """Say which needed nodes are not ready yet; empty if all are."""

    def crash(self, plan: Node) -> NodeFault | None:
        """Return what the last output of a learner's own node tells of its end."""

    def ended_early(self, plan: Node) -> NodeFault | None:
        """Return why a learner's own node has ended without an error; None if it was to."""

    def changed(self, name: str, state: NodeState) -> None:
        """Notify the clients, and the nodes that need this one."""


class StartedNode(Protocol):
    """The node that is to be ready."""

    plan: Node
    state: NodeState

    def become(self, state: NodeState, detail: str = "", *, serves: bool = False) -> None:
        """Give it another state; `serves`: the nodes that need it may start."""

    def say(self, severity: Severity, words: str) -> None:
        """Add a line about it to its log."""


async def bring_up(node: StartedNode, session: NodeSession) -> str:
    """Wait for all that a node has to be; return why it will never be ready, empty if it may."""
    plan = node.plan
    if not plan.conditions:
        node.become(NodeState.RUNNING, serves=True)
        return ""
    try:
        for condition in plan.conditions:
            if not await _comes_true(condition, node, session):
                return ""
        node.become(NodeState.READY, serves=True)
    except UnwatchableError:
        node.become(NodeState.RUNNING, say("whether it is ready cannot be determined"), serves=True)
    except NotBroughtUpError as error:
        return not_brought_up(error.transition, error.state, session.log.last_words(plan.name))
    return ""


async def _comes_true(condition: Ready, node: StartedNode, session: NodeSession) -> bool:
    """Wait for a condition; return False if it does not come to hold in the longest time."""
    within_s, clock = node.plan.within_s, session.clock
    node.become(NodeState.STARTING, say("waiting for {what}", what=what(condition)))
    seen: Seen | None = None

    def tell(found: Seen) -> None:
        nonlocal seen
        seen = found
        if node.state is NodeState.STARTING:
            node.become(NodeState.STARTING, instead(condition, found))
        elif node.state is NodeState.RUNNING:
            node.become(NodeState.RUNNING, late(condition, found, within_s))

    ready = asyncio.ensure_future(session.readiness.until(condition, tell))
    came = asyncio.Event()
    ready.add_done_callback(lambda _ready: came.set())
    try:
        if not await clock.wait(came, within_s):
            words = late(condition, seen, within_s)
            node.become(NodeState.RUNNING, words)
            node.say(Severity.WARN, words)
            if not await clock.wait(came, LATE_S):
                return False
        ready.result()
    finally:
        ready.cancel()
    return True
