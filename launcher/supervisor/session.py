"""The session: all nodes of a profile, the operations on them, and their resource use."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from launcher.clock import MonotonicClock
from launcher.errors import UnknownNodeError
from launcher.logs.session_log import DECK
from launcher.processes.usage import UsageMeter
from launcher.status import NodeState, Severity
from launcher.supervisor.dependencies import stop_waves, with_needs
from launcher.supervisor.node import SupervisedNode
from launcher.supervisor.readiness import Readiness
from launcher.supervisor.shared_memory import SharedMemory
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from launcher.clock import Clock
    from launcher.logs.session_log import SessionLog
    from launcher.supervisor.plan import NodePlan, Plan
    from launcher.supervisor.process import NodeProcess, ProcessLauncher
    from launcher.supervisor.readiness import ReadyCondition, Seen

USAGE_EVERY_S = 2.0


class Session:
    """All nodes of a profile; implements `NodeContext` for each of them."""

    def __init__(
        self,
        plan: Plan,
        launcher: ProcessLauncher,
        log: SessionLog,
        on_change: Callable[[str], None],
    ) -> None:
        """`on_change` is called with the name of each node whose status has changed."""
        self.clock: Clock = MonotonicClock()
        self.plan = plan
        self.log = log
        self.nodes = {node.name: SupervisedNode(node, self) for node in plan.nodes}
        self._launcher = launcher
        self._on_change = on_change
        self._meter = UsageMeter()
        self._readiness = Readiness(
            [node.ready for node in plan.nodes if node.ready is not None],
            launcher.spawner,
            launcher.reaper,
            plan.env,
        )
        self.processes: dict[str, tuple[int, int]] = {}
        """Node to the number and the start, in ticks, of its latest process."""
        self._to_return: set[str] = set()
        """Nodes that are being stopped for a restart."""
        self._restarting: asyncio.Task[None] | None = None
        self._hurry = asyncio.Event()
        self._shared_memory = SharedMemory(lambda *words: log.say(DECK, *words))

    # Requests.

    def start(self, names: Iterable[str] = ()) -> None:
        """Start these nodes and everything they need; all nodes if none is named."""
        chosen = self._chosen(names)
        self._shared_memory.clear()
        # The probe goes first: nodes that appear while it watches are found sooner.
        self._readiness.expect()
        for name in with_needs(chosen, self.plan.needs):
            if name in chosen or not self.nodes[name].at_work:
                self.nodes[name].start()

    async def stop(self, names: Iterable[str] = (), *, now: bool = False) -> None:
        """Stop these nodes, dependants first; all nodes if none is named."""
        chosen = self._chosen(names)
        self._to_return.difference_update(chosen)
        await self._stop(chosen, now=now)

    async def _stop(self, chosen: list[str], *, now: bool = False) -> None:
        if now:
            self._hurry.set()
            await asyncio.gather(*(self.nodes[name].stop(now=True) for name in chosen))
            return
        self._hurry.clear()
        for wave in stop_waves(chosen, self.plan.needs):
            in_a_hurry = self._hurry.is_set()
            await asyncio.gather(*(self.nodes[name].stop(now=in_a_hurry) for name in wave))

    def restart(self, names: Iterable[str] = ()) -> None:
        """Begin to restart these nodes, dependants first; all nodes if none is named."""
        chosen = self._chosen(names)
        if len(chosen) == 1:
            self.nodes[chosen[0]].restart()
            return
        self._to_return.update(chosen)
        if self._restarting is None or self._restarting.done():
            self._restarting = asyncio.create_task(self._restart())

    async def _restart(self) -> None:
        stopped: set[str] = set()
        while self._to_return - stopped:
            wave = self._to_return - stopped
            await self._stop(sorted(wave))
            stopped |= wave
        # Without those that have been stopped in the meantime.
        returning = [name for name in self.nodes if name in self._to_return]
        self._to_return.clear()
        if returning:
            self.start(returning)

    def _chosen(self, names: Iterable[str]) -> list[str]:
        names = list(names)
        for name in names:
            if name not in self.nodes:
                raise UnknownNodeError(name, self.nodes)
        return names or list(self.nodes)

    async def measure(self) -> None:
        """Measure the resource use of the nodes periodically."""
        while True:
            await asyncio.sleep(USAGE_EVERY_S)
            self._shared_memory.clear()
            if not any(node.state.alive for node in self.nodes.values()):
                continue
            members = self._launcher.scan.look(0.0)
            for name, processes in members.items():
                self._launcher.note_segments(name, (process.pid for process in processes))
            usages = self._meter.measure(members, self.clock.now())
            for name, node in self.nodes.items():
                if node.state.alive:
                    node.usage = usages.get(name)
                    self._on_change(name)

    # The `NodeContext` of the nodes.

    async def launch(self, plan: NodePlan) -> NodeProcess:
        """Start a node's process; raises `SpawnError`."""
        if plan.name in self.processes:
            # It may have died without notice, and a probe that saw it alive still sees it.
            self._readiness.renew()
        process = await self._launcher.launch(plan)
        self.processes[plan.name] = (process.pid, process.started_ticks)
        return process

    async def ready(self, condition: ReadyCondition, tell: Callable[[Seen], None]) -> None:
        """Return once the condition holds; `tell` gets other states; raises `UnwatchableError`."""
        await self._readiness.until(condition, tell)

    def missing(self, plan: NodePlan) -> str:
        """Say which needed nodes are not ready yet; empty if all are."""
        absent = [self.nodes[name] for name in plan.needs if not self.nodes[name].serves]
        if not absent:
            return ""
        return say("waiting for {nodes}", nodes=", ".join(map(_with_state, absent)))

    def last_words(self, name: str) -> str:
        """Return the last words of the node."""
        return self.log.last_words(name)

    def say(self, name: str, severity: Severity, words: str) -> None:
        """Add a line about the node to its log."""
        self.log.say(name, severity, words)

    def changed(self, name: str, state: NodeState) -> None:
        """Notify the clients, and the nodes that need this one."""
        if state is NodeState.READY:
            # It may be killed before the next measurement.
            pid, _started = self.processes[name]
            self._launcher.note_segments(name, (pid,))
        self._on_change(name)
        for other in self.nodes.values():
            if name in other.plan.needs:
                other.needs_changed()


def _with_state(node: SupervisedNode) -> str:
    if node.state in (NodeState.STARTING, NodeState.WAITING):
        return node.plan.name
    if node.state is NodeState.RUNNING:
        return say("{name} (not ready)", name=node.plan.name)
    return f"{node.plan.name} ({node.state.value})"
