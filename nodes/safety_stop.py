"""The reflex: watches the distance and, as a gate, blocks dangerous commands.

An obstacle nearer than `critical_distance`, an invalid reading (nan), and no reading for
`stale_after_s` seconds, or none at all, count as danger. While several publish the same distance,
the lowest of the last `stale_after_s` counts, and they are named. With `gate: true` the node stands
between the sources of commands and /drive_safe: forward is blocked while the front is in danger,
backward while the rear is (if a `rear_topic` is given; without one, backing off is always allowed).
Between `slow_distance` and `critical_distance` the speed is reduced in proportion. A command that
was cut short is forgotten: when the path is clear again the robot waits for a new one.

`sources` are the topics with commands, highest rank first: a source is active while its newest
command is younger than `max_age_s`, and lower sources are ignored meanwhile. Without an active
source the robot stands. The current allowed command is repeated `rate` times a second, so that
receivers of /drive_safe notice a dead gate. A gate that has just started stays shut for `settle_s`,
and as long again after the first message of a source in its first seconds: it may not know yet of
an emergency stop that is in effect.

/emergency_stop stops everything until it is released by an explicit false. /safety_state reports
at every change, and once a second, what is blocked and why.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from std_msgs.msg import Float32

from nodes.parts.commands import LOWEST, SolePublisher
from nodes.parts.emergency import EmergencyStopListener
from nodes.parts.node import DEPTH, LessonNode, Number, SensorListener, Switch, Text, change_period
from nodes.parts.runner import run
from nodes.safety.gate import CommandGate
from nodes.safety.state import DistanceSensor, DistanceSensors, GateSnapshot, SensorResult, shares
from nodes.safety.words import EMERGENCY, RELEASED, STARTED, diagnosis, tell_front
from robot.safety.distance import RangeState, SafetyZone, Verdict, allowed, where
from robot.topics import COMMAND_SOURCES, SONAR_FRONT
from safety.topics import SAFETY_STATE

_STATE_EVERY_S = _PUBLISHERS_EVERY_S = 1.0


class SafetyStop(LessonNode):
    """Warns of obstacles, and blocks motion if it is the gate."""

    NAME = "safety_node"
    front_topic = Text(SONAR_FRONT, "Distance ahead", fixed=True)
    rear_topic = Text("", "Distance behind; empty: no sensor", fixed=True, may_be_empty=True)
    critical_distance = Number(0.5, "Nearer than this is danger", low=0.01, high=100.0, unit="m")
    slow_distance = Number(
        1.0, "Slows down between this and critical_distance; never if it is not larger", high=100.0, unit="m"
    )
    stale_after_s = Number(2.5, "A longer silence of a sonar is danger", low=0.05, high=60.0, unit="s")
    gate = Switch(False, "Whether to relay commands to /drive_safe", fixed=True)
    sources = Text(" ".join(COMMAND_SOURCES), "Topics of the command sources, highest priority first", fixed=True)
    max_age_s = Number(0.5, "An older command becomes a stop; 0: never", high=60.0, unit="s")
    settle_s = Number(1.0, "How long the gate stays shut after its start", high=10.0, unit="s")
    rate = Number(10.0, "Checks, and repetitions of /drive_safe, a second", low=1.0, high=100.0, unit="Hz")

    def __init__(self) -> None:
        super().__init__()
        self._sensors = DistanceSensors(rear=bool(self.rear_topic))
        self._results: tuple[SensorResult, ...] = self._sensors.results(self._zone)
        self._range_states: tuple[RangeState, ...] = ()
        self._verdict = Verdict.BLOCKED_FORWARD
        self._told: tuple[Verdict, GateSnapshot] | None = None
        self._told_s = 0.0
        self._state = self.create_publisher(DiagnosticArray, SAFETY_STATE, DEPTH)
        # In this order, which is that of their callbacks: a waiting stop comes first.
        self._emergency = EmergencyStopListener(self, self._emergency_changed)
        self._listen(self.front_topic, self._see_front, self._sensors.front)
        if self._sensors.rear is not None:
            self._listen(self.rear_topic, self._see_rear, self._sensors.rear)
        self._gate = CommandGate(self, self._judge, self._reason) if self.gate else None
        self._timer = self.every(1.0 / self.rate, self._tick)
        self.say.info(STARTED, metres=self.critical_distance)

    def parameters_changed(self) -> None:
        """Apply the new rate, and judge again by the new distances; publish them at once."""
        change_period(self._timer, 1.0 / self.rate)
        self._judge()
        self._publish_state()

    def before_end(self) -> None:
        if self._gate is not None:
            self._gate.stop()

    # ---------------------------------------------------------------- what comes in

    def _listen(self, topic: str, see: Callable[[Float32, dict[str, Any]], None], sensor: DistanceSensor) -> None:
        hear: Any = see
        self.every(_PUBLISHERS_EVERY_S, lambda: sensor.are(self._senders_of(topic)))
        SensorListener(self, Float32, topic, hear)
        SolePublisher(self, self.resolve_topic_name(topic), others=LOWEST)

    def _senders_of(self, topic: str) -> dict[bytes, str]:
        return {
            bytes(one.endpoint_gid): f"{one.node_namespace.rstrip('/')}/{one.node_name}"
            for one in self.get_publishers_info_by_topic(topic)
        }

    def _see_front(self, message: Float32, info: dict[str, Any]) -> None:
        if self._held_up():
            return
        self._take_in(self._sensors.front, "front_topic", message, info)
        self._judge()
        tell_front(self.say, self._results[0], stopped=self._emergency.active)

    def _see_rear(self, message: Float32, info: dict[str, Any]) -> None:
        if self._sensors.rear is not None and not self._held_up():
            self._take_in(self._sensors.rear, "rear_topic", message, info)
            self._judge()

    def _take_in(self, sensor: DistanceSensor, topic: str, message: Float32, info: dict[str, Any]) -> None:
        sensor.see(
            message.data,
            number=info.get("publication_sequence_number") or 0,
            publishers=self.count_publishers(self.values[topic]),
        )

    def _emergency_changed(self, active: bool) -> None:
        if active:
            self.say.error(EMERGENCY)
        else:
            self.say.warn(RELEASED)
        self._judge()

    def _tick(self) -> None:
        self._held_up()
        self._judge()
        if self._results[0].state == RangeState.SILENT and self._results[0].reading.age_s > self._zone.stale_after_s:
            tell_front(self.say, self._results[0], stopped=self._emergency.active)
        if self._gate is not None:
            self._gate.tick()
        overdue = time.monotonic() - self._told_s > _STATE_EVERY_S
        if overdue or self._news() != self._told:
            self._publish_state()

    # ---------------------------------------------------------------- what follows from it

    @property
    def _zone(self) -> SafetyZone:
        slow_m = self.slow_distance if self.gate else 0.0
        return SafetyZone(self.critical_distance, slow_m, self.stale_after_s)

    def _held_up(self) -> bool:
        return self._gate is not None and self._gate.held_up()

    def _judge(self) -> None:
        """Judge the sensors again, and have the gate apply the result."""
        self._results = self._sensors.results(self._zone)
        states = tuple(result.state for result in self._results)
        rear = states[1] if len(states) > 1 else None
        starting = self._gate is not None and self._gate.starting
        verdict = where(states[0], rear, self._emergency.active, starting=starting)
        changed = (states, verdict) != (self._range_states, self._verdict)
        self._range_states, self._verdict = states, verdict
        if self._gate is not None:
            self._gate.rule(verdict, shares(self._results))
        if changed:
            self._publish_state()

    def _news(self) -> tuple[Verdict, GateSnapshot]:
        """Return what is published at once if it changes; ages change all the time."""
        snapshot = self._snapshot()
        return self._verdict, snapshot._replace(allowed=round(snapshot.allowed, 2), age_s=None)

    def _snapshot(self) -> GateSnapshot:
        if self._gate is not None:
            return self._gate.snapshot()
        return GateSnapshot(allowed=allowed(0.0, self._verdict, shares(self._results)))

    def _reason(self) -> str:
        return str(self._status().message)

    def _status(self) -> DiagnosticStatus:
        return diagnosis(self.say, self._verdict, self._results, self._snapshot(), self._zone)

    def _publish_state(self) -> None:
        self._told_s, self._told = time.monotonic(), self._news()
        message = DiagnosticArray(status=[self._status()])
        message.header.stamp = self.get_clock().now().to_msg()
        self._state.publish(message)


if __name__ == "__main__":
    raise SystemExit(run(SafetyStop))
