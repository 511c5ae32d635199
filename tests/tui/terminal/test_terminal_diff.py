"""What is spared on the way to the terminal: less is sent, and the same is seen."""

from __future__ import annotations

import random

import pyte
import pytest
from rich.cells import set_cell_size

from tui.terminal.terminal_diff import TerminalDiff

WIDTH, HEIGHT = 40, 8
STYLES = (
    "",
    "38;2;10;20;30;48;2;1;2;3",
    "1;38;2;10;20;30;48;2;1;2;3",
    "7;38;5;3",
    "31",
    "4;48;5;7",
)
WORDS = ("Distance 1.29 m", "Путь свободен", "●▶█▄⠶", "   ", "x")
ODD_WORDS = ("日本", "🧠", "plain")


class Terminal:
    """What a real terminal makes of what it is sent."""

    def __init__(self) -> None:
        self.screen = pyte.Screen(WIDTH, HEIGHT)
        self.stream = pyte.Stream(self.screen)

    def shows_after(self, sent: str) -> list[list[tuple[str, ...]]]:
        """Return every cell with its look."""
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
    diff, plain, spared = TerminalDiff(), Terminal(), Terminal()
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


def test_after_the_other_screen_everything_is_sent_anew() -> None:
    diff = TerminalDiff()
    diff.forget(WIDTH, HEIGHT)
    frame = frame_of([(0, 0, "", "Distance 1.29 m")])
    diff.changes(frame)
    diff.changes("\x1b[?1049h")
    assert "Distance" in diff.changes(frame)
