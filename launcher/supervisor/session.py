"""The session: all nodes of a profile, the operations on them, and their resource use.

What explains the mistakes of a learner's own node is large, and loaded once there is such a node.
"""

from __future__ import annotations

import asyncio
import os
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Annotated, Any

from launcher.control.requests import BadRequestError, request
from launcher.errors import StillRunningError, UnknownNodeError
from launcher.faults.telling import fault_in
from launcher.logs.session_log import SessionLog
from launcher.processes.members import UsageMeter
from launcher.processes.stop import Clock
from launcher.profile.node import Node
from launcher.status import LogLine, NodeFault, NodeState, Severity
from launcher.supervisor.node import SupervisedNode
from launcher.supervisor.own_files import OwnFiles
from launcher.supervisor.plan import Plan, stop_waves, with_needs
from launcher.supervisor.process import NodeProcess, ProcessLauncher
from launcher.supervisor.readiness import Clash, Readiness, clash_of
from launcher.supervisor.words import who
from text.sentences import say

USAGE_EVERY_S = 2.0
MAX_HISTORY_LINES = 20_000
MAX_HISTORY_CHARS = 8 << 20
"""Most characters of a history; of a longer one only the newest lines are sent."""
MODULE = re.compile(r"nodes\.[a-z][a-z0-9_]*")
"""A node of Deck."""


def _newest(lines: Sequence[LogLine], max_chars: int) -> Sequence[LogLine]:
    for position in range(len(lines) - 1, -1, -1):
        max_chars -= len(lines[position].text)
        if max_chars < 0:
            return lines[position + 1 :]
    return lines


def _natural(number: object) -> object:
    if isinstance(number, int) and number < 0:
        raise ValueError(f"{number} is negative")
    return number


