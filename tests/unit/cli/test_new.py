"""`deck new`: a folder of one's own, in which nothing is lost."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

from cli.main import main
from launcher.profile.catalog import find_profile
from launcher.profile.load import load_profile


@pytest.fixture
def course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder in which the learner works."""
    monkeypatch.setenv("DECK_COURSE", str(tmp_path / "course"))
    return tmp_path / "course"


def test_what_was_written_is_kept_as_a_copy(
    course: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["new", "2"]) == 0
    file = course / "02-sonar-safety" / "mock_sonar.py"
    starter = file.read_text("utf-8")
    file.write_text("mine = 1\n", "utf-8")
    assert main(["new", "02-sonar-safety"]) == 0
    assert file.read_text("utf-8") == starter
    assert file.with_name("mock_sonar.py.1").read_text("utf-8") == "mine = 1\n"
    said = capsys.readouterr().out
    assert "mock_sonar.py.1" in said
    assert f"next: deck {shlex.quote(str(file.parent))}" in said
    # A folder is a profile, with that folder's name.
    profile = load_profile(find_profile(str(file.parent)))
    assert profile.name == "02-sonar-safety"
    assert profile.nodes["sonar_front"].own_file == str(file)


def test_an_empty_node_runs_by_its_own_profile(
    course: Path, capsys: pytest.CaptureFixture[str]
) -> None:
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
