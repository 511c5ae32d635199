"""What a node's life needs of the session around it, and of the process started for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable, Sequence
    from signal import Signals

    from launcher.clock import Clock
    from launcher.processes.exit import Exit
    from launcher.processes.table import Process
    from launcher.status import NodeState, Severity
    from launcher.supervisor.plan import NodePlan
    from launcher.supervisor.readiness import ReadyCondition, Seen


class RunningProcess(Protocol):
    """A process that was started for a node, with all that descends from it."""

    pid: int
    ended: asyncio.Future[Exit]

    def left(self) -> Sequence[Process]:
        """Return those of them that live."""

    def signal(self, process: Process, number: Signals) -> None:
        """Send one of them a signal."""

    async def close(self) -> None:
        """Nothing of it is left: read what it has still written, and let go of it."""


class NodeContext(Protocol):
    """What a node's life needs of the session around it."""

    @property
    def clock(self) -> Clock:
        """What the waits between two tries are measured by."""

    async def launch(self, plan: NodePlan) -> RunningProcess:
        """Start the node's process; raises `SpawnError`."""

    async def ready(self, condition: ReadyCondition, tell: Callable[[Seen], None]) -> None:
        """Return when the condition holds, `tell` what else is there; raises `UnwatchableError`."""

    def missing(self, plan: NodePlan) -> str:
        """Say which needed nodes are not there yet; empty if all are."""

    def last_words(self, name: str) -> str:
        """Return what the node said last."""

    def say(self, name: str, severity: Severity, words: str) -> None:
        """Add a line about the node to its log."""

    def changed(self, name: str, state: NodeState) -> None:
        """The status of the node of this name has changed."""
