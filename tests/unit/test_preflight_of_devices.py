"""Asking devices before anything is started: who answers, who does not, and that nothing moves."""

from __future__ import annotations

import errno
import json
import os
import pty
import tty
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

import cv2
import numpy as np
import pytest

from launcher.profile import Profile
from launcher.serial_ports import SerialPort
from robot.wire_lsc16 import Battery
from robot.wire_lsc16 import encode as encode_servos
from robot.wire_pico import Telemetry, Welcome
from robot.wire_pico import encode as encode_pico
from robot.wire_tfluna import TofFrame
from robot.wire_tfluna import encode as encode_tof
from tui.cli import main
from tui.doctor import Finding, Level
from tui.preflight import examine, media
from tui.preflight.answers import Answer, ask
from tui.preflight.holders import holders
from tui.preflight.line import Line
from tui.preflight.opening import opened

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
    _answer: bytes = b""

    def hear(self, _seconds: float, enough: Callable[[bytes], bool]) -> bytes:
        heard, self._answer = self.chatter + self._answer, b""
        if heard:
            enough(heard)
        return heard

    def say(self, data: bytes) -> None:
        self.said.append(data)
        self._answer += self.answers.get(data, b"")


def asked(kind: str, device: Device) -> Answer:
    """Ask a device; whatever it is, nothing is said that moves, and what is not well has a mend."""
    answer = ask(kind, cast("Line", device))
    assert set(device.said) <= {HELLO, BATTERY}
    assert (answer.level is Level.OK) is (answer.mend == "")
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


def test_a_device_without_a_protocol_of_ours_is_opened_and_no_more() -> None:
    answer = asked("gps", Device(b"$GPGGA\n"))
    assert answer.level is Level.OK


@pytest.mark.parametrize(
    ("flags", "words", "mend"),
    [
        ("E", "the emergency stop is held", "Ctrl+R"),
        ("L", "left motor driver", "wires"),
        ("R", "right motor driver", "wires"),
        ("U", "battery is low", "charge"),
    ],
)
def test_a_pico_in_trouble_is_told(flags: str, words: str, mend: str) -> None:
    answer = asked("pico", pico(flags))
    assert answer.level is Level.WARN
    assert words in answer.text
    assert mend in answer.mend


@pytest.mark.parametrize(
    ("kind", "device", "words", "mend"),
    [
        ("pico", Device(), "silent: no Pico", "flash firmware/pico2"),
        ("pico", Device(READING * 9), "a ToF sonar talks here, not the Pico", "by-id"),
        ("pico", Device(GARBAGE), "none of which a Pico says", "baud (this is 115200)"),
        ("pico", Device(answers={HELLO: b"$V\r\nTraceback\r\n>>> "}), "not with Deck's", "flash"),
        ("pico", Device(b"MicroPython v1.27\r\n>>> "), "not with Deck's firmware", "flash"),
        ("pico", Device(telemetry()), "nothing that is said gets there", "cable"),
        ("pico", pico(protocol=2), "protocol 2, this program 1", "flash"),
        ("tf_luna", Device(), "silent: no TF-Luna", "not I2C"),
        ("tf_luna", Device(telemetry() * 3), "Pico talks here, not the TF-Luna", "by-id"),
        ("tf_luna", Device(GARBAGE, baud=9600), "none of which a TF-Luna", "baud (this is 9600)"),
        ("tfmini_s", Device(), "silent: no TFmini-S", "not I2C"),
        ("lsc16", Device(), "silent: no LSC-16", "cross TX and RX"),
        ("lsc16", Device(READING * 9), "a ToF sonar talks here, not the LSC-16", "by-id"),
        ("lsc16", Device(answers={BATTERY: GARBAGE}), "none of which a LSC-16 says", "baud"),
    ],
)
def test_wrong_devices(kind: str, device: Device, words: str, mend: str) -> None:
    answer = asked(kind, device)
    assert answer.level is Level.FAIL
    assert words in answer.text
    assert mend in answer.mend


def test_what_talks_already_is_not_talked_to() -> None:
    sonar = Device(READING * 9)
    asked("pico", sonar)
    asked("lsc16", sonar)
    assert sonar.said == []


# -------------------------------------------------------------------- opening


@pytest.fixture
def port() -> Iterator[str]:
    """A pseudo-terminal with nothing behind it."""
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    yield os.ttyname(theirs)
    os.close(ours)
    os.close(theirs)


