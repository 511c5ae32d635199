"""What the pages give to copy can be used: profiles, and the service of the robot."""

from __future__ import annotations

import configparser
import re
import shlex
import subprocess
from pathlib import Path

import pytest

from cli.commands import COMMANDS, parser_of, split
from launcher.profile.load import load_profile
from tests.unit.scripts_of_setup import load
from text.i18n import _, set_language
from tui.actions import REGISTRY
from tui.screens import every_action

ROOT = Path(__file__).resolve().parents[3]
SERVICE = ROOT / "docs" / "deck-robot@.service"
site_pages = load("site_pages")
SHOWN = [
    (page.name, text)
    for page in (*ROOT.glob("README*.md"), *sorted((ROOT / "docs").glob("*.md")))
    for text in re.findall(r"^```(?:yaml)?\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE)
    if re.search(r"^(nodes|extends):", text, re.MULTILINE)
]


@pytest.mark.parametrize(("page", "text"), SHOWN, ids=lambda words: words.partition("\n")[0])
def test_a_profile_that_is_shown_can_be_used(page: str, text: str, tmp_path: Path) -> None:
    for own in re.findall(r"run: \./(\w+\.py)", text):
        (tmp_path / own).touch()
    path = tmp_path / "mine.yaml"
    path.write_text(text)
    assert load_profile(path, hardware="real", environ={}).nodes, page


@pytest.mark.parametrize("russian", [False, True])
def test_every_action_stands_on_a_page(russian: bool) -> None:
    """Keys are nowhere written by hand: the site makes tables of the actions of the folders that a page names."""
    pages = (ROOT / "docs").rglob("*.md")
    texts = [page.read_text() for page in pages if page.name.endswith(".ru.md") == russian]
    asked = [found for text in texts for found in site_pages.TABLE.findall(text)]
    folders = {folder for kind, of in asked if kind == "keys" for folder in of.split()}
    assert {kind for kind, _of in asked} == {"keys", "commands", "lessons"}
    assert folders == {REGISTRY[action].module.split(".")[1] for action in every_action()}


@pytest.mark.parametrize("language", ["en", "ru"])
def test_a_table_says_what_the_program_announces(language: str) -> None:
    keys = site_pages.table("keys", "teleop frame", language)
    commands = site_pages.table("commands", "", language)
    lessons = site_pages.table("lessons", "", language)
    set_language(language)
    assert "| <kbd>esc</kbd> <kbd>t</kbd> |" in keys
    assert all(_(REGISTRY[action].tooltip) in keys for action in ("teleop.close", "app.palette"))
    assert all(f"## deck {name}\n\n{_(place.help)}" in commands for name, place in COMMANDS.items())
    assert "`--for S`" in commands
    assert "`09-brain`" in lessons


def service() -> configparser.SectionProxy:
    # Settings that may be said twice are lists; what is asked for here is said once.
    unit = configparser.ConfigParser(interpolation=None, strict=False)
    unit.optionxform = str  # type: ignore[assignment,method-assign]
    unit.read_string(SERVICE.read_text())
    assert unit.sections() == ["Unit", "Service", "Install"]
    return unit["Service"]


@pytest.mark.parametrize(("key", "command"), [("ExecStartPre", "check"), ("ExecStart", "run")])
def test_the_service_calls_deck_as_it_can_be_called(key: str, command: str) -> None:
    shell = shlex.split(service()[key])
    assert shell[:2] == ["/bin/bash", "-c"]
    word, rest = split(shlex.split(shell[2].rpartition("exec deck ")[2]))
    options = parser_of(word).parse_args(rest)
    assert (word, options.profile, options.hardware) == (command, "robot", "real")


def test_the_service_stops_deck_alone_and_is_closed_but_for_what_a_robot_needs() -> None:
    settings = service()
    assert (settings["KillMode"], settings["KillSignal"]) == ("mixed", "SIGINT")
    assert int(settings["TimeoutStopSec"]) >= 20
    assert (settings["NoNewPrivileges"], settings["CapabilityBoundingSet"]) == ("yes", "")
    assert (settings["DevicePolicy"], settings["IPAddressDeny"]) == ("closed", "any")
    assert (settings["ProtectSystem"], settings["ProtectHome"]) == ("strict", "read-only")
    # The remembered stop and the logs.
    assert {"/dev/shm", "/home/%i/.local/state/deck"} <= set(settings["ReadWritePaths"].split())
    allowed = re.findall(r"^DeviceAllow=(?:char-)?(\S*)", SERVICE.read_text(), re.MULTILINE)
    assert {*allowed} >= {"ttyACM", "ttyUSB", "video4linux", "alsa"}


@pytest.mark.machine("systemd")
def test_systemd_knows_every_setting_of_the_service(tmp_path: Path) -> None:
    unit = tmp_path / SERVICE.name
    unit.write_text(SERVICE.read_text())
    for words in (["verify"], ["security", "--offline=true", "--threshold=40"]):
        done = subprocess.run(["systemd-analyze", *words, str(unit)], capture_output=True, text=True, check=False)
        said = [line for line in done.stderr.splitlines() if "deck-robot@" in line]
        assert (done.returncode, said) == (0, []), done.stdout
