"""What the safety node says: in its log, and on /safety_state for tools and screens."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from nodes.parts.speech import Phrase, Speech
from robot.safety.distance import SafetyZone, Sight, Verdict

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from nodes.safety.distance_sensors import View
    from nodes.safety.snapshot import GateSnapshot

STARTED = Phrase(
    "Watching the way: closer than {metres:g} m is danger",
    "Слежу за дорогой: ближе {metres:g} м — опасность",
)
EMERGENCY = Phrase(
    "EMERGENCY STOP: nothing moves until it is released",
    "АВАРИЙНЫЙ СТОП: движения нет, пока его не снимут",
)
RELEASED = Phrase(
    "The emergency stop is released; waiting for a new command",
    "Аварийный стоп снят; жду новой команды",
)
COMMAND_CUT = Phrase(
    "The command {speed:.2f} m/s, {steering:.2f} rad is stopped: {reason}",
    "Команда {speed:.2f} м/с, {steering:.2f} рад остановлена: {reason}",
)
COMMAND_OLD = Phrase(
    "No new command for {seconds:g} s: stop", "Нет новых команд дольше {seconds:g} с: стоп"
)
DRIVES = Phrase("{source} drives now", "Теперь едем по {source}")
IGNORED = Phrase(
    "{ignored} is ignored: {source} drives, and ranks higher",
    "{ignored} не слушаю: едем по {source}, он главнее",
)
HELD_UP = Phrase(
    "This node was held up: what has waited meanwhile is not obeyed",
    "Узел был остановлен: того, что накопилось за это время, не слушаю",
)

_SIGHTS = {
    Sight.FREE: Phrase("The way is free ({metres:.2f} m).", "Путь свободен ({metres:.2f} м)."),
    Sight.CLOSE: Phrase(
        "EMERGENCY BRAKE! Obstacle at {metres:.2f} m.",
        "АВАРИЙНОЕ ТОРМОЖЕНИЕ! Препятствие в {metres:.2f} м.",
    ),
    Sight.INVALID: Phrase(
        "The front sonar gives no valid distance ({metres}): treated as danger.",
        "Передний сонар не даёт расстояния ({metres}): считаю опасностью.",
    ),
    Sight.SILENT: Phrase(
        "The front sonar has been silent for {seconds:.1f} s: treated as danger.",
        "Передний сонар молчит {seconds:.1f} с: считаю опасностью.",
    ),
}
_SIGHTS_OUT_OF_RANGE = {
    Sight.FREE: Phrase("The way is free (nothing in range).", "Путь свободен (преград не видно)."),
    Sight.CLOSE: Phrase(
        "EMERGENCY BRAKE! Obstacle too close to measure.",
        "АВАРИЙНОЕ ТОРМОЖЕНИЕ! Препятствие слишком близко.",
    ),
}
"""Instead, by REP-117, of a distance that is infinite."""
_SIGHT_SLOWED = Phrase(
    "Free to move, slowed to {percent} % ({metres:.2f} m).",
    "Ехать можно, но медленнее: {percent} % скорости ({metres:.2f} м).",
)
_LOG_EVERY_S = 0.9

_VERDICTS = {
    Verdict.FREE: Phrase("motion is allowed", "движение разрешено"),
    Verdict.BLOCKED_FORWARD: Phrase("forward is blocked: {why}", "вперёд нельзя: {why}"),
    Verdict.BLOCKED_BACKWARD: Phrase("backward is blocked: {why}", "назад нельзя: {why}"),
    Verdict.BLOCKED: Phrase("motion is blocked: {why}", "движение запрещено: {why}"),
    Verdict.STARTING: Phrase(
        "just started: nothing moves for a moment", "только что запущен: пока стоим"
    ),
    Verdict.EMERGENCY_STOP: Phrase(
        "emergency stop until it is released", "аварийный стоп, пока его не снимут"
    ),
}
_PLACES = {"front": Phrase("front", "спереди"), "rear": Phrase("rear", "сзади")}
_SLOWED = Phrase("slowed to {percent} %: {why}", "замедлен до {percent} %: {why}")
_AND_IGNORED = Phrase(
    "; {ignored} is ignored: {source} drives", "; {ignored} не слушаю: едем по {source}"
)
_AND_REFUSED = Phrase("; refused: {refused}", "; отказано: {refused}")
_REASONS = {
    Sight.FREE: Phrase("{place} {metres:.2f} m", "{place} {metres:.2f} м"),
    Sight.CLOSE: Phrase("{place} {metres:.2f} m", "{place} {metres:.2f} м"),
    Sight.INVALID: Phrase("{place} no valid distance", "{place} нет верного расстояния"),
    Sight.SILENT: Phrase("{place} sonar is silent", "{place} сонар молчит"),
}
_REASONS_OUT_OF_RANGE = {
    Sight.FREE: Phrase("{place} nothing in range", "{place} преград не видно"),
    Sight.CLOSE: Phrase("{place} too close to measure", "{place} слишком близко"),
}


def tell_front(say: Speech, view: View) -> None:
    """Log what the front sonar shows; each kind of news once a second at most."""
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
    """What is let through, in whole percent: of a little not nothing, of less than all not all."""
    return min(99, max(1 if share else 0, round(100 * share)))


def diagnosis(
    say: Speech, verdict: Verdict, views: Sequence[View], snapshot: GateSnapshot, zone: SafetyZone
) -> DiagnosticStatus:
    """The state of safety: level, a sentence, and key-values for programs.

    A robot that is only slowed is well: the level tells what holds it.
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


def _phrase(
    view: View, phrases: Mapping[Sight, Phrase], out_of_range: Mapping[Sight, Phrase]
) -> Phrase:
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
