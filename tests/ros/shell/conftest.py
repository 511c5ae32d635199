"""A home, and command lines in `deck shell`."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.middleware_words import own_words

WITHIN_S = 150
"""Others may be testing on the same machine."""
DECK = (sys.executable, "-m", "tui", "shell")
Run = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    home = tmp_path / "home"
    home.mkdir()
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.setenv("SHELL", "/bin/bash")
    return home


@pytest.fixture
def run(home: Path, ros_domain: int) -> Run:
    """Run a command line in `deck shell -c`, in the user's home."""

    def run(line: str, **more: str) -> subprocess.CompletedProcess[str]:
        done = subprocess.run(
            [*DECK, "-c", line],
            cwd=home,
            env={**os.environ, **more, "ROS_DOMAIN_ID": str(ros_domain)},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
        )
        done.stdout, done.stderr = own_words(done.stdout), own_words(done.stderr)
        return done

    return run
