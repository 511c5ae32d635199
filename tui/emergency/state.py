"""The state of the emergency stop as this screen knows it: plain data and its transitions.

It is latched: only a release clears it. Where nodes tell what they obey, that is what counts, and
the topic's word only until one of them has taken it. Where none does, as with a learner's own
nodes, the topic's word counts, ours or somebody else's; and of one whose publisher has gone, the
gate's word alone, which clears it as well.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from robot.topics import EMERGENCY_STATE, EMERGENCY_STOP, SAFETY_STATE
from text.i18n import N_
from text.plain import plain
from tui.emergency.gate import STOPPED, Gate, gate_in, held_words, refused_words
from tui.emergency.nodes import NodeStop, present, told

if TYPE_CHECKING:
    from graph.data import GraphUpdate, Sample

TOPIC_TYPE = "std_msgs/msg/Bool"
FOLLOWED = frozenset({EMERGENCY_STOP, EMERGENCY_STATE, SAFETY_STATE})
SETTLED_S = 2.0
"""So long after a word on the topic the gate may still be saying what was true before it."""

NO_LISTENER = N_("nobody listens to /emergency_stop: all nodes are being stopped")
NOT_OURS = N_("it may have reached nobody, and Deck has started no node that it could stop")
NO_GRAPH = N_("ROS cannot be reached: all nodes are being stopped")


@dataclass(frozen=True)
class Emergency:
    """What is known of the emergency stop."""

    asked: bool = False
    """Whether a stop has been said that nobody is known to have released."""
    ours: bool = True
    """False if somebody else was seen to engage it, or to release it."""
    by_gate: bool = False
    """Whether nothing but the word of the gate, or of nodes that have gone, tells of it."""
    since_s: float = 0.0
    """Unix time of this screen's own last word on it; older samples do not contradict it."""
    heard_s: float = 0.0
    """Unix time of the last word of anybody on the topic."""
    said_s: float = 0.0
    """When that was said, which of a latched word may be long before it was heard."""
    fallback: str = ""
    """Why the nodes are stopped in its place (a message id), empty if it reached somebody."""
    ended: tuple[str, ...] = ()
    """The nodes that were stopped in its place."""
    nodes: Mapping[str, NodeStop] = field(default_factory=dict)
    """Full name of each node that tells what it obeys, and that."""
    changed_s: float = 0.0
    """Unix time at which one of them has begun or ceased to hold."""
    time_s: float = 0.0
    """Unix time of the newest that is known."""
    awaited: Mapping[str, float] = field(default_factory=dict)
    """Those that have yet to confirm our release, and since when they hold."""
    blocked: str = ""
    """Why the safety node holds the wheels, in its own words; empty if it does not."""
    gate: Gate | None = None
    """The same to be told in the language of the screen, None where that is not known."""

    @property
    def engaged(self) -> bool:
        """Whether a node holds, or has been asked to and has not said that it was released."""
        return self.asked or any(node.engaged for node in self.nodes.values())

    @property
    def holders(self) -> tuple[str, ...]:
        """The nodes that hold."""
        return tuple(sorted(name for name, node in self.nodes.items() if node.engaged))

    @property
    def free(self) -> tuple[str, ...]:
        """The nodes that do not, though they have had the time to hear of it as others have."""
        known_s = max(self.changed_s, self.heard_s, self.since_s) + SETTLED_S
        return tuple(
            sorted(
                name
                for name, node in self.nodes.items()
                if not node.engaged and node.heard_s > known_s
            )
        )

    @property
    def overdue(self) -> tuple[str, ...]:
        """The nodes that hold though they have had the time to hear of our release."""
        settled = self.time_s > self.since_s + SETTLED_S
        return tuple(sorted(self.awaited)) if settled else ()

    def pressed(self, now_s: float) -> Emergency:
        """Engage it from here."""
        return replace(self.said(True, now_s, now_s), ours=True, since_s=now_s, awaited={})

    def released(self, now_s: float) -> Emergency:
        """Release it from here, which every node that holds has yet to confirm."""
        awaited = {name: self.nodes[name].since_s for name in self.holders}
        state = self.said(False, now_s, now_s)
        return replace(state, ours=True, since_s=now_s, awaited=awaited)

    def said(self, engaged: bool, heard_s: float, said_s: float) -> Emergency:
        """Take it that somebody has said so on the topic."""
        return replace(
            self,
            asked=engaged,
            by_gate=False,
            heard_s=heard_s,
            said_s=said_s,
            fallback="",
            ended=self.ended if engaged else (),
        )

    def fallen_back(self, reason: str, ended: tuple[str, ...] = ()) -> Emergency:
        """Remember why nodes are stopped in its place, and which."""
        return replace(self, fallback=reason, ended=tuple(dict.fromkeys((*self.ended, *ended))))

    def seen(self, update: GraphUpdate) -> Emergency:
        """Take in what others said on the topics."""
        state = self
        # Of a word and its opposite that have come together the later one counts.
        for sample in update.samples.get(EMERGENCY_STOP, ())[-1:]:
            said_s = min(sample.received_s, sample.sent_s or sample.received_s)
            state = state.heard(bool(sample.value.get("data")), sample.received_s, said_s)
        state = state.obeyed(told(state.nodes, update), update)
        for sample in update.samples.get(SAFETY_STATE, ()):
            gate = gate_in(sample)
            settled = sample.received_s - state.heard_s > SETTLED_S
            if gate is not None and settled and not state.nodes:
                state = state.told_by_gate(gate)
            gate = gate if gate is not None and (gate.is_held or gate.refused) else None
            state = replace(state, blocked=blocked_reason(sample), gate=gate)
        return state

    def heard(self, engaged: bool, at_s: float, said_s: float) -> Emergency:
        """Take in a word on the topic, of others or our own come back."""
        if at_s <= self.since_s:
            return self
        if engaged != self.asked or self.by_gate:
            state = self.said(engaged, at_s, said_s)
            # Where nodes hold, it is their word that it is another's.
            same = self.engaged == engaged and bool(self.holders)
            return replace(state, ours=self.ours and same, awaited={})
        return replace(self, heard_s=at_s)

    def obeyed(self, nodes: Mapping[str, NodeStop], update: GraphUpdate) -> Emergency:
        """Take in what the nodes say that they obey; who has left the graph says nothing more."""
        held = self.holders
        state = replace(self, nodes=present(nodes, update), time_s=update.time_s)
        if held and not state.nodes:
            # They hold still when they come back.
            return replace(state, asked=True, by_gate=not state.asked, awaited={})
        if state.by_gate and nodes:
            state = replace(state, asked=False, by_gate=False)
        if held != state.holders:
            state = replace(state, changed_s=update.time_s)
        if not held and state.holders and not state.asked:
            state = replace(state, ours=False)
        if (
            state.asked
            and not state.holders
            and any(was_released(node, state.said_s) for node in nodes.values())
        ):
            state = replace(state, asked=False, ours=False)
        return replace(state, awaited=still_awaited(state))

    def told_by_gate(self, gate: Gate) -> Emergency:
        """Take in what the gate obeys: it has heard of a stop that was said before we listened."""
        if not self.asked and gate.verdict == STOPPED:
            return replace(self, asked=True, ours=True, by_gate=True, fallback="")
        if self.by_gate and gate.verdict != STOPPED:
            return replace(self, asked=False, by_gate=False)
        return self


def was_released(node: NodeStop, said_s: float) -> bool:
    """Tell whether a node that is free has obeyed a stop of that time, before it was released."""
    return max(node.since_s, node.held_s) >= said_s


def still_awaited(state: Emergency) -> Mapping[str, float]:
    """Return who still holds what was released here; nobody as soon as there is a new stop."""
    since_s = {name: state.nodes[name].since_s for name in state.holders}
    anew = any(state.awaited.get(name) != since for name, since in since_s.items())
    if state.asked or anew:
        return {}
    return {name: since for name, since in state.awaited.items() if name in since_s}


def held_reason(state: Emergency) -> str:
    """Return why the wheels are held, in the screen's language where it is known."""
    own = "" if state.gate is None else held_words(state.gate) or refused_words(state.gate)
    return own or plain(state.blocked, 400)


def listeners(update: GraphUpdate | None) -> int:
    """Return how many subscriptions to the stop there are, Deck's own not counted."""
    rows = () if update is None else update.topics
    return next((row.subscribers for row in rows if row.name == EMERGENCY_STOP), 0)


def blocked_reason(sample: Sample) -> str:
    """Return the words of the gravest status of a diagnostic_msgs/DiagnosticArray, OK is ''."""
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
