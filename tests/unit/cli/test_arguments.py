"""What can be typed after `deck`, and what a wrong word leads to: a line, the help, exit code 2."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from cli import main
from cli import main as cli_main
from cli.commands import COMMANDS, Place, split
from cli.domains import running_domain
from text.i18n import set_language


@pytest.fixture(autouse=True)
def _english_after() -> Iterator[None]:
    yield
    set_language("en")


@pytest.mark.parametrize(
    ("words", "command", "rest"),
    [
        ([], "open", []),
        (["09-brain"], "open", ["09-brain"]),
        (["run", "09-brain"], "run", ["09-brain"]),
        (["--lang", "ru", "run", "9"], "run", ["--lang", "ru", "9"]),
        (["--lang=ru", "list"], "list", ["--lang=ru"]),
        (["9", "--hardware", "mock"], "open", ["9", "--hardware", "mock"]),
        (["./run"], "open", ["./run"]),
        (["--bandwidth", "40", "watch"], "watch", ["--bandwidth", "40"]),
        (["mylist", "run"], "open", ["mylist", "run"]),
        (["--set", "run", "list"], "list", ["--set", "run"]),
        (["help"], "open", ["--help"]),
        (["--lang", "ru", "help", "run"], "run", ["--lang", "ru", "--help"]),
        (["run", "help"], "run", ["help"]),
    ],
)
def test_the_command_word_is_found(words: list[str], command: str, rest: list[str]) -> None:
    assert split(words) == (command, rest)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--bogus"], "unrecognized arguments: --bogus"),
        (["run"], "the following arguments are required: PROFILE"),
        (["run", "9", "--for", "soon"], "'soon' is not a number of seconds"),
        (["run", "9", "--for", "nan"], "'nan' is not a number of seconds"),
        (["run", "9", "--for", "-1"], "'-1' is not a number of seconds"),
        (["run", "9", "--domain", "233"], "'233' is not a ROS domain; expected a whole number"),
        (["run", "9", "--domain", "x"], "'x' is not a ROS domain"),
        (["9", "--hardware", "rael"], "invalid choice: 'rael'"),
        (["list", "--lang", "fr"], "invalid choice: 'fr'"),
        (["logs", "x", "-n", "many"], "'many' is not a number of lines"),
        (["logs", "x", "-n", "-3"], "'-3' is not a number of lines"),
        (["--bandwidth", "fast"], "'fast' is not a bandwidth; expected kB/s from 1 up, such as 40, or off"),
        (["replay", "x", "--bandwidth", "0.5"], "'0.5' is not a bandwidth"),
        (["attach", "--bandwidth", "nan"], "'nan' is not a bandwidth"),
        (["watch", "--bandwidth=-40"], "'-40' is not a bandwidth"),
        (["run", "9", "--bandwidth", "40"], "unrecognized arguments: --bandwidth 40"),
        (["record", "-o", ""], "the name of a folder is missing"),
        (["down", "a", "b"], "unrecognized arguments: b"),
    ],
)
def test_a_wrong_word_is_told_with_the_way_to_the_help(
    words: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words) == 2
    output = capsys.readouterr()
    assert output.out == ""
    assert told in output.err
    assert "--help" in output.err
    assert "Traceback" not in output.err


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_in_both_languages(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([command, "--help"]) == 0
    english = capsys.readouterr().out
    assert main([command, "--help", "--lang", "ru"]) == 0
    russian = capsys.readouterr().out
    assert english.startswith(f"usage: deck {command}")
    assert russian.startswith(f"использование: deck {command}")
    assert "show this help" not in russian
    assert not re.search(r"\b(PROFILE|NODE|NAME|TOPIC|FOLDER|BAG)\b", russian)


@pytest.mark.parametrize(("typed", "meant"), [("lst", "list"), ("doktor", "doctor"), ("hlep", "help")])
def test_a_mistyped_command_is_told_with_the_one_that_was_meant(
    typed: str, meant: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([typed]) == 2
    assert capsys.readouterr().err == (f"no profile and no command '{typed}'; did you mean `deck {meant}`?\n")
    assert main([typed, "--lang", "ru"]) == 2
    assert f"возможно, `deck {meant}`" in capsys.readouterr().err


def test_what_is_asked_for_goes_before_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_AUTOMATIC_DISCOVERY_RANGE", raising=False)
    assert running_domain(57)[1:] == (57, "localhost")
    assert running_domain(57, "subnet")[1:] == (57, "subnet")
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
    assert running_domain(57)[1:] == (57, "subnet")
    assert running_domain(57, "localhost")[1:] == (57, "localhost")


def _imported_by(code: str, folder: Path) -> set[str]:
    script = f"import sys\n{code}\nsys.stderr.write(' '.join(sys.modules))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True, cwd=folder)
    return set(done.stderr.split())


def test_nothing_heavy_is_imported_before_the_screen(tmp_path: Path) -> None:
    modules = _imported_by(
        "import cli.screen;from launcher.profile.catalog import find_profile; find_profile('9')", tmp_path
    )
    assert not modules & {"textual", "rclpy", "pydantic", "yaml", "numpy", "asyncio"}


COMMAND = """
import signal
from cli.commands import command
signal.raise_signal(signal.SIGINT)
IMPORTED = True

@command("slow", lambda parser: None)
def slow_command(options):
    raise AssertionError("the command began")
"""


def test_it_ends_with_130_once_the_import_is_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "slow_command.py").write_text(COMMAND)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setitem(COMMANDS, "slow", Place("slow_command", ""))
    before = signal.getsignal(signal.SIGINT)
    assert cli_main(["slow"]) == 130
    assert sys.modules.pop("slow_command").IMPORTED
    assert signal.getsignal(signal.SIGINT) is before
