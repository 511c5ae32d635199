"""A program that reads the arguments of ROS as its own is told how to leave them out."""

from __future__ import annotations

import runpy
import subprocess
import sys
from pathlib import Path

import pytest

from launcher.faults.explain import explained
from launcher.faults.ros_arguments import refused_arguments

ARGPARSE = """\
import argparse
parser = argparse.ArgumentParser()
{argument}
parser.parse_args()
"""
OF_ROS = ("--ros-args", "-r", "__node:=arg")


def printed_by(file: Path, text: str) -> list[str]:
    """Run a program as Deck runs a node; return what it has printed."""
    file.write_text(text)
    ended = subprocess.run(
        [sys.executable, "-I", file, *OF_ROS], capture_output=True, text=True, check=False
    )
    assert ended.returncode != 0
    return (ended.stdout + ended.stderr).splitlines()


@pytest.mark.parametrize(
    "argument",
    [
        'parser.add_argument("seconds", type=int)',
        'parser.add_argument("side", choices=("left", "right"))',
        'parser.add_argument("--rate", type=float)',
    ],
)
def test_a_parser_that_refuses_them(tmp_path: Path, argument: str) -> None:
    file = tmp_path / "arg.py"
    lines = printed_by(file, ARGPARSE.format(argument=argument))
    fault = refused_arguments(lines, str(file))
    assert fault is not None
    assert (fault.kind, fault.line, fault.source_line) == ("crash", 4, "parser.parse_args()")
    assert "arg.py: error:" in fault.exception
    assert "rclpy.utilities.remove_ros_args(sys.argv)[1:]" in fault.meaning


@pytest.mark.parametrize(
    "text", ["import sys\nx = int(sys.argv[1])\n", "import sys\nopen(sys.argv[3])\n"]
)
def test_a_program_that_reads_them_itself(
    tmp_path: Path, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "arg.py"
    file.write_text(text)
    monkeypatch.setattr(sys, "argv", [str(file), *OF_ROS])
    with pytest.raises((ValueError, OSError)) as raised:
        runpy.run_path(str(file))
    fault = explained(raised.value, str(tmp_path))
    assert fault.line == 2
    assert "after --ros-args" in fault.meaning


def test_other_refusals_are_the_programs_own() -> None:
    assert refused_arguments(["arg.py: error: argument -x: no such thing"], "/x/arg.py") is None
    assert refused_arguments(["[INFO] started with --ros-args"], "/x/arg.py") is None
