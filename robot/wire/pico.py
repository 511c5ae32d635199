"""Messages between the computer and the Pico, one line each (see docs/pico-protocol.md).

Every body begins with a letter and a sequence number 0..65535; all further fields are whole
numbers, except two words. Angles are milliradians on the wire, radians here.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from robot.limits import Limits
from robot.wire.line import LineSplitter, wrap
from text.i18n import N_

PROTOCOL = 1
"""Both sides must use the same version; otherwise the motors stay off."""
WATCHDOG_S = 0.25
"""The Pico switches the motors off this long after the last good drive line."""
SEQUENCES = 0x10000

_SEQUENCE = Limits(0, SEQUENCES - 1, "")
_PROTOCOLS = Limits(0, 255, "")
_SPEED = Limits(-200_000, 200_000, "mrad/s")
_STEERING = Limits(-1571, 1571, "mrad")
_MILLIVOLTS = Limits(-1, 60_000, "mV")
_MILLIAMPERES = Limits(-1, 65_535, "mA")
_COUNTER = Limits(0, 0xFFFFFFFF, "")

FLAGS = {
    "E": N_("emergency stop latched"),
    "W": N_("watchdog: no drive line for 250 ms"),
    "L": N_("left motor driver reports a fault"),
    "R": N_("right motor driver reports a fault"),
    "U": N_("battery below its limit"),
    "H": N_("no handshake, or of another protocol"),
    "A": N_("waiting for a drive line of zero speed"),
    "N": N_("no encoders: speeds are as commanded"),
}
"""Letters in the last field of telemetry; `-` means none of them."""
STANDING_FLAGS = frozenset("EWLRUHA")
"""Any of these keeps the motors off."""

_INTEGERS = re.compile(r"(?:0|-?[1-9][0-9]{0,9})(?:,(?:0|-?[1-9][0-9]{0,9}))*")
_VERSION = re.compile(r"[0-9A-Za-z._-]{1,16}")


@dataclass(frozen=True)
class Hello:
    """Computer: the first line after connecting."""

    seq: int
    protocol: int = PROTOCOL


@dataclass(frozen=True)
class Drive:
    """Computer: the speeds and the steering; also the heartbeat."""

    seq: int
    left_rad_s: float
    right_rad_s: float
    steering_rad: float


@dataclass(frozen=True)
class Halt:
    """Computer: emergency stop, latched."""

    seq: int


@dataclass(frozen=True)
class Release:
    """Computer: the emergency stop is released."""

    seq: int


@dataclass(frozen=True)
class Welcome:
    """Pico: the answer to a `Hello`."""

    seq: int
    protocol: int
    firmware: str


@dataclass(frozen=True)
class Telemetry:
    """Pico: its state, 50 times a second."""

    seq: int
    uptime_ms: int
    obeyed: int
    """Sequence number of the newest drive line that was accepted."""
    left_rad_s: float
    right_rad_s: float
    steering_rad: float
    """As commanded: a hobby servo does not report its angle."""
    battery_v: float | None
    left_a: float | None
    right_a: float | None
    refused: int
    """Lines that the Pico could not use so far."""
    flags: frozenset[str] = field(default_factory=frozenset)


FromPico = Welcome | Telemetry
Message = Hello | Drive | Halt | Release | FromPico


def encode(message: Message) -> bytes:
    """Return the line for a message; raises ValueError for a value that it cannot carry."""
    body = _body(message)
    if parse(body) is None:
        raise ValueError(f"out of range: {message}")
    return wrap(body)


class PicoDecoder:
    """Finds messages in a stream of arbitrary pieces."""

    def __init__(self) -> None:
        self._lines = LineSplitter()
        self.unknown = 0
        """Lines with a correct CRC that are not messages of this protocol."""

    @property
    def errors(self) -> int:
        """Unusable lines so far."""
        return self._lines.bad + self.unknown

    def feed(self, data: bytes) -> list[Message]:
        """Return the messages that these bytes complete, oldest first."""
        found = [parse(body) for body in self._lines.feed(data)]
        messages = [message for message in found if message is not None]
        self.unknown += len(found) - len(messages)
        return messages


def _body(message: Message) -> str:
    """Return the body in its only valid form."""
    seq = message.seq
    if isinstance(message, Hello):
        return f"V,{seq},{message.protocol}"
    if isinstance(message, Drive):
        speeds = _milli(message.left_rad_s), _milli(message.right_rad_s)
        return f"D,{seq},{speeds[0]},{speeds[1]},{_milli(message.steering_rad)}"
    if isinstance(message, Halt):
        return f"E,{seq}"
    if isinstance(message, Release):
        return f"R,{seq}"
    if isinstance(message, Welcome):
        return f"W,{seq},{message.protocol},{message.firmware}"
    milli = ",".join(
        str(-1 if value is None else _milli(value))
        for value in (
            message.left_rad_s,
            message.right_rad_s,
            message.steering_rad,
            message.battery_v,
            message.left_a,
            message.right_a,
        )
    )
    flags = _letters(message.flags)
    return f"T,{seq},{message.uptime_ms},{message.obeyed},{milli},{message.refused},{flags}"


def _letters(flags: frozenset[str]) -> str:
    return "".join(flag for flag in FLAGS if flag in flags) or "-"


def parse(body: str) -> Message | None:
    """Return the message of a body, None if any field is invalid."""
    kind, *words = body.split(",")
    if kind == "T":
        return _telemetry(words)
    if kind == "W" and len(words) == 3 and _VERSION.fullmatch(words[2]):
        numbers = _integers(words[:2], (_SEQUENCE, _PROTOCOLS))
        return None if numbers is None else Welcome(numbers[0], numbers[1], words[2])
    limits = _HOST.get(kind)
    numbers = None if limits is None else _integers(words, limits)
    if numbers is None:
        return None
    if kind == "D":
        return Drive(numbers[0], *(number / 1000 for number in numbers[1:]))
    if kind == "V":
        return Hello(*numbers)
    return Halt(*numbers) if kind == "E" else Release(*numbers)


_HOST = {
    "V": (_SEQUENCE, _PROTOCOLS),
    "D": (_SEQUENCE, _SPEED, _SPEED, _STEERING),
    "E": (_SEQUENCE,),
    "R": (_SEQUENCE,),
}
_TELEMETRY = (
    *(_SEQUENCE, _COUNTER, _SEQUENCE, _SPEED, _SPEED, _STEERING),
    *(_MILLIVOLTS, _MILLIAMPERES, _MILLIAMPERES, _COUNTER),
)


def _telemetry(words: list[str]) -> Telemetry | None:
    letters = words[-1] if words else ""
    flags = frozenset[str]() if letters == "-" else frozenset(letters)
    numbers = _integers(words[:-1], _TELEMETRY)
    if numbers is None or letters != _letters(flags):
        return None
    seq, uptime_ms, obeyed, left, right, steering, battery, left_ma, right_ma, refused = numbers
    return Telemetry(
        seq,
        uptime_ms,
        obeyed,
        left / 1000,
        right / 1000,
        steering / 1000,
        _measured(battery),
        _measured(left_ma),
        _measured(right_ma),
        refused,
        flags,
    )


def _integers(words: list[str], limits: tuple[Limits, ...]) -> list[int] | None:
    """Return the numbers, None unless there is one within each limit, in its shortest form."""
    # A hundred lines a second are read this way; one match for all words costs half as much.
    if len(words) != len(limits) or not _INTEGERS.fullmatch(",".join(words)):
        return None
    numbers = [int(word) for word in words]
    for number, limit in zip(numbers, limits, strict=True):
        if not limit.low <= number <= limit.high:
            return None
    return numbers


def _measured(milli: int) -> float | None:
    """Return a measured value, None for -1, which means not measured."""
    return None if milli < 0 else milli / 1000


def _milli(value: float) -> int:
    """Return thousandths; raises ValueError for what is not a finite number."""
    try:
        return round(value * 1000)
    except OverflowError:
        raise ValueError(f"{value} is no finite number") from None
