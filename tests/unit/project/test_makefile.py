"""What the targets of the Makefile run, in a tree whose `deck` only tells how it was called."""

from __future__ import annotations

import os
import pty
import shutil
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.unit.scripts_of_setup import ROOT

DECK = """\
echo "deck $*"
env | grep -E '^(PYTHONPATH|LD_LIBRARY_PATH|_ROS_WHEELS_BOOTSTRAP_COMPLETE)='
exit ${CODE:-0}
"""
PYTHON = """\
case "$1" in
-c) echo "$0" ;;
*preflight.py) exit 0 ;;
*) echo "set-up with $*"; exit 3 ;;
esac
"""


def program(path: Path, text: str) -> Path:
    """Write a shell script that anyone may run."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}")
    path.chmod(0o755)
    return path


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A tree that is set up, in a path with a blank in it."""
    tree = tmp_path / "a tree"
    tree.mkdir()
    for name in ("Makefile", "pyproject.toml"):
        (tree / name).symlink_to(ROOT / name)
    (tree / "scripts").symlink_to(ROOT / "scripts")
    (tree / "interfaces").mkdir()
    (tree / "locked").mkdir()
    program(tree / ".venv/bin/deck", DECK)
    python = program(tree / ".venv/bin/python", PYTHON)
    (tree / ".venv/.ready").write_text(f"{(tree / '.venv').resolve()} {python.resolve()}\n")
    return tree


def plain_environment(**more: str) -> dict[str, str]:
    """Return an environment with nothing in it of the make or the Deck that runs the tests."""
    return {"PATH": os.environ["PATH"], **more}


@pytest.fixture
def make(tree: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run make in the tree with its output in a pipe."""

    def run(*words: str, **environ: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            ["make", *words],
            cwd=tree,
            env=plain_environment(**environ),
            capture_output=True,
            text=True,
            check=False,
        )

    return run


Make = Callable[..., subprocess.CompletedProcess[str]]


def test_without_a_terminal_the_brain_lesson_runs_headless(make: Make) -> None:
    assert make("run").stdout == "deck run 09-brain\n"


def test_profile_and_arguments_narrow_it(make: Make) -> None:
    ran = make("run", "PROFILE=02-sonar-safety", "ARGS=--for 15 --set 'a.b=c d'")
    assert ran.stdout == "deck run 02-sonar-safety --for 15 --set a.b=c d\n"


def test_on_a_terminal_deck_itself_opens(tree: Path) -> None:
    ours, theirs = pty.openpty()
    subprocess.run(["make", "run"], cwd=tree, env=plain_environment(), stdout=theirs, check=True)
    os.close(theirs)
    assert os.read(ours, 100) == b"deck \r\n"
    os.close(ours)


def test_a_failure_of_deck_is_a_failure_of_make(make: Make) -> None:
    assert make("run", CODE="1").returncode != 0


def test_a_sourced_ros_stays_outside(make: Make) -> None:
    ran = make(
        "run",
        AMENT_PREFIX_PATH="/opt/ros/jazzy",
        PYTHONPATH="/opt/ros/jazzy/lib/python3.12/site-packages",
        LD_LIBRARY_PATH="/opt/ros/jazzy/lib",
    )
    assert ran.stdout == "deck run 09-brain\n"


def test_another_environment_of_ros_wheels_stays_outside(make: Make) -> None:
    ran = make("run", _ROS_WHEELS_BOOTSTRAP_COMPLETE="1", LD_LIBRARY_PATH="/other/.venv/lib")
    assert ran.stdout == "deck run 09-brain\n"


def test_settings_of_ones_own_reach_deck(make: Make) -> None:
    assert "PYTHONPATH=/mine" in make("run", PYTHONPATH="/mine").stdout


@pytest.mark.parametrize("changed", ["pyproject.toml", "interfaces/msg/Point.msg"])
def test_a_change_of_what_is_needed_sets_up_again(tree: Path, make: Make, changed: str) -> None:
    path = tree / changed
    path.parent.mkdir(exist_ok=True)
    path.unlink(missing_ok=True)
    path.touch()
    later = time.time() + 60
    os.utime(path, (later, later))
    ran = make("run", f"PYTHON={tree / '.venv/bin/python'}")
    assert ran.stdout == "set-up with scripts/environment.py .venv\n"
    assert ran.returncode != 0


@pytest.mark.parametrize("harm", [".ready", "bin/python"])
def test_a_broken_environment_is_set_up_again(
    tree: Path, tmp_path: Path, make: Make, harm: str
) -> None:
    other = shutil.copy(tree / ".venv/bin/python", tmp_path / "python")
    (tree / ".venv" / harm).unlink()
    ran = make("test", f"PYTHON={other}")
    assert "set-up with scripts/environment.py .venv" in ran.stdout


def test_another_python_is_set_up_again(tree: Path, tmp_path: Path, make: Make) -> None:
    other = shutil.copy(tree / ".venv/bin/python", tmp_path / "python")
    assert make("setup").returncode == 0
    assert "set-up with" in make("setup", f"PYTHON={other}").stdout


def test_clean_removes_what_make_has_made_and_nothing_else(make: Make, tree: Path) -> None:
    rooms = ("bench", "cli", "graph", "launcher", "nodes", "robot", "tests", "text", "tui")
    for room in rooms:
        (tree / room / "__pycache__").mkdir(parents=True)
        (tree / room / "__pycache__" / "a.cpython-311.pyc").touch()
    (tree / "tui" / "__pycache__" / "notes.txt").touch()
    for name in ("build/setup/pip.log", "build/colcon/mine", ".mypy_cache/x"):
        (tree / name).parent.mkdir(parents=True)
        (tree / name).touch()
    assert make("clean").returncode == 0
    left = {str(path.relative_to(tree)) for path in tree.rglob("*") if not path.is_dir()}
    assert {"tui/__pycache__/notes.txt", "build/colcon/mine", "Makefile"} <= left
    assert not [name for name in left if name.endswith(".pyc") or name.startswith(".")]
    assert not (tree / ".venv").exists()
    assert not (tree / "nodes" / "__pycache__").exists()
    assert not (tree / "build" / "setup").exists()


def test_clean_leaves_an_environment_that_somebody_else_has_made(make: Make, tree: Path) -> None:
    (tree / ".venv" / ".ready").unlink()
    said = make("clean")
    assert said.returncode == 0
    assert "is not of this make's making" in said.stdout
    assert (tree / ".venv" / "bin" / "deck").exists()