class Session:
    """All nodes of a profile."""

    def __init__(
        self, plan: Plan, launcher: ProcessLauncher, log: SessionLog, on_change: Callable[[str], None]
    ) -> None:
        """`on_change` is called with the name of each node whose status has changed."""
        self.clock = Clock()
        self.plan = plan
        self.log = log
        log.heard, log.told = self.heard, self._take_told
        self._looked_at: dict[str, int] = {}
        """The process of each learner's own node whose source was looked at once it was ready."""
        self._faults: dict[str, NodeFault] = {}
        """Node to what its latest process has told of its end."""
        self.nodes = {node.name: SupervisedNode(node, self) for node in plan.nodes}
        self._launcher = launcher
        self._on_change = on_change
        self.own_files = OwnFiles(self._learners_files, self._saved)
        self.ends = False
        """Whether nothing is started any more."""
        self._meter = UsageMeter()
        self.readiness = Readiness(
            (each for node in plan.nodes for each in node.conditions),
            launcher.spawner,
            launcher.reaper,
            plan.env,
            self._tell_clashes,
        )
        self._pids: dict[str, int] = {}
        """Node to its latest process."""
        self._to_return: set[str] = set()
        """Nodes that are being stopped for a restart."""
        self._restarting: asyncio.Task[None] | None = None
        self._hurry = asyncio.Event()

    # Requests of clients. They raise `UnknownNodeError`.

    @request
    def start(self, nodes: tuple[str, ...] = ()) -> None:
        """Start these nodes and everything they need; all nodes if none is named."""
        chosen = self._chosen(nodes)
        if self.ends:
            return
        # The probe goes first: nodes that appear while it watches are found sooner.
        if any(node.plan.conditions or node.plan.file for node in self.nodes.values()):
            self.readiness.expect()
        for name in with_needs(chosen, self.plan.needs):
            if name in chosen or not self.nodes[name].at_work:
                self.nodes[name].start()

    @request
    async def stop(self, nodes: tuple[str, ...] = (), now: bool = False) -> None:
        """Stop these nodes, dependants first; all nodes if none is named.

        Raises:
            StillRunningError: if some of their processes have not ended by SIGKILL.
        """
        chosen = self._chosen(nodes)
        self._to_return.difference_update(chosen)
        await self._stop(chosen, now=now)
        left = [process for name in chosen for process in self.nodes[name].outlived]
        if left:
            raise StillRunningError(say("still running after SIGKILL: {who}", who=who(left)))

    async def _stop(self, chosen: list[str], *, now: bool = False) -> None:
        if now:
            self._hurry.set()
            await asyncio.gather(*(self.nodes[name].stop(now=True) for name in chosen))
            return
        self._hurry.clear()
        for wave in stop_waves(chosen, self.plan.needs):
            in_a_hurry = self._hurry.is_set()
            await asyncio.gather(*(self.nodes[name].stop(now=in_a_hurry) for name in wave))

    @request
    def restart(self, nodes: tuple[str, ...] = ()) -> None:
        """Begin to restart these nodes, dependants first; all nodes if none is named."""
        chosen = self._chosen(nodes)
        if self.ends:
            return
        if len(chosen) == 1:
            self.nodes[chosen[0]].restart()
            return
        self._to_return.update(chosen)
        if self._restarting is None or self._restarting.done():
            self._restarting = asyncio.create_task(self._restart())

    @request
    def history(self, node: str | None, limit: Annotated[int, _natural]) -> Sequence[LogLine]:
        """Return the newest lines of one node or of all."""
        if node is not None and node not in self.log.rings:
            raise UnknownNodeError(node, self.nodes)
        return _newest(self.log.newest(node, min(limit, MAX_HISTORY_LINES)), MAX_HISTORY_CHARS)

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
            self.start(tuple(returning))

    def _chosen(self, names: tuple[str, ...]) -> list[str]:
        for name in names:
            if name not in self.nodes:
                raise UnknownNodeError(name, self.nodes)
        return list(names or self.nodes)

    async def measure(self) -> None:
        """Measure the resource use of the nodes periodically."""
        while True:
            await asyncio.sleep(USAGE_EVERY_S)
            if not any(node.state.alive for node in self.nodes.values()):
                continue
            members = self._launcher.members.look(0.0)
            usages = self._meter.measure(members, self.clock.now())
            for name, node in self.nodes.items():
                if node.state.alive:
                    node.usage = usages.get(name, (None, None))
                    suspended = (process.pid for process in members.get(name, ()) if process.suspended)
                    node.halted(next(suspended, 0))
                    self._on_change(name)

    # What its nodes use: a `NodeSession`, which says what these do.

    async def launch(self, plan: Node) -> NodeProcess:
        if plan.name in self._pids:
            # It may have died without notice, and a probe that saw it alive still sees it.
            self.readiness.renew()
        if plan.file:
            self.own_files.note(plan.name, plan.file)
            # Also where it has no condition: are its topics of the types that others use?
            self.readiness.expect()
        self._faults.pop(plan.name, None)
        process = await self._launcher.launch(plan)
        self._pids[plan.name] = process.pid
        return process

    def missing(self, plan: Node) -> str:
        absent = [self.nodes[name] for name in plan.needs if not self.nodes[name].serves]
        if not absent:
            return ""
        return say("waiting for {nodes}", nodes=", ".join(map(_with_state, absent)))

    def crash(self, plan: Node) -> NodeFault | None:
        told = self._faults.get(plan.name)
        if told is not None:
            return told
        from launcher.faults.crash import crash_of, refused_arguments

        lines = [line.text for line in self.log.since_start(plan.name)]
        return crash_of(lines, plan.file.rpartition("/")[0]) or refused_arguments(lines, plan.file)

    def _take_told(self, name: str, told: dict[str, Any]) -> None:
        """Take what the program of a learner's own node tells of itself."""
        node = self.nodes.get(name)
        if node is None or not node.plan.file:
            return
        from launcher.faults.crash import stuck_in

        fault = fault_in(told)
        if fault is not None and fault.kind in ("crash", "syntax"):
            self._faults[name] = fault
        elif fault is not None and fault.kind == "warning":
            node.say(Severity.WARN, fault.words)
            node.warn(fault)
        elif fault is not None:
            node.ail(fault)
        stuck = stuck_in(told)
        if stuck is not None:
            node.go_on() if stuck[1] else node.ail(stuck[0])

    @request
    def exchange(self, node: str, run: str | None = None) -> None:
        """Run this file or module in the place of a node's program, or again that itself (None)."""
        from launcher.faults.source import look_at

        if run is not None and not (os.path.isabs(run) or MODULE.fullmatch(run)):  # noqa: PTH117
            raise BadRequestError(say("run: expected an absolute path or a module, found {x!r}", x=run))
        self._chosen((node,))
        if self.ends:
            return
        (plan,) = (plan for plan in self.plan.nodes if plan.name == node)
        if run is not None:
            # With the same name, parameters, remaps and needs.
            plan = replace(plan, run=run, exec=None, warm=plan.is_forked)
        self.nodes[node].exchange(plan, look_at(plan.file) if plan.file else None)
        self.own_files.look_again()

    def heard(self, line: LogLine) -> None:
        """Look for a mistake in a line that a learner's own node has written."""
        if line.severity.rank >= Severity.WARN.rank and line.node in self.nodes:
            node = self.nodes[line.node]
            if node.plan.file and node.fault is None:
                from launcher.faults.crash import warning_in

                node.warn(warning_in(line.text, node.plan.file))

    def _tell_turns(self, name: str, pid: int) -> None:
        """Tell a learner's own program once of a node whose turn to be spun does not come."""
        node = self.nodes[name]
        if not node.plan.file or self._looked_at.get(name) == pid:
            return
        from launcher.faults.source import spun_in_turn

        self._looked_at[name] = pid
        fault = spun_in_turn(node.plan.file)
        if fault is not None:
            node.say(Severity.WARN, fault.words)
            node.warn(fault)

    def _tell_clashes(self, clashes: Sequence[Clash]) -> None:
        """Tell the learner's own nodes of their topics that others use with another type."""
        for name, node in self.nodes.items():
            if node.plan.file:
                node.clashes(clash_of(f"/{name}", node.plan.file, clashes))

    def ended_early(self, plan: Node) -> NodeFault | None:
        from launcher.faults.source import unspun

        return unspun(plan.file)

    def _saved(self, name: str, fault: NodeFault | None) -> None:
        if not self.ends:
            self.nodes[name].saved(fault)

    def _learners_files(self) -> dict[str, str]:
        """Return the file of each node that is the learner's own."""
        return {name: node.plan.file for name, node in self.nodes.items() if node.plan.file}

    def changed(self, name: str, state: NodeState) -> None:
        if state is NodeState.READY:
            self._tell_turns(name, self._pids[name])
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
