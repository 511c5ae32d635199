"""Frames for the terminal without what it already shows, because SSH is a slow line.

Textual redraws whole regions, and gives every piece of text its full style and a reset. Here the
cells that the terminal shows are remembered, and only cells that differ are sent, with only the
changes of their style. Sequences that are not fully understood are sent unchanged, and the cells
they may affect are forgotten.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from rich.cells import cell_len

from tui.terminal.pixels import FIRST, KITTY_ERASE_ALL, LAST, PICTURE, PixelPicture

if TYPE_CHECKING:
    from collections.abc import Mapping

_TOKENS = re.compile(
    rf"\x1b\[(?P<place>[\d;]*)H|\x1b\[(?P<sgr>[\d;]*)m|(?P<picture>{PICTURE.pattern})"
    rf"|(?P<text>[^\x00-\x1f\x7f{chr(FIRST)}-{chr(LAST)}]+)|(?P<line>\n)"
    r"|(?P<other>\x1b\[[?>=<]?[\d;]*[ $]?[@-~]|\x1b[^\[]|.)",
    re.DOTALL,
)
_NO_CELLS = re.compile(r"\x1b\[\?2026[hl]|\x1b[]_][^\x07\x1b]*(?:\x07|\x1b\\)")
"""What touches none: where a frame begins and ends, and strings, as for the clipboard."""
_ODD = re.compile(r"\x1b\]|\x1b\[(?:[0-3]?[JK]|\d*[ABCDEFGSTLMPXd])")
"""Sequences after which the remembered cells may differ from those shown."""
_PLAIN_RANGES = (
    (0x20, 0x7E),
    (0xA0, 0xAC),
    (0xAE, 0x2FF),
    (0x370, 0x3FF),
    (0x400, 0x482),
    (0x48A, 0x52F),
    (0x2010, 0x2027),
    (0x2030, 0x205E),
    (0x2190, 0x22FF),
    (0x2500, 0x2595),
    (0x2598, 0x259F),
    (0x25A0, 0x25A0),
    (0x25B2, 0x25B8),
    (0x25BC, 0x25C2),
    (0x25C6, 0x25D7),
    (0x26A0, 0x26A0),
    (0x2713, 0x2713),
    (0x2717, 0x2718),
    (0x2800, 0x28FF),
)
_PLAIN = frozenset(chr(code) for first, last in _PLAIN_RANGES for code in range(first, last + 1))
"""Characters that take one cell on every terminal."""


class ScreenCell(NamedTuple):
    """The content of one cell: a character and its SGR parameters."""

    char: str
    sgr: str


class Look(NamedTuple):
    """SGR parameters, parsed."""

    attributes: tuple[str, ...]
    foreground: str
    background: str


class TerminalDiff:
    """Knows what the terminal shows; `changes` returns what has to be sent to update it."""

    def __init__(self, pictures: Mapping[str, PixelPicture] | None = None) -> None:
        """Draw `pictures` in pixels where all cells have their character."""
        self._pictures = {} if pictures is None else pictures
        self._claimed: dict[str, None] = {}
        """Characters of pictures that this frame has put into cells."""
        self._drawn: dict[str, PixelPicture] = {}
        """Those that the terminal shows in pixels."""
        self._places: dict[tuple[int, ...], tuple[int, int]] = {}
        """Column and row where one of this shape was last seen whole: the next one is there, too."""
        self.erase_all = ""
        """What takes away every picture ever drawn; empty if any text does."""
        self._width = self._height = 0
        self._rows: list[list[ScreenCell | None]] = []
        self._at: tuple[int, int] | None = None
        """Column and row of the terminal's cursor, None if unknown."""
        self._sgr: str | None = None
        """The terminal's style, None if unknown."""
        self._out: list[str] = []

    def forget(self, width: int, height: int) -> None:
        """Forget the content of a terminal, which has this size."""
        self._width, self._height = width, height
        self._rows = [[None] * width for _row in range(height)]
        self._at = self._sgr = None

    def changes(self, frame: str) -> str:
        """Return the shortest output that makes the terminal show `frame`."""
        if _NO_CELLS.fullmatch(frame):
            return frame
        if _ODD.search(frame):
            self.forget(self._width, self._height)
            return frame
        self._out = []
        x = y = 0
        sgr = ""
        moved = False
        for token in _TOKENS.finditer(frame):
            kind, value = token.lastgroup, token.group()
            moved = kind == "place"
            if kind == "text":
                x = self._text(x, y, value, sgr)
            elif kind == "picture":
                x = self._claim(x, y, value)
            elif kind == "sgr":
                sgr = _joined(sgr, token["sgr"])
            elif kind == "place":
                x, y = _place(token["place"])
            elif kind == "line":
                x, y = 0, y + 1
            else:
                self._other(value)
        self._draw_pictures()
        if moved and self._out:
            self._go(x, y)
        return "".join(self._out)

    def _other(self, sequence: str) -> None:
        """Pass on what does not draw; modes are changed in the terminal's default style."""
        if self._sgr != "":
            self._out.append("\x1b[0m")
            self._sgr = ""
        if "1049" in sequence:
            self._out += [picture.erase for picture in self._drawn.values()]
            self._drawn.clear()
        self._out.append(sequence)
        if "1049" in sequence or sequence == "\x1bc":
            self.forget(self._width, self._height)

    def _text(self, x: int, y: int, text: str, sgr: str) -> int:
        """Send the cells of `text` that differ; return the column after it."""
        if not (0 <= y < self._height and _PLAIN.issuperset(text) and x + len(text) <= self._width):
            return self._unsure(x, y, text, sgr)
        row = self._rows[y]
        first = -1
        for at, char in enumerate(text, x):
            cell = ScreenCell(char, sgr)
            if row[at] == cell:
                if first >= 0:
                    self._send(first, y, text[first - x : at - x], sgr)
                    first = -1
            else:
                row[at] = cell
                if first < 0:
                    first = at
        if first >= 0:
            self._send(first, y, text[first - x :], sgr)
        return x + len(text)

    def _claim(self, x: int, y: int, text: str) -> int:
        """Give cells to pictures, in whatever style: a dialog above them dims it."""
        if 0 <= y < self._height:
            row = self._rows[y]
            for at, char in enumerate(text[: max(0, self._width - x)], x):
                cell = ScreenCell(char, "")
                if row[at] != cell:
                    row[at] = cell
                    self._claimed[char] = None
        return x + len(text)

    def _draw_pictures(self) -> None:
        """Draw each picture whose cells have changed: in half-blocks if something covers a part of it.

        The newest first, so that nothing shows through between two.
        """
        for char in {**self._claimed, **dict.fromkeys(self._drawn)}:
            picture, cell = self._pictures.get(char) or self._drawn.get(char), ScreenCell(char, "")
            rows = [y for y, row in enumerate(self._rows) if cell in row]
            if picture is not None and self._is_whole(picture, cell, rows):
                if char in self._claimed:
                    self._go(*self._places[picture.halves.shape])
                    self._out.append(picture.draw)
                    self.erase_all = KITTY_ERASE_ALL if picture.erase else ""
                    self._at = self._sgr = None
                    self._drawn[char] = picture
                continue
            was = self._drawn.pop(char, None)
            if was is not None:
                self._out.append(was.erase)
            if picture is not None and (was is not None or char in self._claimed):
                self._draw_halves(picture, cell, rows)
        self._claimed.clear()

    def _is_whole(self, picture: PixelPicture, cell: ScreenCell, rows: list[int]) -> bool:
        """Whether it has all its cells, and may be drawn: in the last row, sixels would scroll the screen."""
        high, wide = len(picture.halves) // 2, picture.halves.shape[1]
        if len(rows) != high or rows[-1] - rows[0] + 1 != high or rows[-1] >= self._height - 1:
            return False
        left = self._rows[rows[0]].index(cell)
        if any(self._rows[y][left : left + wide] != [cell] * wide for y in rows):
            return False
        self._places[picture.halves.shape] = left, rows[0]
        return True

    def _draw_halves(self, picture: PixelPicture, cell: ScreenCell, rows: list[int]) -> None:
        # One that has never been whole begins where something of it is seen.
        seen = min((self._rows[y].index(cell) for y in rows), default=0), min(rows, default=0)
        left, top = self._places.get(picture.halves.shape, seen)
        high, wide = len(picture.halves) // 2, picture.halves.shape[1]
        for y in range(max(top, 0), min(top + high, self._height)):
            for x in range(max(left, 0), min(left + wide, self._width)):
                if self._rows[y][x] == cell:
                    upper, lower = picture.halves[2 * (y - top) : 2 * (y - top) + 2, x - left].tolist()
                    self._send(x, y, "▀", "38;2;{};{};{};48;2;{};{};{}".format(*upper, *lower))

    def _unsure(self, x: int, y: int, text: str, sgr: str) -> int:
        """Send text whose width is uncertain, and forget its cells, but not whose picture the others show."""
        self._go(x, y)
        self._wear(sgr)
        self._out.append(text)
        self._at = None
        if 0 <= y < self._height:
            row, end = self._rows[y], x + cell_len(text)
            for at in range(max(0, x - 1), self._width):
                cell = row[at]
                if cell is not None and PICTURE.fullmatch(cell.char) and not x <= at < end:
                    self._claimed[cell.char] = None
                else:
                    row[at] = None
        return x + cell_len(text)

    def _send(self, x: int, y: int, text: str, sgr: str) -> None:
        self._go(x, y)
        self._wear(sgr)
        self._out.append(text)
        end = x + len(text)
        # After the last column, terminals differ in the position of the cursor.
        self._at = (end, y) if end < self._width else None

    def _go(self, x: int, y: int) -> None:
        if self._at == (x, y):
            return
        if self._at is not None and self._at[1] == y and self._at[0] < x:
            gap = x - self._at[0]
            self._out.append(f"\x1b[{gap if gap > 1 else ''}C")
        else:
            self._out.append(f"\x1b[{y + 1};{x + 1}H")
        self._at = (x, y)

    def _wear(self, sgr: str) -> None:
        if sgr != self._sgr:
            self._out.append(_change(self._sgr, sgr))
            self._sgr = sgr


