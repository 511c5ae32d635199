"""A picture in a real pseudo-terminal: in sixels where it says that it has them, else in half-blocks."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.e2e.terminal import Terminal
from tests.waiting import wait_until

ROOT = Path(__file__).resolve().parents[3]
SIXELS, HALF = b"\x1bP0;0;0q", "▀".encode()
ANSWERS = "\x1b[6;20;10t", "\x1b[?1;0;256S", "\x1b[?2;0;1000;1000S", "\x1b[?63;1;2;4;6;9;15;16;22;28c"


@pytest.fixture
def told(tmp_path: Path) -> Path:
    return tmp_path / "told"


@pytest.fixture
def terminal(told: Path) -> Iterator[Terminal]:
    argv = [sys.executable, "-m", "tests.tui.terminal.picture_app", str(told)]
    terminal = Terminal(argv, 60, 20, cwd=str(ROOT))
    yield terminal
    terminal.close()


def sent(terminal: Terminal, what: bytes, after: int = 0) -> None:
    wait_until(lambda: what in terminal.kept[after:], lambda: f"{what!r} in {bytes(terminal.kept[after:])!r}")


def test_a_terminal_that_has_sixels_gets_them_and_no_key_is_lost_among_its_answers(
    terminal: Terminal, told: Path
) -> None:
    sent(terminal, b"\x1b[c")
    wait_until(lambda: "ready" in told.read_text(), "the first picture")
    terminal.type(f"a{ANSWERS[0]} {ANSWERS[1]}b{''.join(ANSWERS[2:])}p")
    sent(terminal, SIXELS)
    wait_until(lambda: "key p" in told.read_text(), "the last key")
    lines = told.read_text().split("\n")
    assert [line for line in lines if line.startswith("key")] == ["key a", "key b", "key p"]
    assert "stop" in lines
    assert "unread" not in told.read_text()
    sent(terminal, b";2;0;0;98")
    before = len(terminal.kept)
    terminal.type("w")
    sent(terminal, b"no picture", before)
    assert SIXELS not in terminal.kept[before:]
    terminal.type("q")
    assert terminal.wait_exit() == 0


def test_a_picture_that_is_there_already_becomes_one_in_pixels_with_the_answer(terminal: Terminal) -> None:
    sent(terminal, HALF)
    terminal.type("".join(ANSWERS))
    sent(terminal, SIXELS)


def test_where_nothing_answers_a_picture_is_in_half_blocks(terminal: Terminal) -> None:
    sent(terminal, HALF)
    terminal.type("p")
    sent(terminal, b"48;2;0;0;24", terminal.kept.index(HALF))
    assert SIXELS not in terminal.kept
