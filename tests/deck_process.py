"""Deck as a process of its own, its output read as it comes."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import psutil

from tests.middleware_words import own_words
from tests.waiting import DEADLINE_S, wait_until
from tests.warm_program import WarmProgram


class DeckProcess:
    """`deck ARGUMENTS` without a terminal; `within` is what its command begins with.

    It is forked from a process that has its modules; `within` something it is started by Python.
    """

    def __init__(self, *arguments: str, cwd: Path | None = None, within: tuple[str, ...] = ()) -> None:
        self.process: WarmProgram | subprocess.Popen[str]
        if within:
            self.process = subprocess.Popen(
                [*within, sys.executable, "-m", "tui", *arguments],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                encoding="utf-8",
                cwd=cwd,
            )
        else:
            folder = str(cwd or Path.cwd())
            self.process = WarmProgram(("tui", *arguments), cwd=folder, env=os.environ)
        self.lines: list[str] = []
        self.errors: list[str] = []
        self._readers = [
            threading.Thread(target=self._read, args=pair, daemon=True)
            for pair in ((self.process.stdout, self.lines), (self.process.stderr, self.errors))
        ]
        for reader in self._readers:
            reader.start()

    def _read(self, stream: Any, lines: list[str]) -> None:
        with stream:
            for line in filter(own_words, stream):
                lines.append(line.rstrip("\n"))  # noqa: PERF401 - read while it grows

    def said(self, text: str, within_s: float = DEADLINE_S) -> str:
        """Wait for a line that contains `text`; return it."""
        return wait_until(
            lambda: next((line for line in self.lines if text in line), ""),
            lambda: f"{text!r} in {self.lines[-30:]}, {self.errors[-30:]}",
            within_s,
        )

    def signal(self, number: signal.Signals) -> None:
        self.process.send_signal(number)

    def finish(self, within_s: float = DEADLINE_S) -> int:
        """Wait for its end; return its exit code."""
        code = self.process.wait(within_s)
        for reader in self._readers:
            reader.join(within_s)
        return code

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.finish()

    def events(self) -> list[dict[str, Any]]:
        """Return its output as JSON objects."""
        return [json.loads(line) for line in self.lines]


def deck(*arguments: str, cwd: Path | None = None) -> DeckProcess:
    process = DeckProcess(*arguments, cwd=cwd)
    try:
        process.finish()
    finally:
        process.close()
    return process


def alive(pid: int) -> bool:
    """Whether a process runs, zombies not counted."""
    try:
        return psutil.Process(pid).status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False
