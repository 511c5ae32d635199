"""The devices of a profile before it starts: opening their ports, who holds them, the command."""

from __future__ import annotations

import errno
import json
import os
import pty
import tty
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from cli import main
from cli.doctor import Finding, Level
from cli.preflight import examine
from cli.preflight.answers import DeviceAnswer
from cli.preflight.holders import holders
from cli.preflight.open_port import OpenPort
from cli.preflight.opening import opened
from launcher.profile.load import Profile
from launcher.profile.model import ProfileDocument
from launcher.serial_ports import SerialPort


@pytest.fixture
def port() -> Iterator[str]:
    """A pseudo-terminal with nothing behind it."""
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    yield os.ttyname(theirs)
    os.close(ours)
    os.close(theirs)


def failing(number: int) -> Callable[[str, int], OpenPort]:
    """Return an opening that fails like this."""

    def opening(path: str, _baud: int) -> OpenPort:
        raise OSError(number, os.strerror(number), path)

    return opening


OTHER = SerialPort("/dev/ttyUSB3", "", "10c4:ea60", "CP2102")


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
    assert isinstance(answer, DeviceAnswer)
    assert answer.level is Level.FAIL
    assert words in answer.text
    assert fix in answer.fix


def test_a_port_that_is_missing_lists_those_that_are_there(tmp_path: Path) -> None:
    answer = opened("pico", str(tmp_path / "none"), 115_200, [OTHER])
    assert isinstance(answer, DeviceAnswer)
    assert "no such port; ports: /dev/ttyUSB3 (10c4:ea60, CP2102)" in answer.text
    assert "DECK_PICO_PORT=" in answer.fix


def test_a_name_whose_device_was_unplugged(tmp_path: Path) -> None:
    (tmp_path / "pico").symlink_to("/dev/ttyACM99")
    answer = opened("pico", str(tmp_path / "pico"), 115_200, [])
    assert isinstance(answer, DeviceAnswer)
    assert "only its name is left" in answer.text


def test_what_is_no_serial_port(tmp_path: Path) -> None:
    (tmp_path / "pico").write_text("no device")
    answer = opened("pico", str(tmp_path / "pico"), 115_200, [])
    assert isinstance(answer, DeviceAnswer)
    assert answer.text == "it is not a serial port"


def test_a_port_that_this_program_holds_is_taken(port: str) -> None:
    line = opened("pico", port, 115_200, [])
    assert isinstance(line, OpenPort)
    taken = opened("pico", port, 115_200, [])
    assert isinstance(taken, DeviceAnswer)
    assert "another program is using it" in taken.text
    line.close()
    again = opened("pico", port, 115_200, [])
    assert isinstance(again, OpenPort)
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


def robot(*, used: bool = True, **devices: dict[str, Any]) -> Profile:
    """Return a profile with these devices, all of them used or none."""
    return Profile(
        path=Path("robot.yaml"),
        name="robot",
        nodes={},
        document=ProfileDocument.model_validate({"devices": devices}),
        domain=0,
        hardware="real",
        used=tuple(devices) if used else (),
    )


def test_devices_that_are_not_named_are_not_asked() -> None:
    assert examine(robot(used=False, pico={"port": "/dev/none"}), list) == []


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
    assert "pico: no port matches (2e8a:0005)" in missing.text
    assert missing.fix.startswith("choose with DECK_PICO_PORT=")


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
    monkeypatch.setattr("cli.preflight.examine", lambda _profile: found)
    assert main(["check", "robot", "--hardware", "real", "--preflight", "--json"]) == 2
    assert json.loads(capsys.readouterr().out) == [
        {"key": "device.pico", "level": "fail", "text": "gone", "mend": "bring it"}
    ]


def test_a_lesson_without_devices_has_nothing_to_be_asked(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["check", "01-hello", "--hardware", "real", "--preflight"]) == 0
    assert capsys.readouterr().out == "01-hello has no devices\n"