def failing(number: int) -> Callable[[str, int], Line]:
    """Return an opening that fails like this."""

    def opening(path: str, _baud: int) -> Line:
        raise OSError(number, os.strerror(number), path)

    return opening


OTHER = SerialPort("/dev/ttyUSB3", "", "10c4:ea60", "CP2102")


@pytest.mark.parametrize(
    ("number", "words", "mend"),
    [
        (errno.EACCES, "no permission", "usermod -aG"),
        (errno.EAGAIN, "another program has it", "fuser -v"),
        (errno.EBUSY, "another program has it", "fuser -v"),
        (errno.ENOTTY, "no serial port", "DECK_PICO_PORT="),
        (errno.ENXIO, "there is no such port", "plug it in"),
        (errno.EIO, "cannot be opened", "dmesg"),
    ],
)
def test_ports_that_cannot_be_opened(number: int, words: str, mend: str, tmp_path: Path) -> None:
    path = tmp_path / "pico"
    path.touch()
    answer = opened("pico", str(path), 115_200, [], failing(number))
    assert isinstance(answer, Answer)
    assert answer.level is Level.FAIL
    assert words in answer.text
    assert mend in answer.mend


def test_a_port_that_is_missing_lists_those_that_are_there(tmp_path: Path) -> None:
    answer = opened("pico", str(tmp_path / "none"), 115_200, [OTHER])
    assert isinstance(answer, Answer)
    assert "no such port; ports: /dev/ttyUSB3 (10c4:ea60, CP2102)" in answer.text
    assert "DECK_PICO_PORT=" in answer.mend


def test_a_name_whose_device_was_unplugged(tmp_path: Path) -> None:
    (tmp_path / "pico").symlink_to("/dev/ttyACM99")
    answer = opened("pico", str(tmp_path / "pico"), 115_200, [])
    assert isinstance(answer, Answer)
    assert "only its name is left" in answer.text


def test_what_is_no_serial_port(tmp_path: Path) -> None:
    (tmp_path / "pico").write_text("no device")
    answer = opened("pico", str(tmp_path / "pico"), 115_200, [])
    assert isinstance(answer, Answer)
    assert answer.text == "it is no serial port"


def test_a_port_that_this_program_holds_is_taken(port: str) -> None:
    line = opened("pico", port, 115_200, [])
    assert isinstance(line, Line)
    taken = opened("pico", port, 115_200, [])
    assert isinstance(taken, Answer)
    assert "another program has it" in taken.text
    line.close()
    again = opened("pico", port, 115_200, [])
    assert isinstance(again, Line)
    again.close()


def process(proc: Path, pid: int, command: str, *files: str) -> None:
    """Write what /proc tells of a process."""
    folder = proc / str(pid)
    (folder / "fd").mkdir(parents=True)
    (folder / "cmdline").write_bytes(command.replace(" ", "\0").encode())
    (folder / "comm").write_text("kworker\n")
    for number, path in enumerate(files):
        (folder / "fd" / str(number)).symlink_to(path)


def test_who_has_a_port_open(tmp_path: Path) -> None:
    process(tmp_path, 31, "/usr/bin/minicom -D", "/dev/null", "/dev/ttyX7")
    process(tmp_path, 30, "", "/dev/ttyX7")
    process(tmp_path, 32, "bash", "/dev/ttyX8")
    process(tmp_path, os.getpid(), "deck", "/dev/ttyX7")
    (tmp_path / "33").mkdir()
    assert list(map(str, holders("/dev/ttyX7", tmp_path))) == [
        "kworker (pid 30)",
        "minicom (pid 31)",
    ]


def test_who_made_a_pseudo_terminal_is_not_in_the_way(tmp_path: Path) -> None:
    process(tmp_path, 31, "maker", "/dev/pts/ptmx", "/dev/pts/97")
    process(tmp_path, 32, "reader", "/dev/pts/97")
    assert [holder.name for holder in holders("/dev/pts/97", tmp_path)] == ["reader"]


# -------------------------------------------------------------------- a profile


def robot(**devices: dict[str, object]) -> Profile:
    """Return a profile with these devices, all of them used."""
    return Profile(Path("robot.yaml"), "robot", {}, devices=devices, used=tuple(devices))


