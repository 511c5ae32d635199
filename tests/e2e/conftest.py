"""`deck` in a terminal, with directories, a domain and a mark of the test's own."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.e2e import marked
from tests.e2e.terminal import Terminal
from tests.waiting import comes

ROOT = Path(__file__).resolve().parents[2]


@dataclass
class Deck:
    """Starts `deck` in terminals, and knows every process that came of it."""

    mark: str
    env: dict[str, str]
    terminals: list[Terminal]

    def open(self, *args: str, columns: int = 120, rows: int = 40, env: Mapping[str, str] | None = None) -> Terminal:
        """Start `deck ARGS` in a terminal of this size, with `env` besides its own."""
        argv = [sys.executable, "-m", "tui", *args]
        terminal = Terminal(argv, columns, rows, {**self.env, **(env or {})}, cwd=str(ROOT))
        self.terminals.append(terminal)
        return terminal


@pytest.fixture
def deck(ros_domain: int, tmp_path: Path) -> Iterator[Deck]:
    """A `deck` to start; whatever it left is ended, by pid, and makes the test fail."""
    mark = marked.new_mark()
    env = {
        marked.VARIABLE: mark,
        "ROS_DOMAIN_ID": str(ros_domain),
        "XDG_CONFIG_HOME": str(tmp_path / "config"),
        "XDG_STATE_HOME": str(tmp_path / "state"),
        "DECK_COURSE": str(tmp_path / "course"),
        "DECK_LANG": "en",
    }
    # The tour of the first start would cover the list of lessons.
    settings = tmp_path / "config" / "deck" / "settings.json"
    settings.parent.mkdir(parents=True)
    settings.write_text('{"tour": "seen"}')
    started = Deck(mark, env, [])
    yield started
    for terminal in started.terminals:
        terminal.close()
    # A supervisor ends after its screen, and one that was made ready when it has begun.
    comes(lambda: not marked.alive(mark), within_s=20)
    for pid in (left := marked.alive(mark)):
        os.kill(pid, signal.SIGKILL)
    assert not left, f"left running: {left}"
