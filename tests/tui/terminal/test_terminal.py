"""The terminal as it is: slow, stalled, gone; and what is printed past the screen."""

from __future__ import annotations

import contextlib
import os
import pty
import random
import select
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pyte
import pytest
from rich.cells import set_cell_size

from tests.waiting import wait_until
from tui.terminal.output import MOST_WAITING, Terminal
from tui.terminal.pixels import FIRST, KITTY_ERASE_ALL, PixelPicture
from tui.terminal.stray_output import StrayOutput
from tui.terminal.terminal_diff import TerminalDiff


@pytest.fixture
def line() -> Iterator[tuple[int, int]]:
    """A terminal that nobody reads yet: (its own end, the program's end)."""
    own, program = pty.openpty()
    yield own, program
    for fd in (own, program):
        with contextlib.suppress(OSError):
            os.close(fd)


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


def test_pictures_that_stayed_after_a_stall_are_erased_before_anything_else(line: tuple[int, int]) -> None:
    own, program = line
    caught_up = threading.Event()
    picture = PixelPicture(chr(FIRST), "<drawn>", "<erased>", np.zeros((2, 2, 3), np.uint8))
    terminal = Terminal(program, caught_up.set, pictures={picture.char: picture})
    terminal.write(f"\x1b[1;1H{picture.char * 2}")
    terminal.write(" " * (2 * MOST_WAITING))
    read = b""

    def took(what: bytes) -> bool:
        nonlocal read
        while select.select([own], [], [], 0.05)[0]:
            read += os.read(own, 65536)
        return what in read

    wait_until(lambda: took(b"") and caught_up.is_set(), "the terminal caught up")
    terminal.write("after")
    wait_until(lambda: took(b"after"), "what is written next")
    assert KITTY_ERASE_ALL.encode() in read
    assert read.index(KITTY_ERASE_ALL.encode()) < read.index(b"after")
    terminal.write("\x1b[2;1Hmore")
    wait_until(lambda: took(b"more"), "what is written then")
    assert read.count(KITTY_ERASE_ALL.encode()) == 1


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


def test_a_terminal_that_has_gone_is_noticed_and_writing_goes_on_without_a_word(line: tuple[int, int]) -> None:
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


WIDTH, HEIGHT = 40, 8
STYLES = ("", "38;2;10;20;30;48;2;1;2;3", "1;38;2;10;20;30;48;2;1;2;3", "7;38;5;3", "31", "4;48;5;7")
WORDS = ("Distance 1.29 m", "Путь свободен", "●▶█▄⠶", "   ", "x")
ODD_WORDS = ("日本", "🧠", "plain")


class Shown:
    """What a real terminal makes of what it is sent."""

    def __init__(self) -> None:
        self.screen = pyte.Screen(WIDTH, HEIGHT)
        self.stream = pyte.Stream(self.screen)

    def shows_after(self, sent: str) -> list[list[tuple[str, ...]]]:
        self.stream.feed(sent)
        rows: list[list[tuple[str, ...]]] = []
        for y in range(HEIGHT):
            cells = (self.screen.buffer[y][x] for x in range(WIDTH))
            rows.append([(c.data, c.fg, c.bg, str(c.bold), str(c.reverse)) for c in cells])
        return rows


def frame_of(pieces: list[tuple[int, int, str, str]]) -> str:
    """Write (column, row, style, text) as Textual does: row by row, each piece with its style."""
    rows: dict[int, str] = {}
    for x, y, style, text in sorted(pieces, key=lambda piece: piece[1]):
        drawn = f"\x1b[{style}m{text}\x1b[0m" if style else text
        rows[y] = rows.get(y, "") + f"\x1b[{y + 1};{x + 1}H{drawn}"
    return "\n".join(rows.values()) + "\x1b[1;1H"


def random_frame(chance: random.Random) -> str:
    """Pieces anywhere; a row with characters that may be wide is written as a whole."""
    pieces = []
    for _piece in range(chance.randrange(1, 8)):
        x, style = chance.randrange(WIDTH - 20), chance.choice(STYLES)
        pieces.append((x, chance.randrange(2, HEIGHT), style, chance.choice(WORDS)))
    for y in range(2):
        odd = chance.choice(ODD_WORDS)
        words = "".join((chance.choice(WORDS), odd, " " * WIDTH))
        pieces.append((0, y, chance.choice(STYLES), set_cell_size(words, WIDTH)))
    return frame_of(pieces)


@pytest.mark.parametrize("seed", range(30))
def test_a_terminal_shows_the_same_as_without_sparing(seed: int) -> None:
    chance = random.Random(seed)
    diff, plain, spared = TerminalDiff(), Shown(), Shown()
    diff.forget(WIDTH, HEIGHT)
    for _frame in range(12):
        frame = random_frame(chance)
        assert spared.shows_after(diff.changes(frame)) == plain.shows_after(frame)


def test_of_a_line_that_changes_only_the_new_cells_are_sent() -> None:
    diff = TerminalDiff()
    diff.forget(WIDTH, HEIGHT)
    diff.changes(frame_of([(0, 0, STYLES[1], "Distance 1.29 m")]))
    sent = diff.changes(frame_of([(0, 0, STYLES[1], "Distance 1.37 m")]))
    assert "37" in sent
    assert "Distance" not in sent
