"""Deck's cv_bridge is there for a learner's file, and gives way to that of a ROS."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from launcher import node_program

PROGRAM = str(Path(node_program.__file__))
FILE = "import cv_bridge\nprint(cv_bridge.__file__)\n"
HOW = {"python": (sys.executable,), "under Deck": (sys.executable, PROGRAM)}


def place_of_cv_bridge(how: str, folder: Path, **environ: str) -> str:
    (folder / "mine.py").write_text(FILE)
    done = subprocess.run(
        [*HOW[how], str(folder / "mine.py")],
        cwd=folder,
        env=os.environ | environ,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
        timeout=60,
    )
    return done.stdout.strip()


@pytest.mark.parametrize("how", HOW)
def test_a_file_in_any_folder_can_import_it(how: str, tmp_path: Path) -> None:
    assert place_of_cv_bridge(how, tmp_path).endswith("bridges/cv_bridge/__init__.py")


@pytest.mark.parametrize("how", HOW)
def test_that_of_a_ros_comes_first(how: str, tmp_path: Path) -> None:
    ros = tmp_path / "ros"
    (ros / "cv_bridge").mkdir(parents=True)
    (ros / "cv_bridge" / "__init__.py").touch()
    found = place_of_cv_bridge(how, tmp_path, PYTHONPATH=str(ros))
    assert found == str(ros / "cv_bridge" / "__init__.py")