def test_devices_that_are_not_named_are_not_asked() -> None:
    profile = Profile(Path("x"), "x", {}, devices={"pico": {"port": "/dev/none"}})
    assert examine(profile, list) == []


def test_two_devices_on_one_port(port: str) -> None:
    link = {"kind": "tf_luna", "port": port}
    findings = examine(robot(tof_front=link, tof_rear=link), list)
    assert [finding.level for finding in findings] == [Level.FAIL, Level.FAIL]
    assert "the same port as tof_rear" in findings[0].text


def test_auto_takes_the_port_that_fits(port: str) -> None:
    there = SerialPort(port, "", "2e8a:0005", "Board in FS mode")
    (found,) = examine(robot(pico={"kind": "pico", "port": "auto"}), lambda: [there])
    assert found.key == "device.pico"
    assert f"pico {port}: the port is silent" in found.text
    (missing,) = examine(robot(pico={"kind": "pico", "port": "auto"}), list)
    assert "pico: no port fits (2e8a:0005)" in missing.text
    assert missing.mend.startswith("choose with DECK_PICO_PORT=")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["check", "--preflight", "--hardware", "real"], "needs a profile"),
        (["check", "robot", "--preflight"], "add --hardware real"),
    ],
)
def test_what_the_command_needs(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2
    assert words in capsys.readouterr().err


def test_findings_for_programs(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    found = [Finding("device.pico", Level.FAIL, "gone", "bring it")]
    monkeypatch.setattr("tui.preflight.examine", lambda _profile: found)
    assert main(["check", "robot", "--hardware", "real", "--preflight", "--json"]) == 2
    assert json.loads(capsys.readouterr().out) == [
        {"key": "device.pico", "level": "fail", "text": "gone", "mend": "bring it"}
    ]


def test_a_lesson_without_devices_has_nothing_to_be_asked(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["check", "01-hello", "--hardware", "real", "--preflight"]) == 0
    assert capsys.readouterr().out == "01-hello names no device\n"


# -------------------------------------------------------------------- camera and sound


def test_a_camera_is_asked_for_a_picture(tmp_path: Path) -> None:
    path = tmp_path / "film.avi"
    film = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 10, (320, 240))
    film.write(np.zeros((240, 320, 3), np.uint8))
    film.release()
    (found,) = examine(robot(camera={"kind": "camera", "source": str(path)}), list)
    assert (found.level, found.text) == (Level.OK, f"camera {path}: a picture of 320x240")


def test_cameras_that_are_missing_or_none(tmp_path: Path) -> None:
    (tmp_path / "note.txt").write_text("no film")
    (none,) = examine(robot(eye={"kind": "camera", "source": "77"}), list)
    assert none.level is Level.FAIL
    assert "eye /dev/video77: there is no such camera" in none.text
    assert "DECK_EYE_SOURCE=" in none.mend
    (other,) = examine(robot(eye={"kind": "camera", "source": str(tmp_path / "note.txt")}), list)
    assert other.level is Level.FAIL
    assert "it gives no picture" in other.text


CARDS = '[["USB Microphone: Audio (hw:1,0)", 1, 0], ["MAX98357A (hw:2,0)", 0, 2]]'


@pytest.mark.parametrize(
    ("cards", "settings", "level", "words"),
    [
        (CARDS, {}, Level.OK, "USB Microphone: Audio (hw:1,0), MAX98357A (hw:2,0)"),
        (CARDS, {"microphone": "usb", "speaker": "1"}, Level.OK, "MAX98357A"),
        (CARDS, {"microphone": "none", "speaker": "none"}, Level.OK, "switched off"),
        (CARDS, {"microphone": "MAX"}, Level.FAIL, "not found: microphone MAX; sound devices: USB"),
        (CARDS, {"speaker": "0"}, Level.FAIL, "not found: loudspeaker 0;"),
        ("[]", {}, Level.FAIL, "not found: microphone, loudspeaker; sound devices: none"),
        ("", {}, Level.FAIL, "sound devices: none"),
        ("no JSON", {}, Level.FAIL, "sound devices: none"),
    ],
)
def test_microphones_and_loudspeakers(
    cards: str,
    settings: dict[str, object],
    level: Level,
    words: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(media, "_run", lambda *_: cards)
    (found,) = examine(robot(sound={"kind": "sound", **settings}), list)
    assert found.level is level
    assert words in found.text
    assert (found.level is Level.OK) is (found.mend == "")
