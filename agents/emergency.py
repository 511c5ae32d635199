"""The emergency stop as agents see it: in force as soon as anybody says so."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from launcher.errors import LauncherError
from launcher.status import Severity
from safety.gate_report import STOPPED, gate_in
from safety.stop_file import NOT_PASSED, PASSED_EVERY_S, TOPIC, StopFile
from safety.stop_record import Stop
from safety.topics import EMERGENCY_STATE, EMERGENCY_STOP, SAFETY_STATE
from text.plain import plain
from text.sentences import say

if TYPE_CHECKING:
    from graph.data import GraphUpdate
    from launcher.client.client import SupervisorClient

MOST_NODES = 64


class EmergencyWatch:
    """Follows the topic, the reports of the nodes that obey it, and the gate."""

    def __init__(self) -> None:
        self._asked = False
        self._nodes: dict[str, bool] = {}
        self._gate = False

    @property
    def engaged(self) -> bool:
        """Whether a node holds; where none reports, whether a stop was asked for."""
        held = any(self._nodes.values()) if self._nodes else self._asked
        return held or self._gate

    @property
    def holding(self) -> list[str]:
        return sorted(plain(name, 200) for name, holds in self._nodes.items() if holds)

    @property
    def is_obeyed(self) -> bool:
        """Whether every node that reports says that it holds, and one does."""
        return bool(self._nodes) and all(self._nodes.values())

    def see(self, update: GraphUpdate) -> bool:
        """Take in an update; return whether it holds a stop, even one that was released since."""
        stopped = self.engaged
        for sample in update.samples.get(EMERGENCY_STOP, ()):
            self._asked = bool(sample.value.get("data"))
            stopped = stopped or self._asked
        for sample in update.samples.get(EMERGENCY_STATE, ()):
            self._read(sample.value)
        for sample in update.samples.get(SAFETY_STATE, ()):
            gate = gate_in(sample.value)
            self._gate = gate is not None and gate.verdict == STOPPED
        there = {node.name for node in update.nodes}
        if there:
            self._nodes = {name: holds for name, holds in self._nodes.items() if name in there}
        return stopped or self.engaged

    def _read(self, value: Mapping[str, Any]) -> None:
        statuses = value.get("status", ())
        for status in statuses if isinstance(statuses, (list, tuple)) else ():
            name, pairs = str(status.get("name", "")), status.get("values", ())
            said = {str(pair.get("key")): str(pair.get("value")) for pair in pairs}
            known = name in self._nodes or len(self._nodes) < MOST_NODES
            if known and said.get("engaged") in ("true", "false"):
                self._nodes[name] = said["engaged"] == "true"


class StopPassing:
    """Passes on by the disk each stop that is heard here: nobody else may have heard it.

    Whoever has, knows it by the same name: where it is released already, that changes nothing.
    """

    def __init__(self, link: SupervisorClient) -> None:
        self._link = link
        self._file = StopFile(link.session.domain, "/agents")
        self._waiting: Stop | None = None
        """The newest that was heard and not yet passed on."""
        self._passing: asyncio.Future[None] | None = None

    def see(self, update: GraphUpdate) -> None:
        # Where no node listens it would be kept in vain.
        if any(row.name == EMERGENCY_STOP and not row.subscribers for row in update.topics):
            return
        for sample in update.samples.get(EMERGENCY_STOP, ()):
            if sample.value.get("data"):
                said_ns, number = sample.name
                self._waiting = Stop(said_ns or time.time_ns(), number)
        if self._waiting and (self._passing is None or self._passing.done()):
            self._passing = asyncio.ensure_future(self._pass_on(self._waiting))
            self._waiting = None

    async def _pass_on(self, stop: Stop) -> None:
        problem = await asyncio.to_thread(self._file.give, stop, TOPIC)
        if problem:
            with contextlib.suppress(LauncherError):
                await self._link.tell(Severity.ERROR, say(NOT_PASSED, problem=problem))
        await asyncio.sleep(PASSED_EVERY_S)
