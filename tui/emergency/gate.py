"""What the gate reports about itself on /safety_state, in the current language."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from safety.gate_report import STOPPED, Gate
from text.figures import figure
from text.i18n import N_, _
from text.plain import plain
from text.robot import robot

if TYPE_CHECKING:
    from collections.abc import Iterable

HELD = {
    "blocked_forward": N_("forward is blocked"),
    "blocked_backward": N_("backward is blocked"),
    "blocked": N_("motion is blocked"),
    STOPPED: N_("emergency stop"),
    "starting": N_("the gate is starting"),
}
EXPLAINED = {"blocked_forward", "blocked_backward", "blocked"}
"""Explained by the readings of the sonars."""
PLACES = {
    "front": {
        "free": N_("{metres} m ahead"),
        "close": N_("obstacle {metres} m ahead"),
        "invalid": N_("no valid distance ahead"),
        "silent": N_("the front sonar is silent"),
    },
    "rear": {
        "free": N_("{metres} m behind"),
        "close": N_("obstacle {metres} m behind"),
        "invalid": N_("no valid distance behind"),
        "silent": N_("the rear sonar is silent"),
    },
}
NOTHING_NEAR = {"front": N_("nothing ahead"), "rear": N_("nothing behind")}
"""Nothing within the range of the sensor."""
TOO_CLOSE = {"front": N_("obstacle ahead too close to measure"), "rear": N_("obstacle behind too close to measure")}
TOO_RARE = {"front": N_("{nodes} speaks too rarely ahead"), "rear": N_("{nodes} speaks too rarely behind")}
ONE_TOO_RARE = {
    "front": N_("one of {nodes} speaks too rarely ahead"),
    "rear": N_("one of {nodes} speaks too rarely behind"),
}
REFUSED = {"m/s": N_("{value} m/s, limit {limit} m/s"), "rad": N_("{value} rad, limit {limit} rad")}
BEYOND = re.compile(r"(?P<value>\S+) (?P<unit>\S+), limit (?P<limit>\S+) (?P=unit)")
STAMP = re.compile(r"stamp (?P<age>\S+) s old")


def held_words(gate: Gate) -> str:
    """Say what is held and why; empty if nothing is held."""
    if not gate.is_held:
        return ""
    why = ""
    if gate.verdict in EXPLAINED:
        why = ", ".join(_sensor_words(gate, place, state) for place, state in gate.states.items() if state != "free")
    return _(HELD[gate.verdict]) + (f": {why}" if why else "")


def rare_words(gate: Gate) -> str:
    """Say briefly who speaks too rarely; empty if nobody does."""
    nodes = {name: None for place in gate.too_rare for name in gate.too_rare[place]}
    return _("too rare: {nodes}").format(nodes=_names(nodes)) if nodes else ""


def refused_words(gate: Gate) -> str:
    """Say what was refused; empty if nothing was."""
    told, what = gate.refused, plain(gate.refused, 60)
    if (found := BEYOND.fullmatch(told)) and found["unit"] in REFUSED:
        words = REFUSED[found["unit"]]
        what = _(words).format(value=found["value"], limit=found["limit"])
    elif found := STAMP.fullmatch(told):
        what = _("stamp {age} s old").format(age=found["age"])
    return _("refused: {what}").format(what=what) if told else ""


def gate_words(gate: Gate) -> str:
    """Say what is held or slowed and why, otherwise the distances, and which sources are obeyed."""
    parts = [held_words(gate), refused_words(gate)]
    states = (_sensor_words(gate, place, state) for place, state in gate.states.items())
    far = ", ".join(filter(None, states))
    if gate.is_slowed:
        slowed = _("slowed to {percent} %").format(percent=round(100 * gate.share))
        parts.append(f"{slowed}: {far}" if not gate.is_held else slowed)
    elif not gate.is_held:
        free = _("the path is clear")
        parts.append((f"{free}: {far}" if far else free) if gate.verdict else gate.message)
    if gate.source:
        source = _("the keys") if gate.source == robot().keys else gate.source
        parts.append(_("obeys {source}").format(source=source))
    if gate.ignored:
        parts.append(_("ignores {source}").format(source=gate.ignored))
    return plain(" · ".join(filter(None, parts)), 400)


def _names(nodes: Iterable[str]) -> str:
    return plain(", ".join(name.strip("/") for name in nodes), 100)


def _sensor_words(gate: Gate, place: str, state: str) -> str:
    metres = gate.metres.get(place)
    if nodes := gate.too_rare.get(place):
        words = TOO_RARE[place] if len(nodes) == 1 else ONE_TOO_RARE[place]
        return _(words).format(nodes=_names(nodes))
    if state == "free" and metres is None:
        return ""
    if metres is not None and math.isinf(metres) and state in ("free", "close"):
        return _((NOTHING_NEAR if state == "free" else TOO_CLOSE)[place])
    words = PLACES[place].get(state, "{metres}")
    return _(words).format(metres="?" if metres is None else figure(metres))
