"""The interfaces that a node uses: the session it belongs to, and the process started for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable, Sequence
    from signal import Signals

    from launcher.clock import Clock
    from launcher.processes.exit import Exit
    from launcher.processes.table import Process
    from launcher.profile.node import Node, Ready
    from launcher.status import NodeFault, NodeState, Severity
    from launcher.supervisor.readiness import Seen


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
