"""Terminals that stall or vanish without a word: the robot stops, and the screen ends by itself."""

from __future__ import annotations

import fcntl
import os
import pty
import signal
import struct
import subprocess
import sys
import termios
from collections.abc import Iterator

import pyte
import pytest

from tests.e2e import marked
from tests.e2e.conftest import ROOT, Deck
from tests.waiting import wait_until

Line = tuple[int, int, "subprocess.Popen[bytes]"]


@pytest.fixture
def line(deck: Deck) -> Iterator[Line]:
    """`deck` on a terminal that is not its controlling one: (own end, program's end, program)."""
    own, program = pty.openpty()
    fcntl.ioctl(own, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 120, 0, 0))
    process = subprocess.Popen(
        [sys.executable, "-m", "tui", "01-hello"],
        stdin=program,
        stdout=program,
        stderr=program,
        cwd=ROOT,
        env={**os.environ, "TERM": "xterm-256color", **deck.env},
        start_new_session=True,
    )
    yield own, program, process
    process.kill()
    process.wait()
    os.close(program)


def read_until(own: int, word: str) -> None:
    """Read what is written until `word` stands on the screen that comes of it."""
    screen = pyte.Screen(120, 40)
    stream = pyte.ByteStream(screen)

    def more() -> bool:
        stream.feed(os.read(own, 65536))
        return word in "\n".join(screen.display)

    wait_until(more, f"{word!r} on the terminal")


def test_a_terminal_that_takes_nothing_keeps_nobody_from_stopping_the_robot(line: Line, deck: Deck) -> None:
    own, program, process = line
    read_until(own, "1/1")
    # What Ctrl+S does, or a line to a host that is gone.
    termios.tcflow(program, termios.TCOOFF)
    process.send_signal(signal.SIGTERM)
    assert process.wait(30) == 128 + signal.SIGTERM
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")
    os.close(own)


def test_a_terminal_that_vanishes_without_a_signal_is_noticed(line: Line, deck: Deck) -> None:
    own, _program, process = line
    read_until(own, "1/1")
    os.close(own)
    assert process.wait(30) == 128 + signal.SIGHUP
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")


def test_interrupting_twice_does_not_wait_for_anybody(line: Line, deck: Deck) -> None:
    own, _program, process = line
    read_until(own, "1/1")
    process.send_signal(signal.SIGINT)
    process.send_signal(signal.SIGINT)
    assert process.wait(30) == 128 + signal.SIGINT
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")
    os.close(own)


def test_leaving_twice_ends_the_screen_of_a_supervisor_that_hangs(line: Line, deck: Deck) -> None:
    own, _program, process = line
    read_until(own, "1/1")
    (supervisor,) = (pid for pid, command in marked.alive(deck.mark).items() if "launcher.supervisor" in command)
    os.kill(supervisor, signal.SIGSTOP)
    os.write(own, b"q")
    read_until(own, "Stopping")
    os.write(own, b"q")
    read_until(own, f"the supervisor (pid {supervisor}) did not answer; it was killed")
    assert process.wait(30) == 0
    wait_until(lambda: not marked.alive(deck.mark), "every process gone")
    os.close(own)


def test_a_screen_that_was_suspended_unasked_gives_the_terminal_back_as_it_was(deck: Deck) -> None:
    terminal = deck.open("01-hello", "--lang", "en")
    terminal.wait_for("1/1")
    held = os.open(f"/proc/{terminal.process.pid}/fd/0", os.O_RDWR | os.O_NOCTTY)
    terminal.process.send_signal(signal.SIGSTOP)
    terminal.process.send_signal(signal.SIGCONT)
    terminal.press("f1")
    terminal.wait_for("Keys of this screen")
    terminal.press("ctrl+q")
    assert terminal.wait_exit() == 0
    usual = termios.ECHO | termios.ICANON | termios.ISIG
    assert termios.tcgetattr(held)[3] & usual == usual
    os.close(held)
