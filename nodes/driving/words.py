"""What `drive_to_point` says, in its log and in the result of the action."""

from __future__ import annotations

from nodes.parts.speech import Phrase

STARTED = Phrase(
    "Ready to drive to a point: action {action}", "Готов ехать к точке: экшен {action}"
)
GOAL = Phrase(
    "Driving to x {x:.2f}, y {y:.2f} m, to within {tolerance:.2f} m",
    "Еду к точке x {x:.2f}, y {y:.2f} м, с точностью {tolerance:.2f} м",
)

REACHED = Phrase("There: the point is {distance:.2f} m away", "Приехал: до точки {distance:.2f} м")
CANCELLED = Phrase(
    "Cancelled as asked, {distance:.2f} m from the point",
    "Отменено по просьбе, до точки {distance:.2f} м",
)
REPLACED = Phrase(
    "Given up for a newer goal, {distance:.2f} m from the point",
    "Брошено ради новой цели, до точки {distance:.2f} м",
)
NO_ODOMETRY = Phrase(
    "Nobody tells {topic}: where the robot is is not known; start its base, or simulate:=auto",
    "Нет {topic}: неизвестно, где робот; запустите его базу или simulate:=auto",
)
STALE = Phrase(
    "No {topic} for {stale_s:g} s, {distance:.2f} m from the point: the base is gone",
    "Нет {topic} дольше {stale_s:g} с, до точки {distance:.2f} м: база пропала",
)
STANDS = Phrase(
    "The robot has not moved for {patience_s:g} s, {distance:.2f} m from the point: "
    "something holds it, a safety gate or an obstacle",
    "Робот не движется {patience_s:g} с, до точки {distance:.2f} м: "
    "его что-то держит, узел безопасности или препятствие",
)
WANDERS = Phrase(
    "The robot drives and does not arrive, {distance:.2f} m from the point: "
    "does the odometry tell the truth, and does nobody else steer?",
    "Робот едет и не доезжает, до точки {distance:.2f} м: "
    "верна ли одометрия и не рулит ли кто-то ещё?",
)
EMERGENCY = Phrase(
    "Emergency stop, {distance:.2f} m from the point",
    "Аварийный стоп, до точки {distance:.2f} м",
)
ENDING = Phrase(
    "The node is ending, {distance:.2f} m from the point",
    "Узел завершает работу, до точки {distance:.2f} м",
)

NO_NUMBERS = Phrase(
    "Refused: x {x}, y {y}, tolerance {tolerance} are not all numbers",
    "Отказ: x {x}, y {y}, tolerance {tolerance} — не всё числа",
)
TOO_FAR = Phrase(
    "Refused: x {x:g}, y {y:g} m is farther away than {farthest:g} m (max_distance)",
    "Отказ: до x {x:g}, y {y:g} м дальше {farthest:g} м (max_distance)",
)
BAD_TOLERANCE = Phrase(
    "Refused: tolerance {tolerance:g} m, must be 0 or from {finest:g} to {coarsest:g} m",
    "Отказ: tolerance {tolerance:g} м, а нужно 0 или от {finest:g} до {coarsest:g} м",
)
HELD = Phrase(
    "Refused: the emergency stop is held, release it first",
    "Отказ: действует аварийный стоп, сначала снимите его",
)
EMERGENCY_HELD = Phrase(
    "EMERGENCY STOP: no goal is driven to until it is released",
    "АВАРИЙНЫЙ СТОП: никуда не еду, пока его не снимут",
)
RELEASED = Phrase(
    "The emergency stop is released; waiting for a new goal",
    "Аварийный стоп снят; жду новой цели",
)
