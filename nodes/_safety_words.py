"""What the safety node says: in its log, and on /safety_state for tools and screens."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from nodes._speech import Phrase, Speech
from robot.safety import Reading, Sight, Verdict

if TYPE_CHECKING:
    from collections.abc import Sequence

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
_LOG_EVERY_S = 0.9

_VERDICTS = {
    Verdict.FREE: Phrase("motion is allowed", "движение разрешено"),
    Verdict.BLOCKED_FORWARD: Phrase("forward is blocked: {why}", "вперёд нельзя: {why}"),
    Verdict.BLOCKED_BACKWARD: Phrase("backward is blocked: {why}", "назад нельзя: {why}"),
    Verdict.BLOCKED: Phrase("motion is blocked: {why}", "движение запрещено: {why}"),
    Verdict.EMERGENCY_STOP: Phrase(
        "emergency stop until it is released", "аварийный стоп, пока его не снимут"
    ),
}
_PLACES = {"front": Phrase("front", "спереди"), "rear": Phrase("rear", "сзади")}
_REASONS = {
    Sight.CLOSE: Phrase("{place} {metres:.2f} m", "{place} {metres:.2f} м"),
    Sight.INVALID: Phrase("{place} no valid distance", "{place} нет верного расстояния"),
    Sight.SILENT: Phrase("{place} sonar is silent", "{place} сонар молчит"),
}


class View(NamedTuple):
    """What one sensor shows."""

    place: str
    """`front` or `rear`."""
    sight: Sight
    reading: Reading


def tell_front(say: Speech, sight: Sight, reading: Reading) -> None:
    """Log what the front sonar shows; each kind of news once a second at most."""
    log = say.info if sight == Sight.FREE else say.warn
    log(_SIGHTS[sight], every_s=_LOG_EVERY_S, metres=reading.distance_m, seconds=reading.age_s)


def diagnosis(say: Speech, verdict: Verdict, views: Sequence[View]) -> DiagnosticStatus:
    """The state of safety: level, a sentence, and key-values for programs."""
    bad = [view for view in views if view.sight != Sight.FREE]
    why = ", ".join(
        say.text(
            _REASONS[view.sight],
            place=say.text(_PLACES[view.place]),
            metres=view.reading.distance_m,
        )
        for view in bad
    )
    blind = any(view.sight != Sight.CLOSE for view in bad)
    level = DiagnosticStatus.WARN if bad else DiagnosticStatus.OK
    if verdict == Verdict.EMERGENCY_STOP or blind:
        level = DiagnosticStatus.ERROR
    values = [KeyValue(key="state", value=verdict.value)]
    for view in views:
        metres = view.reading.distance_m
        values += [
            KeyValue(key=view.place, value=view.sight.value),
            KeyValue(
                key=f"{view.place}_distance_m", value="" if metres is None else f"{metres:.3f}"
            ),
        ]
    return DiagnosticStatus(
        level=level,
        name="safety_stop",
        message=say.text(_VERDICTS[verdict], why=why),
        values=values,
    )
