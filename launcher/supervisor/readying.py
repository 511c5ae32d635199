"""How a node that runs becomes ready: what is waited for, what is said meanwhile, what fails.

The interfaces that a node uses are here as well: the session it belongs to, the process started for it.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from signal import Signals
from typing import Protocol

from launcher.clock import Clock
from launcher.processes.exit import Exit
from launcher.processes.table import Process
from launcher.profile.node import Node, Ready
from launcher.status import NodeFault, NodeState, Severity
from launcher.supervisor.readiness import NotBroughtUpError, Seen, UnwatchableError
from launcher.supervisor.words import instead, late, not_brought_up, what
from text.sentences import say


class RunningProcess(Protocol):
    """A process that was started for a node, with all its descendants."""

    pid: int
    ended: asyncio.Future[Exit]

    def left(self) -> Sequence[Process]:
        """Return those of them that are alive."""

    def signal(self, process: Process, number: Signals) -> None:
        """Send one of them a signal."""

    def look_for_end(self) -> None:
        """Look anew for the end of the process itself, of which nobody has told."""

    async def close(self) -> None:
        """Read its last output and release it; none of its processes is left."""


class NodeContext(Protocol):
    """The part of the session that a node uses."""

    @property
    def clock(self) -> Clock:
        """The clock for the waits between two attempts."""

    async def launch(self, plan: Node) -> RunningProcess:
        """Start the node's process; raises `SpawnError`."""

    async def ready(self, condition: Ready, tell: Callable[[Seen], None]) -> None:
        """Return once the condition holds; `tell` gets other states.

        Raises `UnwatchableError`, and `NotBroughtUpError` for a lifecycle.
        """

    def missing(self, plan: Node) -> str:
        """Say which needed nodes are not ready yet; empty if all are."""

    def last_words(self, name: str) -> str:
        """Return the last words of the node."""

    def crash(self, plan: Node) -> NodeFault | None:
        """Return what the last output of a learner's own node tells of its end."""

    def ended_early(self, plan: Node) -> NodeFault | None:
        """Return why a learner's own node has ended without an error; None if it was to."""

    def say(self, name: str, severity: Severity, words: str) -> None:
        """Add a line about the node to its log."""

    def changed(self, name: str, state: NodeState) -> None:
        """Note that the status of this node has changed."""


LATE_S = 60.0
"""How long after its time limit a node may still become ready."""


class HasState(Protocol):
    """The node whose state this is about."""

    @property
    def state(self) -> NodeState:
        """Its state now."""

    def become(self, state: NodeState, detail: str = "", *, serves: bool = False) -> None:
        """Give it another state; `serves`: the nodes that need it may start."""


class Readying:
    """One process of a node on its way to be ready."""

    def __init__(self, plan: Node, around: NodeContext, node: HasState) -> None:
        """`around`: the session that the node belongs to."""
        self._plan = plan
        self._around = around
        self._node = node

    async def run(self) -> str:
        """Wait for every condition in turn; return why it will never be ready, empty if it may."""
        if not self._plan.conditions:
            self._node.become(NodeState.RUNNING, serves=True)
            return ""
        try:
            for condition in self._plan.conditions:
                if not await self._holds(condition):
                    return ""
            self._node.become(NodeState.READY, serves=True)
        except UnwatchableError:
            words = say("whether it is ready cannot be determined")
            self._node.become(NodeState.RUNNING, words, serves=True)
        except NotBroughtUpError as error:
            last = self._around.last_words(self._plan.name)
            return not_brought_up(error.transition, error.state, last)
        return ""

    async def _holds(self, condition: Ready) -> bool:
        """Wait for a condition; return False if it does not come to hold in the longest time."""
        plan, node, clock = self._plan, self._node, self._around.clock
        node.become(NodeState.STARTING, say("waiting for {what}", what=what(condition)))
        seen: Seen | None = None

        def tell(found: Seen) -> None:
            nonlocal seen
            seen = found
            if node.state is NodeState.STARTING:
                node.become(NodeState.STARTING, instead(condition, found))
            elif node.state is NodeState.RUNNING:
                node.become(NodeState.RUNNING, late(condition, found, plan.within_s))

        ready = asyncio.ensure_future(self._around.ready(condition, tell))
        came = asyncio.Event()
        ready.add_done_callback(lambda _ready: came.set())
        try:
            if not await clock.wait(came, plan.within_s):
                words = late(condition, seen, plan.within_s)
                node.become(NodeState.RUNNING, words)
                self._around.say(plan.name, Severity.WARN, words)
                if not await clock.wait(came, LATE_S):
                    return False
            ready.result()
        finally:
            ready.cancel()
        return True


def why_unready(ready: asyncio.Task[str]) -> str:
    """Return what `Readying.run` says once it has ended, otherwise nothing."""
    return ready.result() if ready.done() and not ready.cancelled() else ""
