"""The emergency stop as agents see it: in force as soon as anybody says so."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from robot.safety.gate_report import STOPPED, gate_in
from robot.topics import EMERGENCY_STATE, EMERGENCY_STOP, SAFETY_STATE
from text.plain import plain

if TYPE_CHECKING:
    from graph.data import GraphUpdate

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
        """The nodes that report that they hold."""
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