def _place(parameters: str) -> tuple[int, int]:
    row, _, column = parameters.partition(";")
    return int(column or 1) - 1, int(row or 1) - 1


def _joined(before: str, parameters: str) -> str:
    if parameters in {"", "0"}:
        return ""
    return f"{before};{parameters}" if before else parameters


@lru_cache(4096)
def _change(before: str | None, after: str) -> str:
    """Return the shortest sequence from one style to the other."""
    whole = f"\x1b[0;{after}m" if after else "\x1b[0m"
    if before is None:
        return whole
    old, new = _look(before), _look(after)
    if old.attributes != new.attributes:
        return whole
    parts = []
    if old.foreground != new.foreground:
        parts.append(new.foreground or "39")
    if old.background != new.background:
        parts.append(new.background or "49")
    if not parts:
        return ""
    change = f"\x1b[{';'.join(parts)}m"
    return min(change, whole, key=len)


@lru_cache(4096)
def _look(sgr: str) -> Look:
    parts = sgr.split(";") if sgr else []
    attributes: list[str] = []
    foreground = background = ""
    at = 0
    while at < len(parts):
        code = parts[at]
        if code in {"38", "48"} and at + 1 < len(parts):
            taken = 5 if parts[at + 1] == "2" else 3
            colour = ";".join(parts[at : at + taken])
            foreground, background = (colour, background) if code == "38" else (foreground, colour)
            at += taken
            continue
        number = int(code or 0)
        if 30 <= number <= 37 or 90 <= number <= 97:
            foreground = code
        elif 40 <= number <= 47 or 100 <= number <= 107:
            background = code
        else:
            attributes.append(code)
        at += 1
    return Look(tuple(attributes), foreground, background)
