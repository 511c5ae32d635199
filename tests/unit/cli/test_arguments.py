"""What can be typed after `deck`, and what a wrong word leads to: a line, the help, exit code 2."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from cli import main
from cli.arguments.commands import COMMANDS, parser_of, split
from cli.running_domain import running_domain
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
        (
            ["--bandwidth", "fast"],
            "'fast' is not a bandwidth; expected kB/s from 1 up, such as 40, or off",
        ),
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


@pytest.mark.parametrize(
    ("typed", "limit"),
    [(None, None), ("40", 40_000), ("40k", 40_000), ("12.5", 12_500), ("0", 0), ("off", 0)],
)
@pytest.mark.parametrize("command", [[], ["attach"], ["watch"], ["replay", "bag"]])
def test_pictures_are_given_so_many_bytes_a_second(
    command: list[str], typed: str | None, limit: int | None
) -> None:
    name, rest = split([*command, *([] if typed is None else ["--bandwidth", typed])])
    assert parser_of(name).parse_args(rest).bandwidth == limit


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_in_both_languages(
    command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([command, "--help"]) == 0
    english = capsys.readouterr().out
    assert main([command, "--help", "--lang", "ru"]) == 0
    russian = capsys.readouterr().out
    assert english.startswith(f"usage: deck {command}")
    assert russian.startswith(f"использование: deck {command}")
    assert "show this help" not in russian
    assert not re.search(r"\b(PROFILE|NODE|NAME|TOPIC|FOLDER|BAG)\b", russian)


def test_the_help_of_all_names_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    text = capsys.readouterr().out
    assert all(f"\n  {command:<11} " in text for command in COMMANDS)


@pytest.mark.parametrize(("words", "usage"), [(["help"], "deck"), (["help", "run"], "deck run")])
def test_help_may_be_asked_for_as_a_command(
    words: list[str], usage: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words) == 0
    asked = capsys.readouterr().out
    assert asked.startswith(f"usage: {usage} ")
    assert main([*words[1:], "--help"]) == 0
    assert capsys.readouterr().out == asked


@pytest.mark.parametrize(
    ("typed", "meant"), [("lst", "list"), ("doktor", "doctor"), ("hlep", "help")]
)
def test_a_mistyped_command_is_told_with_the_one_that_was_meant(
    typed: str, meant: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([typed]) == 2
    assert capsys.readouterr().err == (
        f"no profile and no command '{typed}'; did you mean `deck {meant}`?\n"
    )
    assert main([typed, "--lang", "ru"]) == 2
    assert f"возможно, `deck {meant}`" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [("recrod", "/drive", "/odom"), ("recrod", "-o", "x"), ("--domain", "7", "recrod", "--for=5")],
)
def test_a_mistyped_command_is_told_also_if_more_follows(
    words: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    """And not what follows it, which the command that was meant would take."""
    assert main(words) == 2
    assert capsys.readouterr().err == (
        "no profile and no command 'recrod'; did you mean `deck record`?\n"
    )


@pytest.mark.parametrize(
    "words", [("help", "lst"), ("lst", "--help"), ("--lang", "en", "help", "lst")]
)
def test_a_mistyped_command_is_told_also_where_its_help_is_asked_for(
    words: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words) == 2
    assert capsys.readouterr().err == (
        "no profile and no command 'lst'; did you mean `deck list`?\n"
    )


def test_help_for_a_profile_is_that_of_deck(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["help", "09-brain"]) == 0
    assert capsys.readouterr().out.startswith("usage: deck [PROFILE]")


def test_what_a_profile_does_not_take_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["01-hello", "--for", "5"]) == 2
    assert "deck: unrecognized arguments: --for 5\n" in capsys.readouterr().err


def test_a_mistyped_profile_is_still_told_with_profiles(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["09-brian"]) == 2
    assert "did you mean 09-brain" in capsys.readouterr().err


def test_without_a_terminal_a_profile_must_be_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    assert "name a profile: deck run 09-brain" in capsys.readouterr().err


JOINING = {
    "watch": [],
    "frames": [],
    "shell": [],
    "record": [],
    "replay": ["bag", "--publish"],
    "doctor": ["--graph"],
    "diagnostics": [],
    "level": ["/sonar"],
    "view": [],
    "foxglove": [],
    "mcp": [],
}
"""The commands that join a graph that somebody else runs, and what they need besides."""


@pytest.mark.parametrize("command", JOINING)
def test_whoever_joins_a_graph_can_look_on_the_network(command: str) -> None:
    options = parser_of(command).parse_args([*JOINING[command], "--discovery", "subnet"])
    assert options.discovery == "subnet"
    assert parser_of(command).parse_args(JOINING[command]).discovery is None


def test_what_is_asked_for_goes_before_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_AUTOMATIC_DISCOVERY_RANGE", raising=False)
    assert running_domain(57)[1:] == (57, "localhost")
    assert running_domain(57, "subnet")[1:] == (57, "subnet")
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
    assert running_domain(57)[1:] == (57, "subnet")
    assert running_domain(57, "localhost")[1:] == (57, "localhost")


def test_the_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("deck 0.")


def _imported_by(code: str, folder: Path) -> set[str]:
    """Return the modules that there are after running `code`."""
    script = f"import sys\n{code}\nsys.stderr.write(' '.join(sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, cwd=folder
    )
    return set(done.stderr.split())


def test_list_is_quick_because_it_imports_neither_textual_nor_ros(tmp_path: Path) -> None:
    modules = _imported_by("from cli import main; main(['list'])", tmp_path)
    assert not modules & {"textual", "rich", "rclpy", "numpy", "psutil", "asyncio"}


def test_nothing_heavy_is_imported_before_the_screen(tmp_path: Path) -> None:
    modules = _imported_by(
        "import cli.screen;from launcher.profile.catalog import find_profile; find_profile('9')",
        tmp_path,
    )
    assert not modules & {"textual", "rclpy", "pydantic", "yaml", "numpy", "asyncio"}


@pytest.mark.parametrize(("chosen", "found"), [(None, "4"), ("20", "20")])
def test_threads_that_idle_take_no_core_from_what_starts_unless_somebody_wants_them_to(
    chosen: str | None, found: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    name = "OPENBLAS_THREAD_TIMEOUT"
    monkeypatch.setenv(name, "")
    if chosen is None:
        monkeypatch.delenv(name)
    else:
        monkeypatch.setenv(name, chosen)
    assert main(["--version"]) == 0
    assert os.environ[name] == found


@pytest.mark.parametrize(
    ("redirection", "code", "told"),
    [(">/dev/full", 1, "No space left"), ("<&- >&-", 0, ""), ("| true", None, "")],
)
def test_whatever_becomes_of_the_output_there_is_no_traceback(
    redirection: str, code: int | None, told: str, tmp_path: Path
) -> None:
    command = f"{shlex.quote(sys.executable)} -m tui list {redirection}"
    done = subprocess.run(
        ["sh", "-c", command], capture_output=True, text=True, cwd=tmp_path, check=False
    )
    assert code in (None, done.returncode)
    assert "Traceback" not in done.stderr
    assert told in done.stderr
