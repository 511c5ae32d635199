"""The messages of the safety node: in its log, and on /safety_state for tools and screens."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from nodes.parts.node import TranslatedLogger
from nodes.safety.state import GateSnapshot, SensorResult
from robot.safety.distance import RangeState, SafetyZone, Verdict
from text.i18n import N_

STARTED = N_("Watching the path: closer than {metres:g} m is danger")
EMERGENCY = N_("EMERGENCY STOP: nothing moves until it is released")
RELEASED = N_("The emergency stop is released; waiting for a new command")
COMMAND_CUT = N_("The command {speed:.2f} m/s, {steering:.2f} rad is stopped: {reason}")
COMMAND_OLD = N_("No new command for {seconds:g} s: stop")
DRIVES = N_("{source} drives now")
IGNORED = N_("{ignored} is ignored: {source} drives, and ranks higher")
HELD_UP = N_("This node was held up: commands that waited meanwhile are not obeyed")

_FRONT = {
    RangeState.FREE: N_("The path is clear ({metres:.2f} m)."),
    RangeState.CLOSE: N_("EMERGENCY BRAKE! Obstacle at {metres:.2f} m."),
    RangeState.INVALID: N_("The front sonar gives no valid distance ({metres}): treated as danger."),
    RangeState.SILENT: N_("The front sonar has been silent for {seconds:.1f} s: treated as danger."),
}
_FRONT_OUT_OF_RANGE = {
    RangeState.FREE: N_("The path is clear (nothing in range)."),
    RangeState.CLOSE: N_("EMERGENCY BRAKE! Obstacle too close to measure."),
}
"""Used instead for an infinite distance by REP-117."""
_FRONT_TOO_RARE = N_(
    "{nodes} speaks too rarely on the front sonar's topic, silent for {seconds:.1f} s: treated as danger."
)
_FRONT_SLOWED = N_("Free to move, slowed to {percent} % ({metres:.2f} m).")
_FRONT_HELD = {RangeState.FREE: N_("{metres:.2f} m ahead; the emergency stop holds the wheels.")}
_FRONT_HELD_OUT_OF_RANGE = {RangeState.FREE: N_("Nothing in range ahead; the emergency stop holds the wheels.")}
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
    RangeState.FREE: N_("{place} {metres:.2f} m"),
    RangeState.CLOSE: N_("{place} {metres:.2f} m"),
    RangeState.INVALID: N_("{place} no valid distance"),
    RangeState.SILENT: N_("{place} sonar is silent"),
}
_REASON_TOO_RARE = N_("{place} sonar: {nodes} speaks too rarely")
_ONE_OF = N_("one of {nodes}")
_REASONS_OUT_OF_RANGE = {
    RangeState.FREE: N_("{place} nothing in range"),
    RangeState.CLOSE: N_("{place} too close to measure"),
}


def tell_front(say: TranslatedLogger, result: SensorResult, *, stopped: bool = False) -> None:
    """Log the state of the front sonar; each kind of message once a second at most.

    `stopped`: during an emergency stop, when nothing is free to move.
    """
    log = say.info if result.state == RangeState.FREE else say.warn
    free = result.state == RangeState.FREE
    words = _phrase(result, _FRONT, _FRONT_OUT_OF_RANGE)
    if free and stopped:
        words = _phrase(result, _FRONT_HELD, _FRONT_HELD_OUT_OF_RANGE)
    elif free and result.share < 1:
        words = _FRONT_SLOWED
    log(
        _FRONT_TOO_RARE if result.too_rare else words,
        every_s=_LOG_EVERY_S,
        metres=result.reading.distance_m,
        seconds=result.reading.age_s,
        percent=_percent(result.share),
        nodes=_one_of(say, result.too_rare),
    )


def _one_of(say: TranslatedLogger, nodes: Sequence[str]) -> str:
    names = ", ".join(nodes)
    return say.text(_ONE_OF, nodes=names) if len(nodes) > 1 else names


def _percent(share: float) -> int:
    """Return the share in whole percent: 0 and 100 only if it is exactly that."""
    return min(99, max(1 if share else 0, round(100 * share)))


def diagnosis(
    say: TranslatedLogger, verdict: Verdict, results: Sequence[SensorResult], snapshot: GateSnapshot, zone: SafetyZone
) -> DiagnosticStatus:
    """Return the state of safety: level, a sentence, and key-values for programs.

    A robot that is only slowed is fine: the level shows what blocks it.
    """
    bad = [result for result in results if result.state != RangeState.FREE]
    blind = any(result.state != RangeState.CLOSE for result in bad)
    level = DiagnosticStatus.WARN if bad or snapshot.refused else DiagnosticStatus.OK
    if verdict == Verdict.EMERGENCY_STOP or blind:
        level = DiagnosticStatus.ERROR
    return DiagnosticStatus(
        level=level,
        name="safety_stop",
        message=_sentence(say, verdict, results, snapshot),
        values=[KeyValue(key=key, value=value) for key, value in _values(verdict, results, snapshot, zone)],
    )


def _sentence(
    say: TranslatedLogger, verdict: Verdict, results: Sequence[SensorResult], snapshot: GateSnapshot
) -> str:
    why = ", ".join(_reason(say, result) for result in results if result.state != RangeState.FREE)
    sentence = say.text(_VERDICTS[verdict], why=why)
    if 0 < snapshot.allowed < 1:
        result = results[-1 if snapshot.asked_m_s < 0 else 0]
        percent = _percent(snapshot.allowed)
        sentence = say.text(_SLOWED, percent=percent, why=_reason(say, result))
    if snapshot.ignored:
        sentence += say.text(_AND_IGNORED, ignored=snapshot.ignored, source=snapshot.source)
    if snapshot.refused:
        sentence += say.text(_AND_REFUSED, refused=snapshot.refused.words)
    return sentence


def _reason(say: TranslatedLogger, result: SensorResult) -> str:
    place, metres = say.text(_PLACES[result.place]), result.reading.distance_m
    if result.too_rare:
        return say.text(_REASON_TOO_RARE, place=place, nodes=_one_of(say, result.too_rare))
    return say.text(_phrase(result, _REASONS, _REASONS_OUT_OF_RANGE), place=place, metres=metres)


def _phrase(result: SensorResult, phrases: Mapping[RangeState, str], out_of_range: Mapping[RangeState, str]) -> str:
    metres = result.reading.distance_m
    if metres is not None and math.isinf(metres):
        return out_of_range.get(result.state, phrases[result.state])
    return phrases[result.state]


def _values(
    verdict: Verdict, results: Sequence[SensorResult], snapshot: GateSnapshot, zone: SafetyZone
) -> Iterator[tuple[str, str]]:
    yield "verdict", verdict.value
    for result in results:
        metres = result.reading.distance_m
        yield result.place, result.state.value
        yield f"{result.place}_too_rare", " ".join(result.too_rare)
        yield f"{result.place}_m", "" if metres is None else f"{metres:.3f}"
    yield "source", snapshot.source
    yield "ignored", snapshot.ignored
    yield "refused", snapshot.refused.told if snapshot.refused else ""
    yield "allowed", f"{snapshot.allowed:.2f}"
    yield "command_age_s", "" if snapshot.age_s is None else f"{snapshot.age_s:.2f}"
    yield "critical_m", f"{zone.critical_m:.6g}"
    yield "slow_m", f"{zone.slow_m:.6g}"
