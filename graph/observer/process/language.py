"""What is said over the socket: tuples of plain data.

To the process: `(number, name, arguments, asked_s)`. The number is that of the answer, 0 if none is
wanted; `asked_s` is on the monotonic clock, which all processes of a machine share.
From the process: `(word, ...)`, as `Word` lists them.
"""

from __future__ import annotations

import math
from typing import Any

Order = tuple[int, str, tuple[Any, ...], float]

PATH, OPEN, NUMBER, DROP, LEAVE = "path", "open", "number", "drop", "leave"
"""Where modules are; settings; the first number of goals and publications; a number that nobody
waits for any more; the end."""
WANTED = (
    "watch",
    "follow",
    "watch_pictures",
    "measure",
    "watch_goals",
    "watch_inner_states",
    "watch_frames",
    "set_period",
)
"""Orders of which only the newest counts, and a process that is made anew gets that."""
ENDING = (
    "take_back",
    "stop_publishing",
    "stop_publishing_all",
    "stop_commanding",
    "let_go",
    "cancel_goal",
    "cancel_seen_goal",
    "cancel_lost_goal",
    "forget_goal",
)
"""Orders that nobody waits for, and that are never too late."""
PREPARING = ("prepare_publisher", "prepare_hold")
"""Orders that move nothing, and that a process that is made anew gets as well."""
DOING = (
    "publish",
    "call",
    "start_publishing",
    "hold",
    "send_goal",
    "parameters",
    "set_parameters",
    "change_state",
    "logger_level",
    "set_logger_level",
)
"""Orders that are not carried out long after they were given."""
LATE_S = 5.0
"""How long that is. What hung is not to drive the robot by what was meant for another moment."""
WITHDRAWN_LATE_S = 0.5
"""The same for a latched `false`: it would take back what somebody has said since."""

UPDATE, DONE, FAILED, LATER = "update", "done", "failed", "later"
ALIVE, THERE, OVER = "alive", "there", "over"
"""An update; number and result; number and error; number and the answer that came too late; a sign
of life; who is there; why it leaves by itself."""


def is_state(name: str, arguments: tuple[Any, ...]) -> bool:
    """Whether an order holds however often it is said: a latched message, such as a stop."""
    return name == "publish" and bool(arguments[-1]) and not _withdraws(arguments)


def late_s(name: str, arguments: tuple[Any, ...]) -> float:
    """Return for how long after it was given an order is carried out, in seconds."""
    if name not in DOING or is_state(name, arguments):
        return math.inf
    return WITHDRAWN_LATE_S if name == "publish" and arguments[-1] else LATE_S


def _withdraws(arguments: tuple[Any, ...]) -> bool:
    _topic, _type_name, value, _latched = arguments
    return bool(value == {"data": False})
