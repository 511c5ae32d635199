"""Devices before a start: who answers, that nothing moves by it, and who holds a port."""

from __future__ import annotations

import errno
import os
import pty
import tty
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

import pytest

from cli.doctor.finding import Finding, Level, ok
from cli.preflight import devices
from cli.preflight.answers import ask
from cli.preflight.devices import examine
from cli.preflight.open_port import OpenPort, opened
from launcher.profile.load import Profile
from launcher.serial_ports import SerialPort
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


def asked(kind: str, device: Device) -> Finding:
    answer = ask(kind, cast("OpenPort", device))
    assert set(device.said) <= {HELLO, BATTERY}
    assert (answer.level is Level.OK) is (answer.fix == "")
    return answer


def telemetry(flags: str = "WHA", battery_v: float | None = 7.4) -> bytes:
    return encode_pico(Telemetry(1, 20, 0, 0.0, 0.0, 0.0, battery_v, 0.0, 0.0, 0, frozenset(flags)))


def pico(flags: str = "WHA", protocol: int = 1, battery_v: float | None = 7.4) -> Device:
    return Device(telemetry(flags, battery_v), {HELLO: encode_pico(Welcome(2, protocol, "1.0.0"))})


def test_devices_that_are_what_they_should_be() -> None:
    servos = Device(answers={BATTERY: encode_servos(Battery(7500))}, baud=9600)
    assert asked("pico", pico()) == ok("", "firmware 1.0.0, battery 7.4 V")
    assert asked("pico", pico(battery_v=None)).text == "firmware 1.0.0"
    assert asked("lsc16", servos) == ok("", "battery 7.5 V")
    sonar = asked("tf_luna", Device(READING * 20))
    assert (sonar.level, sonar.text.split(",")[0]) == (Level.OK, "1.23 m")
    assert asked("tf_luna", Device(encode_tof(TofFrame(0, 50, 25.0)) * 20)).text.startswith("nothing in range")
    assert asked("tf_luna", Device(encode_tof(TofFrame(10, 900, 25.0)) * 20)).text.startswith("too close to measure")


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


@pytest.fixture
def port() -> Iterator[str]:
    """A pseudo-terminal with nothing behind it."""
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    yield os.ttyname(theirs)
    os.close(ours)
    os.close(theirs)


def failing(number: int) -> Callable[[str, int], OpenPort]:
    def opening(path: str, _baud: int) -> OpenPort:
        raise OSError(number, os.strerror(number), path)

    return opening


@pytest.mark.parametrize(
    ("number", "words", "fix"),
    [
        (errno.EACCES, "no permission", "usermod -aG"),
        (errno.EAGAIN, "another program is using it", "fuser -v"),
        (errno.EBUSY, "another program is using it", "fuser -v"),
        (errno.ENOTTY, "not a serial port", "DECK_PICO_PORT="),
        (errno.ENXIO, "there is no such port", "plug it in"),
        (errno.EIO, "cannot be opened", "dmesg"),
    ],
)
def test_ports_that_cannot_be_opened(
    number: int, words: str, fix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Here by a user who is in no group, whoever runs this."""
    monkeypatch.setattr(os, "getgroups", list)
    path = tmp_path / "pico"
    path.touch()
    answer = opened("pico", str(path), 115_200, [], failing(number))
    assert isinstance(answer, Finding)
    assert answer.level is Level.FAIL
    assert words in answer.text
    assert fix in answer.fix


def test_a_port_that_this_program_holds_is_taken(port: str) -> None:
    line = opened("pico", port, 115_200, [])
    assert isinstance(line, OpenPort)
    taken = opened("pico", port, 115_200, [])
    assert isinstance(taken, Finding)
    assert "another program is using it" in taken.text
    line.close()
    again = opened("pico", port, 115_200, [])
    assert isinstance(again, OpenPort)
    again.close()


# -------------------------------------------------------------------- a profile


def robot(*, used: bool = True, **devices: dict[str, Any]) -> Profile:
    return Profile(
        path=Path("robot.yaml"),
        name="robot",
        devices=devices,
        domain=0,
        hardware="real",
        used=tuple(devices) if used else (),
    )


def test_auto_takes_the_port_that_fits(port: str) -> None:
    there = SerialPort(port, "", "2e8a:0005", "Board in FS mode")
    (found,) = examine(robot(pico={"kind": "pico", "port": "auto"}), lambda: [there])
    assert found.key == "device.pico"
    assert f"pico {port}: the port is silent" in found.text
    (missing,) = examine(robot(pico={"kind": "pico", "port": "auto"}), list)
    assert "pico: no port matches (2e8a:0005)" in missing.text
    assert missing.fix.startswith("choose with DECK_PICO_PORT=")


CARDS = '[["USB Microphone, Audio"], ["HDMI", "MAX98357A"]]'


@pytest.mark.parametrize(
    ("cards", "settings", "level", "words"),
    [
        (CARDS, {}, Level.OK, "USB Microphone, Audio, HDMI"),
        (CARDS, {"microphone": "usb", "speaker": "1"}, Level.OK, "MAX98357A"),
        (CARDS, {"microphone": "none", "speaker": "none"}, Level.OK, "switched off"),
        (CARDS, {"microphone": "MAX"}, Level.FAIL, "not found: microphone MAX; sound devices: USB"),
        (CARDS, {"speaker": "2"}, Level.FAIL, "not found: loudspeaker 2;"),
        ("[[], []]", {}, Level.FAIL, "not found: microphone, loudspeaker; sound devices: none"),
        ("", {}, Level.FAIL, "sound devices: none"),
        ("no JSON", {}, Level.FAIL, "sound devices: none"),
    ],
)
def test_microphones_and_loudspeakers(
    cards: str, settings: dict[str, object], level: Level, words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(devices, "_run", lambda *_: cards)
    (found,) = examine(robot(sound={"kind": "sound", **settings}), list)
    assert found.level is level
    assert words in found.text
    assert (found.level is Level.OK) is (found.fix == "")
