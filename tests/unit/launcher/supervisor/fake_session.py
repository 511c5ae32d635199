"""What surrounds a node, as a test would have it: a clock that it moves, processes that obey it."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast

from launcher.processes.exit import Exit
from launcher.processes.table import Process
from launcher.profile.node import Node, Ready
from launcher.spawn_server.spawner import SpawnError
from launcher.status import NodeFault, NodeState, Severity
from launcher.supervisor.node import SupervisedNode
from launcher.supervisor.readiness import NotBroughtUpError, UnwatchableError
from launcher.supervisor.words import Seen
from tests.unit.manual_clock import ManualClock, settle

PLAN = Node(name="sonar", exec=("sonar",), restart="on-failure")


def planned(**changes: Any) -> Node:
    return replace(PLAN, **changes)


class FakeProcess:
    """A process, perhaps with a grandchild, and the signals that each of them ends by."""

    def __init__(self, pid: int, ends_by: set[int], grandchild_ends_by: set[int] | None) -> None:
        self.immortal = False
        self.told = True
        self.looked = 0
        self.pid = pid
        self.ended: asyncio.Future[Exit] = asyncio.get_running_loop().create_future()
        self.heard: list[tuple[int, int]] = []
        self.closed = False
        self._living = {pid: ends_by}
        if grandchild_ends_by is not None:
            self._living[pid + 1] = grandchild_ends_by

    def left(self) -> list[Process]:
        return [Process(pid, "fake", "S", 1, self.pid, self.pid, pid, 0) for pid in self._living]

    def hear(self, pid: int, number: signal.Signals) -> None:
        self.heard.append((pid, number))
        kills = number == signal.SIGKILL and not self.immortal
        if number in self._living[pid] or kills:
            self.end(pid, Exit(None, number.name))

    def end(self, pid: int, how: Exit) -> None:
        del self._living[pid]
        if pid == self.pid and self.told:
            self.ended.set_result(how)

    def look_for_end(self) -> None:
        self.looked += 1

    async def close(self) -> None:
        assert not self._living, "let go of while something of it was alive"
        self.closed = True


class FakeSession:
    """Does what a node asks of its session, of the log of that, and of what tells that nodes are ready."""

    def __init__(self) -> None:
        self.log = self.readiness = self
        self.clock = ManualClock()
        self.started: list[FakeProcess] = []
        self.ends_by: set[int] = {signal.SIGINT}
        self.grandchild_ends_by: set[int] | None = None
        self.refuses = ""
        self.is_ready = asyncio.Event()
        self.watchable = True
        self.never: NotBroughtUpError | None = None
        self.awaited: list[Ready] = []
        self.absent = ""
        self.states: list[NodeState] = []
        self.lines: list[str] = []
        self.gravest = Severity.DEBUG
        self.said_last = "no such port"
        self.fault: NodeFault | None = None
        self.early: NodeFault | None = None

    def send(self, process: Process, number: signal.Signals, _wakes: signal.Signals) -> None:
        self.process.hear(process.pid, number)

    @property
    def process(self) -> FakeProcess:
        return self.started[-1]

    async def launch(self, _plan: Node) -> FakeProcess:
        if self.refuses:
            raise SpawnError(self.refuses)
        number = 100 + 10 * len(self.started)
        self.started.append(FakeProcess(number, self.ends_by, self.grandchild_ends_by))
        return self.process

    async def until(self, condition: Ready, tell: Callable[[Seen], None]) -> None:
        self.tell = tell
        self.awaited.append(condition)
        if not self.watchable:
            raise UnwatchableError
        await self.is_ready.wait()
        if self.never is not None:
            raise self.never

    def missing(self, _plan: Node) -> str:
        return self.absent

    def last_words(self, _name: str) -> str:
        return self.said_last

    def crash(self, _plan: Node) -> NodeFault | None:
        return self.fault

    def ended_early(self, _plan: Node) -> NodeFault | None:
        return self.early

    def say(self, _name: str, severity: Severity, words: str) -> None:
        self.lines.append(words)
        self.gravest = max(self.gravest, severity, key=lambda each: each.rank)

    def changed(self, _name: str, state: NodeState) -> None:
        self.states.append(state)


async def crash(session: FakeSession) -> None:
    session.process.end(session.process.pid, Exit(1))
    await settle()


async def started(session: FakeSession, plan: Node = PLAN) -> SupervisedNode:
    node = SupervisedNode(plan, cast("Any", session))
    node.start()
    await settle()
    return node
