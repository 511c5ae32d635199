"""The state of the emergency stop as this screen knows it: plain data and its transitions.

It is latched: only a release clears it. Where nodes report what they obey, those reports count, and
the topic counts only until one of them has received the message. Where none reports, as with a
learner's own nodes, the topic counts, whether the message is ours or somebody else's; if its
publisher has gone, only the report of the gate counts, and can also clear the stop.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from safety.gate_report import STOPPED, Gate, gate_in
from safety.topics import EMERGENCY_STATE, EMERGENCY_STOP, SAFETY_STATE
from text.i18n import N_
from text.plain import plain
from tui.emergency.gate import held_words, refused_words
from tui.emergency.nodes import NodeStop, present, reported_stops

if TYPE_CHECKING:
    from graph.data import GraphUpdate, Sample

TOPIC_TYPE = "std_msgs/msg/Bool"
FOLLOWED = frozenset({EMERGENCY_STOP, EMERGENCY_STATE, SAFETY_STATE})
SETTLED_S = 2.0
"""For this long after a message on the topic, the gate may still report the state before it."""

NO_LISTENER = N_("nobody listens to /emergency_stop: all nodes are being stopped")
NOT_OURS = N_("it may have reached nobody, and Deck has started no node that it could stop")
NO_GRAPH = N_("ROS cannot be reached: all nodes are being stopped")


@dataclass(frozen=True)
class Emergency:
    """What is known about the emergency stop."""

    asked: bool = False
    """Whether a stop was published that nobody is known to have released."""
    ours: bool = True
    """False if somebody else was seen to engage or to release it."""
    waits: bool = False
    """Whether it was pressed here while nobody could obey it yet, and is given to the first who
    can."""
    by_gate: bool = False
    """Whether it is known only from the gate, or from nodes that are gone."""
    since_s: float = 0.0
    """Unix time of this screen's last message; older samples do not override it."""
    heard_s: float = 0.0
    """Unix time at which the last message on the topic was received."""
    said_s: float = 0.0
    """When it was published; for a latched message that may be long before it was received."""
    asked_s: float = 0.0
    """When the stop that was asked for was first pressed or heard here, Unix time."""
    fallback: str = ""
    """Why the nodes are stopped instead (a message id), empty if the stop reached somebody."""
    ended: tuple[str, ...] = ()
    """The nodes that were stopped instead."""
    nodes: Mapping[str, NodeStop] = field(default_factory=dict)
    """Reports of the nodes that say what they obey, by full name."""
    changed_s: float = 0.0
    """Unix time at which one of them last started or stopped holding."""
    time_s: float = 0.0
    """Unix time of the newest report."""
    awaited: Mapping[str, float] = field(default_factory=dict)
    """Nodes that have yet to confirm our release, and since when each one holds."""
    confirmed_s: float = -math.inf
    """When somebody last reported that it holds, Unix time by this machine's clock."""
    blocked: str = ""
    """Why the safety node holds the wheels, in its own words; empty if it does not."""
    gate: Gate | None = None
    """The gate's report, to be shown in the current language; None if there is none."""

    @property
    def engaged(self) -> bool:
        """Whether a node holds, or was asked to and has not reported its release."""
        return self.asked or any(node.engaged for node in self.nodes.values())

    @property
    def unconfirmed(self) -> bool:
        """Whether it was pressed, here or elsewhere, and nobody has said since that it holds."""
        if not self.asked or self.by_gate or (self.fallback and self.ended):
            return False
        if not self.ours and self.holders:
            # They may have heard it, and said so, before it was heard here.
            return False
        return self.confirmed_s < self.asked_s

    @property
    def silent(self) -> tuple[str, ...]:
        """The nodes that have said nothing since it was pressed here, though others have."""
        if not self.asked or not self.ours or self.time_s < self.since_s + SETTLED_S:
            return ()
        return tuple(sorted(name for name, node in self.nodes.items() if node.heard_s < self.since_s))

    @property
    def holders(self) -> tuple[str, ...]:
        return tuple(sorted(name for name, node in self.nodes.items() if node.engaged))

    @property
    def free(self) -> tuple[str, ...]:
        """The nodes that do not hold, though they have had as much time as the others to do so."""
        known_s = max(self.changed_s, self.heard_s, self.since_s) + SETTLED_S
        return tuple(sorted(name for name, node in self.nodes.items() if not node.engaged and node.heard_s > known_s))

    @property
    def overdue(self) -> tuple[str, ...]:
        """The nodes that hold, though they have had enough time to receive our release."""
        settled = self.time_s > self.since_s + SETTLED_S
        return tuple(sorted(self.awaited)) if settled else ()

    def pressed(self, now_s: float, *, waits: bool = False) -> Emergency:
        state = self.said(True, now_s, now_s)
        return replace(state, ours=True, since_s=now_s, awaited={}, waits=waits)

    def released(self, now_s: float) -> Emergency:
        """Release it from here; every node that holds has yet to confirm that."""
        awaited = {name: self.nodes[name].since_s for name in self.holders}
        state = self.said(False, now_s, now_s)
        return replace(state, ours=True, since_s=now_s, awaited=awaited)

    def said(self, engaged: bool, heard_s: float, said_s: float) -> Emergency:
        """Record a message that somebody published on the topic."""
        return replace(
            self,
            asked=engaged,
            waits=False,
            by_gate=False,
            heard_s=heard_s,
            said_s=said_s,
            # What the gate has told of already is confirmed.
            asked_s=min(heard_s, self.confirmed_s) if self.by_gate else heard_s,
            fallback="",
            ended=self.ended if engaged else (),
        )

    def fallen_back(self, reason: str, ended: tuple[str, ...] = ()) -> Emergency:
        """Remember which nodes are stopped instead, and why."""
        return replace(self, fallback=reason, ended=tuple(dict.fromkeys((*self.ended, *ended))))

    def seen(self, update: GraphUpdate) -> Emergency:
        """Take in what others published on the topics."""
        state = self
        # If a stop and a release arrive together, the later one counts.
        for sample in update.samples.get(EMERGENCY_STOP, ())[-1:]:
            said_s = min(sample.received_s, sample.sent_s or sample.received_s)
            state = state.heard(bool(sample.value.get("data")), sample.received_s, said_s)
        state = state.obeyed(reported_stops(state.nodes, update), update)
        for sample in update.samples.get(SAFETY_STATE, ()):
            gate = gate_in(sample.value)
            settled = sample.received_s - state.heard_s > SETTLED_S
            if gate is not None and settled and not state.nodes:
                state = state.told_by_gate(gate)
            if gate is not None and gate.verdict == STOPPED:
                state = state.confirmed(sample.received_s)
            gate = gate if gate is not None and (gate.is_held or gate.refused) else None
            state = replace(state, blocked=blocked_reason(sample), gate=gate)
        return state

    def heard(self, engaged: bool, at_s: float, said_s: float) -> Emergency:
        """Take in a message on the topic, from others or our own."""
        if at_s <= self.since_s:
            return self
        if engaged != self.asked or self.by_gate:
            state = self.said(engaged, at_s, said_s)
            # Where nodes hold, their reports say whether it is somebody else's.
            same = self.engaged == engaged and bool(self.holders)
            return replace(state, ours=self.ours and same, awaited={})
        return replace(self, heard_s=at_s)

    def obeyed(self, nodes: Mapping[str, NodeStop], update: GraphUpdate) -> Emergency:
        """Take in what the nodes report; nodes that have left the graph report nothing any more."""
        held = self.holders
        state = replace(self, nodes=present(nodes, update), time_s=update.time_s)
        for name in state.holders:
            state = state.confirmed(state.nodes[name].heard_s)
        if held and not state.nodes:
            # They still hold when they come back.
            return replace(state, asked=True, by_gate=not state.asked, awaited={})
        if state.by_gate and nodes:
            state = replace(state, asked=False, by_gate=False)
        if held != state.holders:
            state = replace(state, changed_s=update.time_s)
        if not held and state.holders and not state.asked:
            state = replace(state, ours=False)
        if state.asked and not state.holders and any(was_released(node, state.said_s) for node in nodes.values()):
            state = replace(state, asked=False, ours=False)
        return replace(state, awaited=still_awaited(state))

    def confirmed(self, at_s: float) -> Emergency:
        """Record that somebody reported at that time that it holds."""
        if at_s <= self.confirmed_s:
            return self
        reached = at_s >= self.asked_s and not self.ended
        return replace(self, confirmed_s=at_s, fallback="" if reached else self.fallback)

    def told_by_gate(self, gate: Gate) -> Emergency:
        """Take in what the gate obeys: it received stops that were published before we listened."""
        if not self.asked and gate.verdict == STOPPED:
            return replace(self, asked=True, ours=True, by_gate=True, fallback="")
        if self.by_gate and gate.verdict != STOPPED:
            return replace(self, asked=False, by_gate=False)
        return self


