"""What lies in the current folder is not taken for a part of Deck, of ROS or of a library."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.middleware_words import own_words

pytestmark = pytest.mark.nightly

PLANTED = (
    *("nodes/__init__.py", "nodes/hello.py", "nodes/parts/runner.py", "launcher/__init__.py"),
    *("launcher/supervisor/__main__.py", "rclpy/__init__.py", "std_msgs/__init__.py", "tui/app.py"),
    *("graph/__init__.py", "numpy.py", "yaml.py", "json.py", "psutil.py", "sitecustomize.py"),
    *("usercustomize.py", "cli/main.py", "text/__init__.py", "robot/__init__.py", "runpy.py"),
    "cv2.py",
)
SCRIPT = [str(Path(sys.executable).with_name("deck"))]
MODULES = [[sys.executable, "-m", "tui"], [sys.executable, "-m", "deck"]]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with modules that tell when they are run."""
    folder = tmp_path / "downloads"
    for name in PLANTED:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"open({str(tmp_path / 'taken')!r}, 'a').write(__file__ + '\\n')\n")
    return folder


def deck(folder: Path, command: list[str], *words: str, **environ: str) -> str:
    """Run `deck` there to its end; return what it has written."""
    done = subprocess.run(
        [*command, *words],
        cwd=folder,
        env={**os.environ, **environ},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    return own_words(done.stdout)


def taken(folder: Path) -> str:
    path = folder.parent / "taken"
    return path.read_text() if path.exists() else ""


@pytest.mark.parametrize("command", [SCRIPT, *MODULES])
@pytest.mark.parametrize("words", [("check", "01-hello"), ("list",), ("doctor",), ("ps",)])
def test_no_command_takes_what_lies_in_the_current_folder(
    folder: Path, command: list[str], words: tuple[str, ...]
) -> None:
    if command in MODULES:
        # Python itself looks for the package `tui` there, and is asked to; before 3.11 for runpy, too.
        shutil.rmtree(folder / "tui")
        if sys.version_info < (3, 11):
            (folder / "runpy.py").unlink()
    deck(folder, command, *words)
    assert taken(folder) == ""
