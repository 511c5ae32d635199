"""A run of the tests: what dies fails once and the others go on, and what is to be alone is."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.distribution import ALONE

ROOT = Path(__file__).resolve().parents[3]
CONFTEST = """
from tests.distribution import EachTestOnce

EachTestOnce.alone = ("test_3_three.py", "test_4_last.py")

def pytest_xdist_make_scheduler(config, log):
    return EachTestOnce(config, log)
"""
DISTRIBUTED = (
    "-p",
    "xdist",
    "-n",
    "3",
    "--dist",
    "loadfile",
    "--no-loadscope-reorder",
    "-p",
    "no:cacheprovider",
)
NAMES = ("first", "one", "two", "three", "last")
DIES = "    import os; os._exit(1)\n"
PASSES = "    pass\n"
LOOKS_ROUND = """    import os, pathlib, time
    me = pathlib.Path("running", str(os.getpid()))
    me.touch()
    end_s = time.monotonic() + 0.3
    while not (met := len(os.listdir("running")) > 1) and time.monotonic() < end_s:
        time.sleep(0.01)
    with open("met" if met else "unmet", "a") as file:
        print(pathlib.Path(__file__).stem, file=file)
    me.unlink()
"""
"""Writes down whether it has met another test."""


def run_of(folder: Path, files: dict[str, list[str]]) -> subprocess.CompletedProcess[str]:
    """Run files with tests of these bodies, by three processes."""
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
        timeout=120,
        check=False,
    )


@pytest.mark.parametrize(("file", "at"), [("first", 0), ("two", 3), ("three", 3), ("last", 3)])
def test_a_test_that_ends_its_process_fails_once_and_the_others_run_once(
    tmp_path: Path, file: str, at: int
) -> None:
    files = {
        name: [DIES if (name, number) == (file, at) else PASSES for number in range(4)]
        for name in NAMES
    }
    ran = run_of(tmp_path, files)
    assert ran.returncode == 1, ran.stdout + ran.stderr
    assert "1 failed, 19 passed" in ran.stdout


def test_what_is_to_run_alone_does_and_the_others_do_not(tmp_path: Path) -> None:
    (tmp_path / "running").mkdir()
    ran = run_of(tmp_path, {name: [LOOKS_ROUND] * 4 for name in NAMES})
    assert "20 passed" in ran.stdout, ran.stdout
    met = set((tmp_path / "met").read_text().split())
    assert met
    assert not met & {"test_3_three", "test_4_last"}


def test_what_is_to_run_alone_exists() -> None:
    assert [name for name in ALONE if not (ROOT / name).is_file()] == []