def was_released(node: NodeStop, said_s: float) -> bool:
    """Return whether a node that is free now obeyed a stop of that time before it was released."""
    return max(node.since_s, node.held_s) >= said_s


def still_awaited(state: Emergency) -> Mapping[str, float]:
    """Return who still holds what was released here; nobody as soon as there is a new stop."""
    since_s = {name: state.nodes[name].since_s for name in state.holders}
    anew = any(state.awaited.get(name) != since for name, since in since_s.items())
    if state.asked or anew:
        return {}
    return {name: since for name, since in state.awaited.items() if name in since_s}


def held_reason(state: Emergency) -> str:
    """Return why the wheels are held, in the current language if possible."""
    own = "" if state.gate is None else held_words(state.gate) or refused_words(state.gate)
    return own or plain(state.blocked, 400)


def listeners(update: GraphUpdate | None) -> int:
    """Return the number of subscriptions to the stop, not counting Deck's own."""
    rows = () if update is None else update.topics
    return next((row.subscribers for row in rows if row.name == EMERGENCY_STOP), 0)


def blocked_reason(sample: Sample) -> str:
    """Return the text of the most severe status of a diagnostic_msgs/DiagnosticArray, '' for OK."""
    statuses: Any = sample.value.get("status", ())
    worst, words = 0, ""
    for status in statuses if isinstance(statuses, (list, tuple)) else ():
        level = _level(status)
        if level > worst:
            worst, words = level, str(status.get("message") or status.get("name") or "")
    return words


def _level(status: object) -> int:
    """Return the level of one DiagnosticStatus, a byte: 0 ok, 1 warn, 2 error, 3 stale."""
    level = status.get("level", 0) if isinstance(status, Mapping) else 0
    if isinstance(level, (bytes, bytearray)):
        return level[0] if level else 0
    return int(level) if isinstance(level, (int, float)) else 0
