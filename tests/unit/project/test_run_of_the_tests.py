"""`make test`: what fails in the crowd runs once more, alone; what fails twice is a failure."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

from tests.run import MOST

ROOT = Path(__file__).resolve().parents[3]
RUN = "import sys; from tests.run import main; sys.exit(main(sys.argv[1:]))"
CONFTEST = """
from tests.distribution import EachTestOnce

def pytest_xdist_make_scheduler(config, log):
    return EachTestOnce(config, log)
"""
PASSES = "def test_passes(): pass\n"
FAILS = "def test_fails(): assert 1 == 2, 'always'\n"
FAILS_ONCE = """
import os, pathlib, pytest

def is_first(name):
    mark = pathlib.Path(name)
    return not mark.exists() and mark.touch() is None
"""
UNSTEADY = f"{FAILS_ONCE}\ndef test_unsteady(): assert not is_first('call'), 'the first time'\n"
DIES = f"{FAILS_ONCE}\ndef test_dies(): is_first('death') and os._exit(1)\n"
SET_UP = f"""{FAILS_ONCE}
@pytest.fixture
def shaky(): assert not is_first('set-up'), 'too early'

def test_set_up(shaky): pass
"""
MANY = "import pytest\n\n@pytest.mark.parametrize('n', range({}))\n" + FAILS.replace("()", "(n)")


def run_of(folder: Path, *bodies: str) -> subprocess.CompletedProcess[str]:
    """Run files with these bodies as `make test` does."""
    (folder / "conftest.py").write_text(CONFTEST)
    for number, body in enumerate(bodies):
        (folder / f"test_{number}.py").write_text(body)
    return subprocess.run(
        [sys.executable, "-c", RUN, "-q", "-n", "2", "."],
        env={
            **os.environ,
            "PYTHONPATH": str(ROOT),
            "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",
            "PYTEST_PLUGINS": "xdist.plugin",
        },
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def test_what_passes_is_green_and_says_what_it_cost(tmp_path: Path) -> None:
    ran = run_of(tmp_path, PASSES)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert re.fullmatch(r"passed: 0 unsteady, \d+ s, \d+ core-seconds", ran.stdout.splitlines()[-1])
    assert not (tmp_path / "build").exists()


def test_what_passes_alone_is_named_and_stops_nothing(tmp_path: Path) -> None:
    ran = run_of(tmp_path, PASSES, UNSTEADY, DIES, SET_UP)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    *others, last = ran.stdout.splitlines()
    assert last.startswith("passed: 3 unsteady")
    told = (tmp_path / "build/unsteady.txt").read_text().splitlines()
    assert others[-3:] == told
    assert {line.partition(" 'gw")[0] for line in told} == {
        "test_1.py::test_unsteady: call: AssertionError: the first time",
        "test_2.py::test_dies: ???: worker",
        "test_3.py::test_set_up: setup: AssertionError: too early",
    }


def test_what_fails_alone_too_is_a_failure(tmp_path: Path) -> None:
    ran = run_of(tmp_path, FAILS, UNSTEADY)
    assert ran.returncode == 1
    assert ran.stdout.splitlines()[-1].startswith("FAILED: 1 unsteady")
    assert "test_fails" not in (tmp_path / "build/unsteady.txt").read_text()


def test_more_failures_than_can_be_chance_are_not_tried_again(tmp_path: Path) -> None:
    ran = run_of(tmp_path, MANY.format(MOST + 1))
    assert ran.returncode == 1
    assert "once more" not in ran.stdout
    assert ran.stdout.count("short test summary") == 1


def test_what_cannot_be_collected_is_a_failure(tmp_path: Path) -> None:
    ran = run_of(tmp_path, PASSES, "import nothing_like_this\n")
    assert ran.returncode != 0
    assert "ERROR test_1.py" in ran.stdout
