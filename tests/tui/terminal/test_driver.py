"""Deck's driver on real pseudo-terminals: signals, stalls, the end of the terminal, and stops."""

from __future__ import annotations

import fcntl
import os
import pty
import select
import signal
import struct
import subprocess
import sys
import termios
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.waiting import comes, wait_until

ROOT = Path(__file__).resolve().parents[3]
PASTE, END = b"\x1b[200~", b"\x1b[201~"
ENDED_WITHIN_S = 10.0
"""The promise is 2 s, on a machine that is not busy."""


class Stuck:
    """The app in a terminal: `own` is the terminal's end, `program` keeps the other one open."""

    def __init__(self, how: str, file: Path) -> None:
        self.own, self.program = pty.openpty()
        fcntl.ioctl(self.own, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 120, 0, 0))
        self._file = file
        self._reading = threading.Event()
        self._closed = False
        self.process = subprocess.Popen(
            [sys.executable, "-m", "tests.tui.terminal.stuck_app", how, str(file)],
            stdin=self.program,
            stdout=self.program,
            cwd=ROOT,
            env={**os.environ, "TERM": "xterm-256color"},
            start_new_session=True,
        )
        self.read()
        self.wait_for("ready")

    def read(self) -> None:
        self._reading.clear()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def type(self, data: bytes) -> None:
        os.write(self.own, data)

    def told(self) -> list[str]:
        return self._file.read_text().split("\n")[:-1] if self._file.exists() else []

    def wait_for(self, line: str, times: int = 1) -> None:
        wait_until(lambda: self.told().count(line) >= times, lambda: f"{line}: {self.told()}")

    def wait_for_a_key(self) -> None:
        """Press a key until it is seen: while the terminal is taken over, keys are thrown away."""

        def seen() -> bool:
            self.type(b"k")
            return comes(lambda: "key k" in self.told(), within_s=4)

        wait_until(seen, lambda: f"a key seen: {self.told()}")

    def hang_up(self) -> None:
        if not self._closed:
            self._closed = True
            self._reading.set()
            self._reader.join()
            os.close(self.own)

    def cpu_s(self) -> float:
        """Return how much processor time it has taken."""
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        self.hang_up()
        os.close(self.program)

    def _read(self) -> None:
        while not self._reading.is_set():
            if select.select([self.own], [], [], 0.05)[0]:
                os.read(self.own, 65536)


@pytest.fixture
def stuck(tmp_path: Path) -> Iterator[Callable[[str], Stuck]]:
    """Start the app that hangs in this way."""
    started: list[Stuck] = []

    def start(how: str) -> Stuck:
        started.append(Stuck(how, tmp_path / "told"))
        return started[-1]

    yield start
    for each in started:
        each.close()


@pytest.mark.parametrize("how", ["lock", "write", "rest"])
def test_whatever_the_main_thread_does_it_does_not_outlive_its_terminal(
    stuck: Callable[[str], Stuck], how: str
) -> None:
    app = stuck(how)
    if how != "rest":
        app.type(b"h")
        app.wait_for("key h")
    app.hang_up()
    assert app.process.wait(ENDED_WITHIN_S) == 128 + signal.SIGHUP
    assert "lost" in app.told()


def test_no_thread_spins_at_the_end_of_input(stuck: Callable[[str], Stuck]) -> None:
    app = stuck("outlive")
    app.hang_up()
    app.wait_for("lost")
    before_s, began_s = app.cpu_s(), time.monotonic()
    time.sleep(3)  # The claim is about a time.
    assert app.cpu_s() - before_s < 0.1 * (time.monotonic() - began_s)
    assert app.process.poll() is None


def test_suspended_by_the_user_it_comes_back(stuck: Callable[[str], Stuck]) -> None:
    app = stuck("rest")
    app.process.send_signal(signal.SIGTSTP)
    state = Path(f"/proc/{app.process.pid}/stat")
    wait_until(lambda: ") T " in state.read_text(), "stopped")
    app.process.send_signal(signal.SIGCONT)
    app.wait_for_a_key()


@pytest.mark.parametrize(("how", "key"), [("lock", b" "), ("busy", b"\x18"), ("write", b"\x1b[32u")])
def test_a_stop_is_told_while_the_main_thread_hangs(stuck: Callable[[str], Stuck], how: str, key: bytes) -> None:
    app = stuck(how)
    app.type(b"h")
    app.wait_for("key h")
    app.type(1000 * b"\x1b[A" + key)
    app.wait_for("stop")


@pytest.mark.parametrize("begun", [PASTE + b"words", b"\x1b]0;words"])
def test_nothing_unfinished_keeps_stops_or_keys_for_ever(stuck: Callable[[str], Stuck], begun: bytes) -> None:
    app = stuck("rest")
    app.type(begun + b" ")
    app.wait_for("stop")
    app.wait_for_a_key()


def test_a_whole_paste_is_no_stop_and_a_key_that_has_stopped_is_not_told_twice(stuck: Callable[[str], Stuck]) -> None:
    app = stuck("rest")
    app.type(PASTE + b"a b\x18" + END + b"k")
    app.wait_for("key k")
    assert "stop" not in app.told()
    app.type(b"a b")
    app.wait_for("key b")
    assert sorted(app.told()[-3:]) == ["key a", "key b", "stop"]
    assert "key space" not in app.told()


def test_the_stop_of_another_layout_stops_and_what_is_no_key_is_told_once(stuck: Callable[[str], Stuck]) -> None:
    app = stuck("rest")
    app.type(b"\x1b[1095::120;5u")
    app.wait_for("stop")
    app.type(b"\x1b[1114112u\x1b[55296u\x1b[1095;5:1u")
    app.wait_for("stop", 2)
    app.type(b"k")
    app.wait_for("key k")
    assert [line for line in app.told() if line.startswith("unread")] == ["unread '\\x1b[55296u'"]


def test_if_the_keys_cannot_be_read_any_more_it_is_told(stuck: Callable[[str], Stuck]) -> None:
    app = stuck("blind")
    app.type(b"b")
    app.wait_for("keyboard lost: RuntimeError('b')")
