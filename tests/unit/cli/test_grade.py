"""`deck grade`: what is wrong is told before anything runs; the exit codes."""

from __future__ import annotations

from pathlib import Path

import pytest

from cli.grade import exit_code
from cli.main import main
from course.results import State
from tests.unit.course.grade.made import grade

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
        (["2", "{place}/anna", "{place}/boris", "--format", "gradescope"], "one folder"),
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
