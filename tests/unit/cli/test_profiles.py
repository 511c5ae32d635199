"""`deck list`, `check`, `new` and `grade`, as people and as programs read them."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterator
from pathlib import Path

import pytest

from cli import main
from cli.grade import exit_code
from course.lessons.catalog import SHIPPED
from course.lessons.lesson import folders
from course.results import State
from launcher.profile.catalog import find_profile
from launcher.profile.load import load_profile
from tests.unit.course.grade.made import grade
from tests.unit.profile_files import written
from text.i18n import set_language

PROFILES = Path(__file__).parents[3] / "profiles"


@pytest.fixture
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    yield
    set_language("en")


@pytest.mark.usefixtures("elsewhere")
def test_check_of_the_course(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(list(PROFILES.glob("*.yaml")))
    assert all(line.endswith(("node", "nodes")) and "all is well" in line for line in lines)


@pytest.mark.usefixtures("elsewhere")
def test_check_tells_every_problem_with_its_place(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written(tmp_path, "domain: 300\nnodes: {a: {run: nodes.helo}}", "bad.yaml")
    assert main(["check", "bad.yaml"]) == 2
    assert capsys.readouterr().out.splitlines() == [
        "bad.yaml:1:9: domain: expected at most 232, found 300",
        "bad.yaml:2:18: nodes.a.run: there is no module 'nodes.helo' (did you mean nodes.hello?)",
    ]


@pytest.mark.usefixtures("elsewhere")
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


@pytest.mark.usefixtures("elsewhere")
def test_a_bad_profile_starts_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written(tmp_path, f"nodes: {{a: {{exec: [touch, {tmp_path}/started], x: 1}}}}", "bad.yaml")
    for command in ("run", "up"):
        assert main([command, "bad.yaml"]) == 2
        output = capsys.readouterr()
        assert output.out == ""
        assert "nodes.a.x: unknown key" in output.err
    assert not (tmp_path / "started").exists()


@pytest.fixture
def course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("DECK_COURSE", str(tmp_path / "course"))
    return tmp_path / "course"


def test_what_was_written_is_kept_as_a_copy(course: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "2"]) == 0
    file = course / "02-sonar-safety" / "mock_sonar.py"
    starter = file.read_text("utf-8")
    file.write_text("mine = 1\n", "utf-8")
    assert main(["new", "02-sonar-safety"]) == 2, "what was written stays unless one asks"
    assert file.read_text("utf-8") == "mine = 1\n"
    assert "--again" in capsys.readouterr().err
    assert main(["new", "02-sonar-safety", "--again"]) == 0
    assert file.read_text("utf-8") == starter
    assert file.with_name("mock_sonar.py.1").read_text("utf-8") == "mine = 1\n"
    said = capsys.readouterr().out
    assert "mock_sonar.py.1" in said
    assert f"next: deck {shlex.quote(str(file.parent))}" in said
    # A folder is a profile, with that folder's name.
    profile = load_profile(find_profile(str(file.parent)))
    assert profile.name == "02-sonar-safety"
    assert profile.nodes["sonar_front"].file == str(file)


@pytest.mark.parametrize("code", ["en", "ru"])
def test_a_folder_has_its_words_in_one_language(course: Path, code: str) -> None:
    for lesson in folders(SHIPPED):
        assert main(["new", lesson.name, "--lang", code]) == 0
    texts = [file.read_text("utf-8") for file in course.rglob("*.py")]
    assert any(("MISSING" if code == "en" else "НЕ ХВАТАЕТ") in text for text in texts)
    assert not any(("НЕ ХВАТАЕТ" if code == "en" else "MISSING") in text for text in texts)
    assert sum("# ru:" in text for text in texts) == 0
    assert any(f'info("{"the sonar is on" if code == "en" else "сонар включён"}")' in text for text in texts)
    for file in course.rglob("*.yaml"):
        assert load_profile(file).nodes


def test_an_empty_node_runs_by_its_own_profile(course: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "--node", "my_sonar"]) == 0
    assert main(["check", str(course / "my_sonar")]) == 0
    assert main(["new", "--node", "my_sonar"]) == 2
    assert "choose another name" in capsys.readouterr().err
    assert main(["new", "--node", "My Sonar"]) == 2


def test_check_names_line_and_column_of_a_mistake_in_a_file_of_ones_own(
    course: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["new", "--node", "my_sonar"])
    file = course / "my_sonar" / "my_sonar.py"
    file.write_text("import rclpy\nimport std_msg\n", "utf-8")
    assert main(["check", str(file.parent)]) == 2
    assert "my_sonar.py:2:1" in capsys.readouterr().out
    file.write_text("def main(:\n", "utf-8")
    assert main(["check", str(file.parent)]) == 2
    assert "my_sonar.py:1:10" in capsys.readouterr().out


PASSED = grade(*[State.PASSED] * 5)
FAILED = grade(*[State.FAILED] * 5)
UNGRADED = grade(*[State.UNJUDGED] * 5)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["2", "{place}/nobody"], "there is no folder"),
        (["2", "{place}/anna", "{place}/anna/"], "named twice"),
        (["2", "{place}/anna", "--bag", "{place}/bags"], "is there already"),
        (["2", "{place}/anna", "--output", "/no/such/folder/file"], "cannot be written"),
        (["2", "{place}/anna", "--format", "classroom50"], "CLASSROOM"),
        (["2", "{place}/anna", "{place}/boris", "--format", "classroom50"], "one folder"),
        (["2", "{place}/anna", "--jobs", "2", "--domain", "7"], "one job"),
        (["no-such-lesson", "{place}/anna"], "no lesson"),
        (["2"], "deck new 02-sonar-safety"),
        (["{place}/empty", "{place}/anna"], "no steps"),
    ],
)
def test_what_is_wrong_is_told_before_anything_runs(
    arguments: list[str],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("DECK_COURSE", str(tmp_path / "course"))
    for name in ("anna", "boris", "bags/anna", "empty"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "empty" / "lesson.yaml").write_text("nodes: {hello: {run: nodes.hello}}")
    assert main(["grade", *(word.format(place=tmp_path) for word in arguments)]) == 2
    out, err = capsys.readouterr()
    assert said in err
    assert len(err.splitlines()) == 1
    assert not out


def test_exit_codes() -> None:
    assert exit_code([PASSED, PASSED], None) == 0
    assert exit_code([PASSED, FAILED], None) == 1
    assert exit_code([PASSED, FAILED, UNGRADED], "csv") == 3
    # Its runner takes any other code for a fault of the grader.
    assert exit_code([FAILED], "classroom50") == 0
    assert exit_code([UNGRADED], "classroom50") == 3
