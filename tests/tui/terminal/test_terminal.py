"""The terminal as it is: slow, stalled, gone; and what is printed past the screen."""

from __future__ import annotations

import contextlib
import os
import pty
import select
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.waiting import wait_until
from tui.terminal.bandwidth import Bandwidth
from tui.terminal.output import MOST_WAITING, Terminal
from tui.terminal.stray_output import StrayOutput


@pytest.fixture
def line() -> Iterator[tuple[int, int]]:
    """A terminal that nobody reads yet: (its own end, the program's end)."""
    own, program = pty.openpty()
    yield own, program
    for fd in (own, program):
        with contextlib.suppress(OSError):
            os.close(fd)


def read_all(fd: int, until: str) -> str:
    text = ""

    def more() -> bool:
        nonlocal text
        text += os.read(fd, 65536).decode("utf-8", "replace")
        return until in text

    wait_until(more, f"{until!r} written")
    return text


def test_a_stalled_terminal_never_makes_the_writer_wait(line: tuple[int, int]) -> None:
    own, program = line
    caught_up = threading.Event()
    terminal = Terminal(program, caught_up.set)
    frame = "x" * 10_000
    # From here on the terminal takes nothing: there is no more room in it.
    terminal.write(10 * frame)
    wait_until(lambda: not select.select([], [program], [], 0)[1], "the terminal full")

    def flood() -> None:
        for number in range(3 * MOST_WAITING // len(frame)):
            terminal.write(f"{number}{frame}\n")

    writer = threading.Thread(target=flood, daemon=True)
    writer.start()
    writer.join(20)
    assert not writer.is_alive()
    assert not caught_up.is_set()

    reading = threading.Event()

    def drain() -> None:
        while not reading.is_set():
            if select.select([own], [], [], 0.05)[0]:
                os.read(own, 65536)

    reader = threading.Thread(target=drain, daemon=True)
    reader.start()
    try:
        assert caught_up.wait(20), "nobody was told that the terminal takes again"
    finally:
        reading.set()
        reader.join(10)


def test_it_is_behind_until_the_terminal_has_taken_all(line: tuple[int, int]) -> None:
    own, program = line
    bandwidth = Bandwidth(40_000)
    terminal = Terminal(program, lambda: None, bandwidth)
    terminal.write("x" * 100_000 + "end")
    wait_until(lambda: not select.select([], [program], [], 0)[1], "the terminal full")
    assert bandwidth.behind
    assert bandwidth.wait_s() > 1
    read_all(own, "end")
    wait_until(lambda: not bandwidth.behind, "all taken")


def test_leaving_a_stalled_terminal_is_bounded(line: tuple[int, int]) -> None:
    _own, program = line
    terminal = Terminal(program, lambda: None)
    terminal.write("x" * (2 * MOST_WAITING))
    terminal.leaving = True
    terminal.write("\x1b[?1049l")
    leaving = threading.Thread(target=terminal.finish, daemon=True)
    leaving.start()
    leaving.join(10)
    assert not leaving.is_alive()


def test_a_terminal_that_has_gone_is_noticed_and_writing_goes_on_without_a_word(
    line: tuple[int, int],
) -> None:
    own, program = line
    terminal = Terminal(program, lambda: None)
    os.close(own)

    def gone() -> bool:
        terminal.write("x")
        return terminal.gone

    wait_until(gone, "the hang-up noticed")
    terminal.write("still no error")
    terminal.finish()


def test_stray_output_goes_to_its_file_and_can_be_read_line_by_line(tmp_path: Path) -> None:
    path = tmp_path / "screen.log"
    with StrayOutput(path) as stray:
        os.write(2, b"[RTPS] no shared memory\n")
        os.write(1, "и строка\n\n".encode())
        assert stray.new_lines() == ["[RTPS] no shared memory", "и строка"]
        assert stray.new_lines() == []
        os.write(2, b"\xff\x1b[31mred\n")
        assert stray.new_lines() == ["\ufffd\x1b[31mred"]
    assert path.exists()


def test_the_descriptors_are_given_back_and_an_empty_file_is_removed(tmp_path: Path) -> None:
    path = tmp_path / "screen.log"
    before = [os.fstat(fd).st_ino for fd in (1, 2)]
    with StrayOutput(path) as stray:
        assert os.fstat(stray.terminal_fd).st_ino == before[0]
        assert os.fstat(2).st_ino == path.stat().st_ino
    assert [os.fstat(fd).st_ino for fd in (1, 2)] == before
    assert not path.exists()
    assert sys.__stderr__ is not None


def test_a_flood_past_the_screen_neither_fills_the_disk_nor_memory(tmp_path: Path) -> None:
    path = tmp_path / "screen.log"
    with StrayOutput(path) as stray:
        for _round in range(60):
            os.write(2, b"y" * 99_999 + b"\n")
        assert sum(map(len, stray.new_lines())) < 100_000
        assert path.stat().st_size == 0
        os.write(2, b"after\n")
        assert stray.new_lines() == ["after"]
