"""`deck list` and `deck check`, as people and as programs read them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from cli import main
from tests.unit.profile_files import written
from text.i18n import set_language

PROFILES = Path(__file__).parents[3] / "profiles"


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    yield
    set_language("en")


def test_lessons_are_listed_with_titles_in_the_language_asked_for(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["list"]) == 0
    assert "09-brain                     One screen instead of five" in capsys.readouterr().out
    assert main(["list", "--lang", "ru"]) == 0
    assert "Один экран вместо пяти терминалов" in capsys.readouterr().out


def test_the_list_for_programs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "profiles").mkdir()
    written(tmp_path / "profiles", "nodes: 1", "zz-broken.yaml")
    assert main(["list", "--json"]) == 0
    entries = {entry["name"]: entry for entry in json.loads(capsys.readouterr().out)}
    assert entries["09-brain"]["lesson"] == "9"
    assert entries["09-brain"]["title"]["ru"] == "Один экран вместо пяти терминалов"
    assert len(entries["09-brain"]["nodes"]) == 9
    assert entries["09-brain"]["error"] == ""
    assert "expected keys and values" in entries["zz-broken"]["error"]


def test_check_of_the_course(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(list(PROFILES.glob("*.yaml")))
    assert all(line.endswith(("node", "nodes")) and "all is well" in line for line in lines)


def test_check_tells_every_problem_with_its_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    written(tmp_path, "domain: 300\nnodes: {a: {run: nodes.helo}}", "bad.yaml")
    assert main(["check", "bad.yaml"]) == 2
    assert capsys.readouterr().out.splitlines() == [
        "bad.yaml:1:9: domain: expected at most 232, found 300",
        "bad.yaml:2:18: nodes.a.run: there is no module 'nodes.helo' (did you mean nodes.hello?)",
    ]


def test_check_for_programs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written(tmp_path, "domain: 300\nnodes: {a: {exec: [x]}}", "bad.yaml")
    written(tmp_path, "domain: 150\nnodes: {a: {exec: [x]}}", "high.yaml")
    assert main(["check", "bad.yaml", "--json"]) == 2
    (bad,) = json.loads(capsys.readouterr().out)
    (problem,) = bad["problems"]
    assert (bad["path"], problem["line"], problem["field"]) == ("bad.yaml", 1, "domain")
    assert main(["check", "high.yaml", "--json"]) == 0
    (high,) = json.loads(capsys.readouterr().out)
    assert high["problems"] == []
    assert [warning["line"] for warning in high["warnings"]] == [1]


def test_check_speaks_russian(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written(tmp_path, "nodes: {a: {run: nodes.helo}}", "bad.yaml")
    assert main(["check", "bad.yaml", "--lang", "ru"]) == 2
    line = capsys.readouterr().out.strip()
    assert line == (
        "bad.yaml:1:18: nodes.a.run: нет модуля 'nodes.helo' (может быть, nodes.hello?)"
    )


def test_check_warns_and_is_content(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written(tmp_path, "domain: 150\nnodes: {a: {exec: [x]}}", "high.yaml")
    assert main(["check", "high.yaml"]) == 0
    warning, verdict = capsys.readouterr().out.splitlines()
    assert warning.startswith("high.yaml:1:9: warning: domain: the ports of domains above 101")
    assert verdict == "high.yaml: all is well, 1 node"


def test_check_takes_the_options_of_a_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    written(tmp_path, 'nodes: {a: {exec: [x], when: hardware == "mock"}}', "p.yaml")
    assert main(["check", "p.yaml", "--hardware", "real"]) == 2
    assert "no node is left with --hardware real" in capsys.readouterr().out
    assert main(["check", "p.yaml", "--set", "b.rate=1"]) == 2
    assert "--set b.rate=1: there is no node 'b'" in capsys.readouterr().out


@pytest.mark.parametrize("command", ["check", "run", "up"])
def test_a_profile_that_is_not_there_is_told(
    command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([command, "09-brian"]) == 2
    assert capsys.readouterr().err == "no profile '09-brian'; did you mean 09-brain?\n"


def test_a_bad_profile_starts_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written(tmp_path, f"nodes: {{a: {{exec: [touch, {tmp_path}/started], x: 1}}}}", "bad.yaml")
    for command in ("run", "up"):
        assert main([command, "bad.yaml"]) == 2
        output = capsys.readouterr()
        assert output.out == ""
        assert "nodes.a.x: unknown key" in output.err
    assert not (tmp_path / "started").exists()


@pytest.mark.parametrize(
    ("words", "code"),
    [(["logs", "x"], 1), (["down"], 1), (["down", "09-brain"], 1), (["ps"], 0)],
)
def test_when_nothing_runs_that_is_told(
    words: list[str], code: int, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words) == code
    output = capsys.readouterr()
    assert output.out == ""
    assert "nothing runs" in output.err or "is not running" in output.err


def test_ps_for_programs_when_nothing_runs(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["ps", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == []


def test_attach_needs_a_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["attach"]) == 2
    assert "attach needs a terminal" in capsys.readouterr().err
