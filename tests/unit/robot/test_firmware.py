"""The files of the Pico under MicroPython, with only the pins replaced and a clock by hand."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robot.wire.pico import Drive, Halt, Hello, Message, PicoDecoder, Release, Telemetry, Welcome, encode

ROOT = Path(__file__).parents[3]
FIRMWARE = ROOT / "firmware"
VECTORS = json.loads((FIRMWARE / "pico2/vectors.json").read_text(encoding="utf-8"))
LEFT_FAULT, RIGHT_FAULT, BATTERY, LEFT_CURRENT = 6, 11, 28, 26


class Pico:
    """A process with the firmware in it; its time passes only when it is told to."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, str(FIRMWARE / "bench" / "run.py")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self._process.stdout is not None
        assert json.loads(self._process.stdout.readline()) == "ready"

    def close(self) -> None:
        self._process.communicate()
        assert self._process.returncode == 0

    def order(self, **order: object) -> dict[str, Any]:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps(order) + "\n")
        self._process.stdin.flush()
        answer: dict[str, Any] = json.loads(self._process.stdout.readline())
        return answer

    def hear(self, *messages: Message, ms: int = 25, **order: object) -> dict[str, Any]:
        """Send lines, let time pass; `told` are the messages that came back."""
        octets = list(b"".join(map(encode, messages)))
        answer = self.order(octets=octets, ms=ms, **order)
        answer["told"] = PicoDecoder().feed(answer["text"].encode())
        return answer

    def start(self, encoders: bool = False) -> None:
        """Power up, shake hands, and be ready to drive; drive lines begin at 2."""
        self.order(boot=encoders)
        assert flags(self.hear(Hello(0), Drive(1, 0, 0, 0))) <= {"N"}


def flags(answer: dict[str, Any]) -> frozenset[str]:
    telemetry = [message for message in answer["told"] if isinstance(message, Telemetry)]
    return telemetry[-1].flags


def stood(answer: dict[str, Any]) -> bool:
    return all(motors == [0, 0] for motors in answer["seen"])


@pytest.fixture(scope="module")
def pico() -> Iterator[Pico]:
    pico = Pico()
    yield pico
    pico.close()


# ---------------------------------------------------------------- lines


def test_the_shared_lines_mean_the_same_on_both_sides(pico: Pico) -> None:
    for text, crc in VECTORS["crc"]:
        assert pico.order(crc=text) == {"crc": int(crc, 16)}
    for vector in VECTORS["from_host"]:
        told = pico.order(lines=vector["line"] + "\r\n")
        assert told == {"fields": [vector["fields"]], "refused": 0}
    for vector in VECTORS["bad"]:
        told = pico.order(lines=vector["line"] + "\n")
        assert told == {"fields": [], "refused": int(bool(vector["line"]))}, vector["why"]
    for vector in VECTORS["from_pico"]:
        assert pico.order(wrap=vector["fields"]) == {"line": vector["line"] + "\n"}


def test_noise_is_refused_and_lines_behind_it_are_found(pico: Pico) -> None:
    told = pico.order(lines="$D,1" * 500 + "~~" * 300 + "\n" + "\x00\x03$D$E,7*3FFE\n")
    assert told == {"fields": [["E", 7]], "refused": 1}


def test_a_hello_is_answered_and_telemetry_comes_fifty_times_a_second(pico: Pico) -> None:
    pico.order(boot=False)
    assert pico.hear(ms=500)["told"] == []
    told = pico.hear(Hello(9), ms=1000)["told"]
    assert isinstance(told[0], Welcome)
    assert told[0].protocol == VECTORS["protocol"]
    telemetry = told[1:]
    assert 45 <= len(telemetry) <= 52
    assert [message.seq for message in told] == list(range(len(told)))
    battery_v = telemetry[-1].battery_v
    assert battery_v == pytest.approx(14000 * 3.3 / 65535 * 11, abs=0.01)
    assert pico.hear(ms=500)["told"] == []


