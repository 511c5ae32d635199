"""`run` takes shipped and installed modules, and files of the user's own by their path."""

from __future__ import annotations

from pathlib import Path

import pytest

from launcher.profile.load import load_profile
from tests.unit.profile_files import loaded, problems, told, written

NEVER = "raise SystemExit('never imported')"


def test_a_file_stands_relative_to_the_profile_that_names_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And not to one that extends it from another folder, or to the current folder."""
    robot, other = tmp_path / "robot", tmp_path / "other"
    for folder in (robot, other):
        folder.mkdir()
        (folder / "my_sonar.py").write_text(NEVER)
    written(robot, "nodes: {a: {run: ./my_sonar.py}}", "robot.yaml")
    written(other, "extends: ../robot/robot.yaml\nnodes: {b: {run: ../robot/my_sonar.py}}")
    monkeypatch.chdir(other)
    nodes = load_profile("lesson.yaml").nodes
    assert nodes["a"].document.run == nodes["b"].document.run == str(robot / "my_sonar.py")
    assert nodes["a"].command == "./my_sonar.py"
    assert nodes["a"].argv()[-4:] == [
        *(str(robot / "my_sonar.py"), "--ros-args", "-r", "__node:=a")
    ]


def test_a_folder_stands_relative_to_the_profile_that_names_it(tmp_path: Path) -> None:
    """And not to one that extends it: lesson 6 has its RViz settings in a folder beside it."""
    (tmp_path / "mine").mkdir()
    written(tmp_path, "nodes: {a: {exec: [a], cwd: mine}, b: {exec: [b], cwd: mine}}", "robot.yaml")
    other = tmp_path / "other"
    (other / "here").mkdir(parents=True)
    nodes = loaded(other, "extends: ../robot.yaml\nnodes: {b: {cwd: here}}").nodes
    assert nodes["a"].cwd == tmp_path / "mine"
    assert nodes["b"].cwd == other / "here"


def test_a_file_that_is_missing_is_told_with_one_that_may_be_meant(tmp_path: Path) -> None:
    (tmp_path / "my_sonar.py").write_text(NEVER)
    found = told(tmp_path, "nodes:\n  a: {run: ./my_sonr.py}\n  b: {run: ./}\n")
    assert found[0].startswith("2:12: nodes.a.run: there is no file ")
    assert found[0].endswith("my_sonr.py (did you mean ./my_sonar.py?)")
    assert found[1].startswith("3:12: nodes.b.run: there is no file ")


@pytest.mark.parametrize("name", ['"./a\\0.py"', "./" + "x" * 5000])
def test_a_name_that_no_file_can_have_is_a_file_that_is_missing(tmp_path: Path, name: str) -> None:
    (problem,) = problems(tmp_path, f"nodes: {{a: {{run: {name}}}}}")
    assert "there is no file" in problem.message


def test_a_module_beside_the_profile_is_run_by_its_path(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    for name in ("my_node.py", "mine/sonar.py"):
        (tmp_path / name).write_text(NEVER)
    assert told(tmp_path, "nodes:\n  a: {run: my_node}\n  b: {run: mine.sonar}") == [
        (
            "2:12: nodes.a.run: there is no module 'my_node' (for your own file write run:"
            " ./my_node.py)"
        ),
        (
            "3:12: nodes.b.run: there is no module 'mine.sonar' (for your own file write run:"
            " ./mine/sonar.py)"
        ),
    ]


def test_a_module_in_the_current_folder_is_run_by_its_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "lessons").mkdir()
    (tmp_path / "my_node.py").write_text(NEVER)
    monkeypatch.chdir(tmp_path)
    (problem,) = problems(tmp_path / "lessons", "nodes: {a: {run: my_node}}")
    assert problem.hint == "for your own file write run: ../my_node.py"


def test_a_folder_of_the_users_does_not_stand_for_the_shipped_nodes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "nodes").mkdir()
    for name in ("__init__", "hello", "only_here"):
        (tmp_path / "nodes" / f"{name}.py").write_text(NEVER)
    monkeypatch.chdir(tmp_path)
    assert (
        loaded(tmp_path, "nodes: {a: {run: nodes.hello}}").nodes["a"].document.run == "nodes.hello"
    )
    (problem,) = problems(tmp_path, "nodes: {a: {run: nodes.only_here}}")
    assert problem.hint == "for your own file write run: ./nodes/only_here.py"


def test_what_pythonpath_names_is_installed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "my_package").mkdir()
    (tmp_path / "my_package" / "sonar.py").write_text(NEVER)
    monkeypatch.chdir(tmp_path)
    text = "nodes: {a: {run: my_package.sonar}}"
    assert problems(tmp_path, text)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    assert not problems(tmp_path, text)
