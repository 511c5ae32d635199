"""A run of the tests: what dies, fails or is to be alone, and the domains that tests get."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.machine import MARK
from tests.run import MOST

ROOT = Path(__file__).resolve().parents[3]
CONFTEST = """
from tests.distribution import EachTestOnce

EachTestOnce.alone = ("test_3_three.py", "test_4_last.py")

def pytest_xdist_make_scheduler(config, log):
    return EachTestOnce(config, log)
"""
DISTRIBUTED = (
    "-p", "xdist", "-n", "3", "--dist", "loadfile", "--no-loadscope-reorder", "-p",
    "no:cacheprovider",
)  # fmt: skip
NAMES = ("first", "one", "two", "three", "last")
DIES = "    import os; os._exit(1)\n"
PASSES = "    pass\n"


def run_of(folder: Path, files: dict[str, list[str]]) -> subprocess.CompletedProcess[str]:
    (folder / "conftest.py").write_text(CONFTEST)
    for number, (name, bodies) in enumerate(files.items()):
        tests = (f"def test_{at}():\n{body}" for at, body in enumerate(bodies))
        (folder / f"test_{number}_{name}.py").write_text("".join(tests))
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-q", *DISTRIBUTED, str(folder)],
        env={**os.environ, "PYTHONPATH": str(ROOT), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize(("file", "at"), [("first", 0), ("three", 3)])
def test_a_test_that_ends_its_process_fails_once_and_the_others_run_once(tmp_path: Path, file: str, at: int) -> None:
    files = {name: [DIES if (name, number) == (file, at) else PASSES for number in range(4)] for name in NAMES}
    ran = run_of(tmp_path, files)
    assert ran.returncode == 1, ran.stdout + ran.stderr
    assert "1 failed, 19 passed" in ran.stdout


RUN = "import sys; from tests.run import main; sys.exit(main(sys.argv[1:]))"
CONFTEST_OF_A_RUN = """
from tests.distribution import EachTestOnce

def pytest_xdist_make_scheduler(config, log):
    return EachTestOnce(config, log)
"""
PASSING = "def test_passes(): pass\n"
FAILS = "def test_fails(): assert 1 == 2, 'always'\n"
FAILS_ONCE = """
import os, pathlib, pytest

def is_first(name):
    mark = pathlib.Path(name)
    return not mark.exists() and mark.touch() is None
"""
UNSTEADY = f"{FAILS_ONCE}\ndef test_unsteady(): assert not is_first('call'), 'the first time'\n"
DYING = f"{FAILS_ONCE}\ndef test_dies(): is_first('death') and os._exit(1)\n"
SET_UP = f"""{FAILS_ONCE}
@pytest.fixture
def shaky(): assert not is_first('set-up'), 'too early'

def test_set_up(shaky): pass
"""
MANY = "import pytest\n\n@pytest.mark.parametrize('n', range({}))\n" + FAILS.replace("()", "(n)")


def made_run_of(folder: Path, *bodies: str) -> subprocess.CompletedProcess[str]:
    (folder / "conftest.py").write_text(CONFTEST_OF_A_RUN)
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
        check=False,
    )


def test_what_passes_is_green_and_says_what_it_cost(tmp_path: Path) -> None:
    ran = made_run_of(tmp_path, PASSING)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert re.fullmatch(r"passed: 0 unsteady, \d+ s, \d+ core-seconds", ran.stdout.splitlines()[-1])
    assert not (tmp_path / "build").exists()


def test_what_passes_alone_is_named_and_stops_nothing(tmp_path: Path) -> None:
    ran = made_run_of(tmp_path, PASSING, UNSTEADY, DYING, SET_UP)
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
    ran = made_run_of(tmp_path, FAILS, UNSTEADY)
    assert ran.returncode == 1
    assert ran.stdout.splitlines()[-1].startswith("FAILED: 1 unsteady")
    assert "test_fails" not in (tmp_path / "build/unsteady.txt").read_text()


def test_more_failures_than_can_be_chance_are_not_tried_again(tmp_path: Path) -> None:
    ran = made_run_of(tmp_path, MANY.format(MOST + 1))
    assert ran.returncode == 1
    assert "once more" not in ran.stdout
    assert ran.stdout.count("short test summary") == 1


def test_what_cannot_be_collected_is_a_failure(tmp_path: Path) -> None:
    ran = made_run_of(tmp_path, PASSING, "import nothing_like_this\n")
    assert ran.returncode != 0
    assert "ERROR test_1.py" in ran.stdout


TESTS = Path(__file__).resolve().parents[2]
MORE = re.compile(
    r"^from tests\.(?:namespaces|own_numbers|browser) import"
    r'|"(?:unshare|nsenter)",|subprocess\.\w+\(\s*\["(?:ip|ps)"',
    re.MULTILINE,
)


def test_whoever_asks_more_of_a_machine_says_so() -> None:
    asking = {path: path.read_text(encoding="utf-8") for path in TESTS.rglob("test_*.py")}
    silent = [path.name for path, text in asking.items() if MORE.search(text) and f"mark.{MARK}(" not in text]
    assert silent == []


LEFT_OUT = re.compile(r"\b(pytest\.(skip|xfail|importorskip)|mark\.(skip|skipif|xfail))\b")


def test_no_test_is_left_out_on_any_machine() -> None:
    sources = {path: path.read_text(encoding="utf-8") for path in TESTS.rglob("*.py")}
    assert [path.name for path, text in sources.items() if LEFT_OUT.search(text)] == []
