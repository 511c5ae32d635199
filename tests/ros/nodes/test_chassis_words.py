"""Why the wheels stand: told at once, and again for who looks later."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from nodes.drivers.chassis_words import StandstillLogger
from nodes.parts import translated_logger as _translated_logger
from nodes.parts.translated_logger import TranslatedLogger
from robot.wire.pico import Telemetry
from tests.ros.nodes.test_serial_link import Log


def telemetry(flags: str, refused: int = 0) -> Telemetry:
    return Telemetry(1, 20, 0, 0.0, 0.0, 0.0, 7.4, 0.0, 0.0, refused, frozenset(flags))


def test_why_the_wheels_stand_is_told_again_while_it_lasts(monkeypatch: pytest.MonkeyPatch) -> None:
    clock: Any = SimpleNamespace(now_s=1000.0, monotonic=lambda: clock.now_s)
    monkeypatch.setattr(_translated_logger, "time", clock)
    log = Log()
    standstill = StandstillLogger(TranslatedLogger(log, "en"))  # type: ignore[arg-type]

    def told(flags: str | None, seconds: float) -> list[str]:
        """What is logged of these flags in so many seconds."""
        log.lines.clear()
        for _ in range(round(seconds / 0.5)):
            standstill.tell(None if flags is None else telemetry(flags))
            clock.now_s += 0.5
        return list(log.lines)

    weak = "The wheels stand: the battery is weak"
    left = "The wheels stand: fault of the left motor driver"
    assert told("", 20) == told(None, 20) == told("WA", 20) == []
    assert told("UA", 35) == [weak] * 4
    assert told("LUA", 1) == [f"{left}, the battery is weak"]
    assert told("L", 1) == []
    assert told(None, 1) == []
    assert told("L", 1) == [left]


def test_what_the_pico_refuses_is_told_and_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    clock: Any = SimpleNamespace(now_s=1000.0, monotonic=lambda: clock.now_s)
    monkeypatch.setattr(_translated_logger, "time", clock)
    log = Log()
    standstill = StandstillLogger(TranslatedLogger(log, "en"))  # type: ignore[arg-type]

    def told(*counts: int | None) -> list[str]:
        """How many lines are told of, when these counts come one after the other in 10 s."""
        log.lines.clear()
        for count in counts:
            standstill.tell(None if count is None else telemetry("", count))
            clock.now_s += 10 / len(counts)
        return [line.partition(" lines")[0].rpartition(" ")[2] for line in log.lines]

    assert told(None, 7, 7) == [], "what was before"
    assert told(7, 8, 20) == ["1"]
    assert told(20, 20) == ["12"]
    assert told(20, 3, 3) == [], "a new start of the Pico"
    assert told(4) == ["1"]
