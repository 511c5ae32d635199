"""The messages of the safety node: in its log, and on /safety_state for tools and screens."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from nodes.parts.speech import Speech
from robot.safety.distance import SafetyZone, Sight, Verdict
from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from nodes.safety.distance_sensors import View
    from nodes.safety.snapshot import GateSnapshot

STARTED = N_("Watching the way: closer than {metres:g} m is danger")
EMERGENCY = N_("EMERGENCY STOP: nothing moves until it is released")
RELEASED = N_("The emergency stop is released; waiting for a new command")
COMMAND_CUT = N_("The command {speed:.2f} m/s, {steering:.2f} rad is stopped: {reason}")
COMMAND_OLD = N_("No new command for {seconds:g} s: stop")
DRIVES = N_("{source} drives now")
IGNORED = N_("{ignored} is ignored: {source} drives, and ranks higher")
HELD_UP = N_("This node was held up: commands that waited meanwhile are not obeyed")

_SIGHTS = {
    Sight.FREE: N_("The way is free ({metres:.2f} m)."),
    Sight.CLOSE: N_("EMERGENCY BRAKE! Obstacle at {metres:.2f} m."),
    Sight.INVALID: N_("The front sonar gives no valid distance ({metres}): treated as danger."),
    Sight.SILENT: N_("The front sonar has been silent for {seconds:.1f} s: treated as danger."),
}
_SIGHTS_OUT_OF_RANGE = {
    Sight.FREE: N_("The way is free (nothing in range)."),
    Sight.CLOSE: N_("EMERGENCY BRAKE! Obstacle too close to measure."),
}
"""Used instead for an infinite distance by REP-117."""
_SIGHT_SLOWED = N_("Free to move, slowed to {percent} % ({metres:.2f} m).")
_LOG_EVERY_S = 0.9

_VERDICTS = {
    Verdict.FREE: N_("motion is allowed"),
    Verdict.BLOCKED_FORWARD: N_("forward is blocked: {why}"),
    Verdict.BLOCKED_BACKWARD: N_("backward is blocked: {why}"),
    Verdict.BLOCKED: N_("motion is blocked: {why}"),
    Verdict.STARTING: N_("just started: nothing moves for a moment"),
    Verdict.EMERGENCY_STOP: N_("emergency stop until it is released"),
}
_PLACES = {"front": N_("front"), "rear": N_("rear")}
_SLOWED = N_("slowed to {percent} %: {why}")
_AND_IGNORED = N_("; {ignored} is ignored: {source} drives")
_AND_REFUSED = N_("; refused: {refused}")
_REASONS = {
    Sight.FREE: N_("{place} {metres:.2f} m"),
    Sight.CLOSE: N_("{place} {metres:.2f} m"),
    Sight.INVALID: N_("{place} no valid distance"),
    Sight.SILENT: N_("{place} sonar is silent"),
}
_REASONS_OUT_OF_RANGE = {
    Sight.FREE: N_("{place} nothing in range"),
    Sight.CLOSE: N_("{place} too close to measure"),
}


def tell_front(say: Speech, view: View) -> None:
    """Log the state of the front sonar; each kind of message once a second at most."""
    log = say.info if view.sight == Sight.FREE else say.warn
    slowed = view.sight == Sight.FREE and view.share < 1
    log(
        _SIGHT_SLOWED if slowed else _phrase(view, _SIGHTS, _SIGHTS_OUT_OF_RANGE),
        every_s=_LOG_EVERY_S,
        metres=view.reading.distance_m,
        seconds=view.reading.age_s,
        percent=_percent(view.share),
    )


def _percent(share: float) -> int:
    """Return the share in whole percent: 0 and 100 only if it is exactly that."""
    return min(99, max(1 if share else 0, round(100 * share)))


def diagnosis(
    say: Speech, verdict: Verdict, views: Sequence[View], snapshot: GateSnapshot, zone: SafetyZone
) -> DiagnosticStatus:
    """Return the state of safety: level, a sentence, and key-values for programs.

    A robot that is only slowed is fine: the level shows what blocks it.
    """
    bad = [view for view in views if view.sight != Sight.FREE]
    blind = any(view.sight != Sight.CLOSE for view in bad)
    level = DiagnosticStatus.WARN if bad or snapshot.refused else DiagnosticStatus.OK
    if verdict == Verdict.EMERGENCY_STOP or blind:
        level = DiagnosticStatus.ERROR
    return DiagnosticStatus(
        level=level,
        name="safety_stop",
        message=_sentence(say, verdict, views, snapshot),
        values=[
            KeyValue(key=key, value=value) for key, value in _values(verdict, views, snapshot, zone)
        ],
    )


def _sentence(say: Speech, verdict: Verdict, views: Sequence[View], snapshot: GateSnapshot) -> str:
    why = ", ".join(_reason(say, view) for view in views if view.sight != Sight.FREE)
    sentence = say.text(_VERDICTS[verdict], why=why)
    if 0 < snapshot.allowed < 1:
        view = views[-1 if snapshot.asked_m_s < 0 else 0]
        percent = _percent(snapshot.allowed)
        sentence = say.text(_SLOWED, percent=percent, why=_reason(say, view))
    if snapshot.ignored:
        sentence += say.text(_AND_IGNORED, ignored=snapshot.ignored, source=snapshot.source)
    if snapshot.refused:
        sentence += say.text(_AND_REFUSED, refused=snapshot.refused.words)
    return sentence


def _reason(say: Speech, view: View) -> str:
    place, metres = say.text(_PLACES[view.place]), view.reading.distance_m
    return say.text(_phrase(view, _REASONS, _REASONS_OUT_OF_RANGE), place=place, metres=metres)


def _phrase(view: View, phrases: Mapping[Sight, str], out_of_range: Mapping[Sight, str]) -> str:
    metres = view.reading.distance_m
    if metres is not None and math.isinf(metres):
        return out_of_range.get(view.sight, phrases[view.sight])
    return phrases[view.sight]


def _values(
    verdict: Verdict, views: Sequence[View], snapshot: GateSnapshot, zone: SafetyZone
) -> Iterator[tuple[str, str]]:
    yield "verdict", verdict.value
    for view in views:
        metres = view.reading.distance_m
        yield view.place, view.sight.value
        yield f"{view.place}_m", "" if metres is None else f"{metres:.3f}"
    yield "source", snapshot.source
    yield "ignored", snapshot.ignored
    yield "refused", snapshot.refused.told if snapshot.refused else ""
    yield "allowed", f"{snapshot.allowed:.2f}"
    yield "command_age_s", "" if snapshot.age_s is None else f"{snapshot.age_s:.2f}"
    yield "critical_m", f"{zone.critical_m:.6g}"
    yield "slow_m", f"{zone.slow_m:.6g}"
