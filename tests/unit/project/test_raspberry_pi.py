"""What the pages about the Raspberry Pi show: the service, the profiles, the commands."""

from __future__ import annotations

import configparser
import re
import shlex
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from cli.arguments.commands import COMMANDS, parser_of, split
from launcher.profile.device_variables import variable
from launcher.profile.load import load_profile
from text.run_path import OWN_RUN_DIR

DOCS = Path(__file__).resolve().parents[3] / "docs"
SERVICE = DOCS / "deck-robot@.service"
PAGES = ["raspberry-pi.md", "raspberry-pi.ru.md"]


@pytest.fixture(params=PAGES)
def page(request: pytest.FixtureRequest) -> str:
    """The text of the page, in each language."""
    name: str = request.param
    return (DOCS / name).read_text()


def service() -> configparser.SectionProxy:
    """Return what the unit says of the service."""
    # Settings that may be said twice are lists; what is asked for here is said once.
    unit = configparser.ConfigParser(interpolation=None, strict=False)
    unit.optionxform = str  # type: ignore[assignment,method-assign]
    unit.read_string(SERVICE.read_text())
    return unit["Service"]


def deck_words(command: str) -> list[str]:
    """Return the words after `exec deck` of the shell's command line."""
    shell = shlex.split(command)
    assert shell[:2] == ["/bin/bash", "-c"]
    return shlex.split(shell[2].rpartition("exec deck ")[2])


@pytest.mark.parametrize(("key", "command"), [("ExecStartPre", "check"), ("ExecStart", "run")])
def test_the_service_calls_deck_as_it_can_be_called(key: str, command: str) -> None:
    word, rest = split(deck_words(service()[key]))
    assert word == command
    options = parser_of(word).parse_args(rest)
    assert (options.profile, options.hardware) == ("robot", "real")


def test_only_deck_is_asked_to_stop_and_gets_the_time_that_it_may_need() -> None:
    settings = service()
    assert (settings["KillMode"], settings["KillSignal"]) == ("mixed", "SIGINT")
    assert int(settings["TimeoutStopSec"]) >= 20
    assert settings["Restart"] == "on-failure"


def analyzed(tmp_path: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Let systemd-analyze look at the service as it is installed: a template, for one user."""
    unit = tmp_path / SERVICE.name
    shutil.copy(SERVICE, unit)
    return subprocess.run(
        ["systemd-analyze", *arguments, str(unit)], capture_output=True, text=True, check=False
    )


def read_by_us(_tmp_path: Path) -> None:
    """Look for what no systemd is needed for: the sections, and what is closed."""
    unit = configparser.ConfigParser(interpolation=None, strict=False)
    unit.read_string(SERVICE.read_text())
    assert unit.sections() == ["Unit", "Service", "Install"]
    assert service()["NoNewPrivileges"] == "yes"
    assert service()["CapabilityBoundingSet"] == ""
    assert service()["ProtectHome"] == "read-only"


def read_by_systemd(tmp_path: Path) -> None:
    """Let systemd say that it knows every setting, and how far the service is closed."""
    done = analyzed(tmp_path, "verify")
    said = [line for line in done.stderr.splitlines() if "deck-robot@" in line]
    assert (done.returncode, said) == (0, [])
    done = analyzed(tmp_path, "security", "--offline=true", "--threshold=40")
    assert done.returncode == 0, done.stdout


READERS = [read_by_us, pytest.param(read_by_systemd, marks=pytest.mark.machine("systemd"))]


@pytest.mark.parametrize("read", READERS)
def test_the_service_is_sound_and_closed(read: Callable[[Path], None], tmp_path: Path) -> None:
    read(tmp_path)


def test_the_service_reaches_the_devices_of_a_robot_and_no_others() -> None:
    allowed = re.findall(r"^DeviceAllow=(.*)$", SERVICE.read_text(), re.MULTILINE)
    assert {one.split()[0].removeprefix("char-") for one in allowed} >= {
        "ttyACM",
        "ttyUSB",
        "video4linux",
        "alsa",
    }
    assert service()["DevicePolicy"] == "closed"
    assert service()["IPAddressDeny"] == "any"


def test_the_remembered_stop_and_the_logs_can_be_written_by_the_service() -> None:
    assert service()["ProtectSystem"] == "strict"
    paths = service()["ReadWritePaths"].split()
    assert {"/dev/shm", "/home/%i/.local/state/deck"} <= set(paths)


def test_the_profiles_shown_can_be_used(page: str, tmp_path: Path) -> None:
    shown = re.findall(r"```\n(extends: .*?)```", page, re.DOTALL)
    assert len(shown) == 2
    for text in shown:
        path = tmp_path / "my-robot.yaml"
        path.write_text(text)
        profile = load_profile(path, hardware="real", environ={})
        assert profile.domain == 42
        assert "chassis" in profile.nodes


def test_the_commands_shown_exist(page: str) -> None:
    for line in re.findall(r"^deck (.+?)(?: +#.*)?$", page, re.MULTILINE):
        word, rest = split(shlex.split(line))
        assert word in (*COMMANDS, "open")
        parser_of(word).parse_args(rest)


def test_the_variables_shown_are_those_of_the_robot(page: str) -> None:
    robot = load_profile(DOCS.parent / "profiles" / "robot.yaml", hardware="real")
    known = {
        variable(device, setting)
        for device, settings in robot.document.devices.items()
        for setting in settings
    }
    shown = set(re.findall(r"DECK_\w+", page))
    assert len(shown) >= 6
    assert shown <= known | {OWN_RUN_DIR}


def test_both_pages_link_what_is_there_and_have_the_same_parts(page: str) -> None:
    for link in re.findall(r"\]\(((?!https?:)[^)#]+)", page):
        assert (DOCS / link).exists(), link
    parts = {name: (DOCS / name).read_text().count("\n## ") for name in PAGES}
    assert len(set(parts.values())) == 1
