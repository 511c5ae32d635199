"""The state of the emergency stop as this screen knows it: plain data and its transitions.

It is latched: only a release clears it, ours or somebody else's seen on the topic. One whose
publisher has gone is known by the gate's word alone, and that word clears it as well.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from text.plain import plain
from tui.i18n import N_, _
from tui.teleop_gate import STOPPED, Gate, gate_in, held_words, refused_words

if TYPE_CHECKING:
    from graph.data import GraphUpdate, Sample

TOPIC = "/emergency_stop"
TOPIC_TYPE = "std_msgs/msg/Bool"
SAFETY_TOPIC = "/safety_state"
FOLLOWED = frozenset({TOPIC, SAFETY_TOPIC})
SETTLED_S = 2.0
"""So long after a word on the topic the gate may still be saying what was true before it."""

NO_LISTENER = N_("nobody listens to /emergency_stop: all nodes are being stopped")
NOT_OURS = N_("it may have reached nobody, and Deck has started no node that it could stop")
NO_GRAPH = N_("ROS cannot be reached: all nodes are being stopped")


@dataclass(frozen=True)
class Emergency:
    """What is known of the emergency stop."""

    engaged: bool = False
    ours: bool = True
    """False if somebody else was seen to engage it."""
    by_gate: bool = False
    """Whether nothing but the gate's word tells that it is engaged."""
    since_s: float = 0.0
    """Unix time of this screen's own last word on it; older samples do not contradict it."""
    heard_s: float = 0.0
    """Unix time of the last word of anybody on the topic."""
    fallback: str = ""
    """Why the nodes are stopped in its place (a message id), empty if it reached somebody."""
    blocked: str = ""
    """Why the safety node holds the wheels, in its own words; empty if it does not."""
    gate: Gate | None = None
    """The same to be told in the language of the screen, None where that is not known."""

    def pressed(self, now_s: float) -> Emergency:
        """Engage it from here."""
        return replace(self.said(True, now_s), ours=True, since_s=now_s)

    def released(self, now_s: float) -> Emergency:
        """Release it from here."""
        return replace(self.said(False, now_s), ours=True, since_s=now_s)

    def said(self, engaged: bool, at_s: float) -> Emergency:
        """Take it that somebody has said so on the topic."""
        return replace(self, engaged=engaged, by_gate=False, heard_s=at_s, fallback="")

    def fallen_back(self, reason: str) -> Emergency:
        """Remember why the nodes are stopped in its place."""
        return replace(self, fallback=reason)

    def seen(self, update: GraphUpdate) -> Emergency:
        """Take in what others said on the topics."""
        state = self
        for sample in update.samples.get(TOPIC, ()):
            state = state.heard(bool(sample.value.get("data")), sample.received_s)
        for sample in update.samples.get(SAFETY_TOPIC, ()):
            gate = gate_in(sample)
            if gate is not None and sample.received_s - state.heard_s > SETTLED_S:
                state = state.told(gate)
            gate = gate if gate is not None and (gate.is_held or gate.refused) else None
            state = replace(state, blocked=blocked_reason(sample), gate=gate)
        return state

    def heard(self, engaged: bool, at_s: float) -> Emergency:
        """Take in a word on the topic, of others or our own come back."""
        if at_s <= self.since_s:
            return self
        if engaged != self.engaged or self.by_gate:
            return replace(self.said(engaged, at_s), ours=False)
        return replace(self, heard_s=at_s)

    def told(self, gate: Gate) -> Emergency:
        """Take in what the gate obeys: it has heard of a stop that was said before we listened."""
        if not self.engaged and gate.verdict == STOPPED:
            return replace(self, engaged=True, ours=True, by_gate=True, fallback="")
        if self.by_gate and gate.verdict != STOPPED:
            return replace(self, engaged=False, by_gate=False)
        return self


def stop_words(state: Emergency, release_key: str) -> tuple[str, ...]:
    """Return what is said while it is engaged, from long to short."""
    words = _("■ EMERGENCY STOP") if state.ours else _("■ EMERGENCY STOP (by another)")
    release = _("{key} releases").format(key=release_key)
    if state.fallback:
        return (f"{words} · {_(state.fallback)} · {release}", f"{words} · {release}")
    return (f"{words} · {release}",)


def held_reason(state: Emergency) -> str:
    """Return why the wheels are held, in the screen's language where it is known."""
    own = "" if state.gate is None else held_words(state.gate) or refused_words(state.gate)
    return own or plain(state.blocked, 400)


def listeners(update: GraphUpdate | None) -> int:
    """Return how many subscriptions to the stop there are, Deck's own not counted."""
    rows = () if update is None else update.topics
    return next((row.subscribers for row in rows if row.name == TOPIC), 0)


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