@pytest.mark.parametrize("days", [1, 6.5, 12, 13])
def test_after_days_of_silence_all_is_as_before(pico: Pico, days: float) -> None:
    """Milliseconds of a Pico wrap: what was 6.2 to 12.4 days ago seems to come yet."""
    silence = int(days * 24 * 3600 * 1000)
    pico.order(boot=False)
    for _ in range(2):
        assert pico.order(idle_ms=silence)["text"] == ""
        answer = pico.hear(Hello(0), Drive(1, 0, 0, 0), Drive(2, 5, 5, 0), ms=100)
        assert 3 <= sum(isinstance(message, Telemetry) for message in answer["told"]) <= 5
        assert flags(answer) == {"N"}
        assert not stood(answer)
        assert pico.hear(ms=1200)["motors"] == [0, 0]
    weak = pico.order(idle_ms=silence, analog={BATTERY: 9000})
    assert weak["text"] == ""
    assert {"U", "A"} <= flags(pico.hear(Hello(0), Drive(1, 0, 0, 0)))


# ---------------------------------------------------------------- when the motors turn


def test_nothing_turns_before_the_handshake_and_a_zero(pico: Pico) -> None:
    answer = pico.order(boot=False)
    assert answer["before"] is not None
    assert answer["servo_ns"] == 0
    assert stood(pico.hear(Drive(1, 5, 5, 0.1)))
    assert stood(pico.hear(Drive(2, 0, 0, 0), Drive(3, 5, 5, 0.1)))
    answer = pico.hear(Hello(4), Drive(5, 5, 5, 0.1))
    assert stood(answer)
    assert "A" in flags(answer)
    assert answer["servo_ns"] == 0
    answer = pico.hear(Drive(6, 0, 0, 0), Drive(7, 5, -10, 0.1))
    assert answer["motors"] == [65535 // 4, -(65535 // 2)]
    assert answer["servo_ns"] == 1_563_000
    assert flags(answer) == {"N"}


def test_another_protocol_moves_nothing(pico: Pico) -> None:
    pico.order(boot=False)
    answer = pico.hear(Hello(0, 2), Drive(1, 0, 0, 0), Drive(2, 5, 5, 0))
    assert stood(answer)
    assert "H" in flags(answer)


@pytest.mark.parametrize("only_timer", [False, True], ids=["", "while the rest is blocked"])
def test_silence_stops_within_the_watchdog_and_what_comes_late_does_not_drive(pico: Pico, only_timer: bool) -> None:
    pico.start()
    pico.hear(Drive(2, 5, 5, 0), ms=1)
    seen = pico.hear(ms=400, only_timer=only_timer)["seen"]
    moved = [motors != [0, 0] for motors in seen]
    assert moved == sorted(moved, reverse=True)
    assert 245 <= sum(moved) <= 262
    assert stood(pico.hear(Drive(3, 5, 5, 0)))
    pico.hear(Drive(4, 0, 0, 0))
    assert not stood(pico.hear(Drive(5, 5, 5, 0)))


def test_bad_lines_do_not_keep_the_motors_on(pico: Pico) -> None:
    pico.start()
    pico.hear(Drive(2, 5, 5, 0), ms=1)
    bad = list(encode(Drive(3, 5, 5, 0)).replace(b"*", b"*0"))
    for _ in range(14):
        answer = pico.order(octets=bad, ms=20)
    assert answer["motors"] == [0, 0]


def test_old_and_repeated_sequence_numbers_are_refused(pico: Pico) -> None:
    pico.start()
    assert stood(pico.hear(Drive(40000, 5, 5, 0)))
    answer = pico.hear(Drive(30000, 5, 5, 0), Drive(30000, 9, 9, 0), Drive(29999, 9, 9, 0))
    assert answer["motors"] == [65535 // 4] * 2
    assert answer["told"][-1].refused == 3
    assert answer["told"][-1].obeyed == 30000


def test_an_emergency_stop_holds_until_it_is_released(pico: Pico) -> None:
    pico.start()
    assert not stood(pico.hear(Drive(2, 5, 5, 0)))
    answer = pico.hear(Halt(3))
    assert answer["motors"] == [0, 0]
    assert "E" in flags(answer)
    assert stood(pico.hear(Drive(4, 0, 0, 0), Drive(5, 5, 5, 0), Hello(6), Drive(7, 5, 5, 0)))
    answer = pico.hear(Release(8), Drive(9, 5, 5, 0))
    assert stood(answer)
    assert "E" not in flags(answer)
    assert not stood(pico.hear(Drive(10, 0, 0, 0), Drive(11, 5, 5, 0)))


@pytest.mark.parametrize(("pin", "flag"), [(LEFT_FAULT, "L"), (RIGHT_FAULT, "R")])
def test_a_fault_of_a_driver_stops_both_until_a_zero_comes(pico: Pico, pin: int, flag: str) -> None:
    pico.start()
    assert not stood(pico.hear(Drive(2, 5, 5, 0)))
    answer = pico.hear(Drive(3, 5, 5, 0), levels={pin: 0})
    assert answer["motors"] == [0, 0]
    assert flags(answer) == {flag, "A", "N"}
    assert stood(pico.hear(Drive(4, 5, 5, 0), levels={pin: 1}))
    assert not stood(pico.hear(Drive(5, 0, 0, 0), Drive(6, 5, 5, 0)))


def test_a_weak_battery_stops_after_half_a_second(pico: Pico) -> None:
    pico.start()
    assert not stood(pico.hear(Drive(2, 5, 5, 0)))
    assert not stood(pico.hear(Drive(3, 5, 5, 0), ms=200, analog={BATTERY: 9000}))
    pico.hear(Drive(4, 5, 5, 0), ms=200)
    answer = pico.hear(Drive(5, 5, 5, 0), ms=200)
    assert answer["motors"] == [0, 0]
    assert {"U", "A"} <= flags(answer)
    assert "U" not in flags(pico.hear(Drive(6, 0, 0, 0), analog={BATTERY: 14000}))


@pytest.mark.parametrize(
    "beyond",
    [Drive(3, 17.908, 5, 0), Drive(3, 5, -200, 0), Drive(3, 5, 5, 0.502), Drive(3, 0, 0, -1.571)],
    ids=["left", "right", "steering", "steering of a stop"],
)
def test_what_is_beyond_the_limits_stops_and_is_counted(pico: Pico, beyond: Drive) -> None:
    """Whoever asked: it is not slowed, for nobody can have meant it."""
    pico.start()
    before = pico.hear(Drive(2, 17.906, -17.906, 0.5))
    assert not stood(before)
    assert before["told"][-1].refused == 0
    answer = pico.hear(beyond)
    assert answer["motors"] == [0, 0]
    assert answer["servo_ns"] == before["servo_ns"]
    assert flags(answer) == {"A", "N"}
    assert answer["told"][-1].refused == 1
    assert stood(pico.hear(Drive(4, 5, 5, 0)))
    pico.hear(Drive(5, 0, 0, 0))
    assert not stood(pico.hear(Drive(6, 5, 5, 0)))


def test_lines_beyond_the_limits_are_no_heartbeat(pico: Pico) -> None:
    pico.start()
    for sequence in range(2, 16):
        answer = pico.hear(Drive(sequence, 200, 200, 0), ms=20)
    assert {"W", "A"} <= flags(answer)


def test_encoders_are_read_and_close_the_loop(pico: Pico) -> None:
    pico.start(encoders=True)
    answer = pico.hear(Drive(2, 10, -10, 0), ms=200, turning=[3, -3])
    told = answer["told"][-1]
    # 3 counts of 390 in 10 ms.
    assert told.left_rad_s == pytest.approx(4.83, abs=0.2)
    assert told.right_rad_s == pytest.approx(-4.83, abs=0.2)
    assert "N" not in told.flags
    # Too slow: more power than the half that the speed alone would get, on either side.
    assert answer["motors"][0] > 0.6 * 65535
    assert answer["motors"][1] < -0.6 * 65535
