"""Asking a device what it is: who answers, who does not, and that nothing moves by it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import cast

import pytest

from cli.doctor import Level
from cli.preflight.answers import DeviceAnswer, ask
from cli.preflight.open_port import OpenPort
from robot.wire.lsc16 import Battery
from robot.wire.lsc16 import encode as encode_servos
from robot.wire.pico import Telemetry, Welcome
from robot.wire.pico import encode as encode_pico
from robot.wire.tfluna import TofFrame
from robot.wire.tfluna import encode as encode_tof

HELLO, BATTERY = b"$V,0,1*119B\n", b"\x55\x55\x02\x0f"
READING = encode_tof(TofFrame(123, 1000, 25.0))
GARBAGE = bytes(range(7, 250, 3)) * 4


@dataclass
class Device:
    """A device behind a port that exists in memory: what it says by itself, and what it answers."""

    chatter: bytes = b""
    answers: dict[bytes, bytes] = field(default_factory=dict)
    baud: int = 115_200
    said: list[bytes] = field(default_factory=list)
    begins: bytes = b""
    """Comes once, before all else."""
    deaf_to: int = 0
    """So many words do not get there."""
    _answer: bytes = b""

    def hear(self, _seconds: float, enough: Callable[[bytes], bool]) -> bytes:
        heard, self._answer = self.begins + self.chatter + self._answer, b""
        self.begins = b""
        if heard:
            enough(heard)
        return heard

    def say(self, data: bytes) -> None:
        self.said.append(data)
        if len(self.said) > self.deaf_to:
            self._answer += self.answers.get(data, b"")


def asked(kind: str, device: Device) -> DeviceAnswer:
    """Ask a device; whatever it is, nothing is said that moves, and what is not well has a fix."""
    answer = ask(kind, cast("OpenPort", device))
    assert set(device.said) <= {HELLO, BATTERY}
    assert (answer.level is Level.OK) is (answer.fix == "")
    return answer


def telemetry(flags: str = "WHA", battery_v: float | None = 7.4) -> bytes:
    """Return a line of the Pico."""
    return encode_pico(Telemetry(1, 20, 0, 0.0, 0.0, 0.0, battery_v, 0.0, 0.0, 0, frozenset(flags)))


def pico(flags: str = "WHA", protocol: int = 1, battery_v: float | None = 7.4) -> Device:
    """Return a Pico that answers."""
    return Device(telemetry(flags, battery_v), {HELLO: encode_pico(Welcome(2, protocol, "1.0.0"))})


def test_devices_that_are_what_they_should_be() -> None:
    servos = Device(answers={BATTERY: encode_servos(Battery(7500))}, baud=9600)
    assert asked("pico", pico()) == (Level.OK, "firmware 1.0.0, battery 7.4 V", "")
    assert asked("pico", pico(battery_v=None)).text == "firmware 1.0.0"
    assert asked("lsc16", servos) == (Level.OK, "battery 7.5 V", "")
    sonar = asked("tf_luna", Device(READING * 20))
    assert (sonar.level, sonar.text.split(",")[0]) == (Level.OK, "1.23 m")
    assert asked("tf_luna", Device(encode_tof(TofFrame(0, 50, 25.0)) * 20)).text.startswith(
        "nothing in range"
    )
    assert asked("tf_luna", Device(encode_tof(TofFrame(10, 900, 25.0)) * 20)).text.startswith(
        "too close to measure"
    )


def test_a_pico_is_greeted_again_where_a_greeting_was_lost() -> None:
    lossy = pico()
    lossy.deaf_to = 2
    assert asked("pico", lossy) == (Level.OK, "firmware 1.0.0, battery 7.4 V", "")
    assert lossy.said == [HELLO] * 3


def test_a_pico_whose_lines_come_garbled_is_told() -> None:
    noisy = pico("WHAU")
    noisy.chatter += telemetry().replace(b"7400", b"74~0")
    answer = asked("pico", noisy)
    assert answer.level is Level.WARN
    assert answer.text.endswith("7.4 V, the battery is low, some lines arrive garbled")
    assert "the cable: short" in answer.fix
    dumb = Device(answers={HELLO: b"$T,4" * 99 + b"\n" + b"\xff\n" * 3 + pico().answers[HELLO]})
    assert asked("pico", dumb).text == "firmware 1.0.0, some lines arrive garbled"


def test_a_line_that_was_cut_by_the_opening_of_the_port_is_no_noise() -> None:
    running = pico()
    running.begins = telemetry()[7:]
    assert asked("pico", running).level is Level.OK


def test_a_device_without_a_protocol_of_ours_is_opened_and_no_more() -> None:
    answer = asked("gps", Device(b"$GPGGA\n"))
    assert answer.level is Level.OK


@pytest.mark.parametrize(
    ("flags", "words", "fix"),
    [
        ("E", "the emergency stop is held", "Ctrl+R"),
        ("L", "left motor driver", "wiring"),
        ("R", "right motor driver", "wiring"),
        ("U", "battery is low", "charge"),
    ],
)
def test_a_pico_in_trouble_is_told(flags: str, words: str, fix: str) -> None:
    answer = asked("pico", pico(flags))
    assert answer.level is Level.WARN
    assert words in answer.text
    assert fix in answer.fix


@pytest.mark.parametrize(
    ("kind", "device", "words", "fix"),
    [
        ("pico", Device(), "silent: no Pico", "flash firmware/pico2"),
        ("pico", Device(READING * 9), "a ToF sonar answers here, not the Pico", "by-id"),
        ("pico", Device(GARBAGE), "no Pico sends such", "baud (this is 115200)"),
        ("pico", Device(answers={HELLO: b"$V\r\nTraceback\r\n>>> "}), "not with Deck's", "flash"),
        ("pico", Device(b"MicroPython v1.27\r\n>>> "), "not with Deck's firmware", "flash"),
        ("pico", Device(telemetry()), "what is sent gets lost", "cable"),
        ("pico", Device(telemetry() + b"$T,4\n"), "some lines arrive garbled", "the cable: short"),
        ("pico", pico(protocol=2), "protocol 2, this program 1", "flash"),
        ("tf_luna", Device(), "silent: no TF-Luna", "not I2C"),
        ("tf_luna", Device(telemetry() * 3), "Pico answers here, not the TF-Luna", "by-id"),
        ("tf_luna", Device(GARBAGE, baud=9600), "no TF-Luna sends", "baud (this is 9600)"),
        ("tfmini_s", Device(), "silent: no TFmini-S", "not I2C"),
        ("lsc16", Device(), "silent: no LSC-16", "cross TX and RX"),
        ("lsc16", Device(READING * 9), "a ToF sonar answers here, not the LSC-16", "by-id"),
        ("lsc16", Device(answers={BATTERY: GARBAGE}), "no LSC-16 sends", "baud"),
    ],
)
def test_wrong_devices(kind: str, device: Device, words: str, fix: str) -> None:
    answer = asked(kind, device)
    assert answer.level is Level.FAIL
    assert words in answer.text
    assert fix in answer.fix


def test_what_talks_already_is_not_talked_to() -> None:
    sonar = Device(READING * 9)
    asked("pico", sonar)
    asked("lsc16", sonar)
    assert sonar.said == []
