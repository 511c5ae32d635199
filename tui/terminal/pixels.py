"""True pixels: whether the terminal has them, as it says itself, and pictures in its language.

Of `textual-image` the encoders alone are used. Its widgets read the terminal's answers from standard
input, past the thread that looks for the stop key; write past the driver, which then knows neither
what the cells show nor how many bytes that took; and encode while the event loop waits.

A picture has a character of its own, which no terminal gets: a widget puts it into each cell of the
picture, and `terminal_diff` knows from the cells where the picture is, and what covers it.
"""

from __future__ import annotations

import asyncio
import re
from dataclasses import dataclass, field
from itertools import cycle
from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakValueDictionary

from textual.message import Message

from tui import clock

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray


KITTY_QUESTION = "\x1b_Gi=1,s=1,v=1,a=q,t=d,f=24;AAAA\x1b\\"
"""Source: sw.kovidgoyal.net/kitty/graphics-protocol, "Querying support"."""
QUESTIONS = "\x1b[16t\x1b[?1;3;256S\x1b[?2;1;0S\x1b[c"
"""The size of a cell, 256 colours for sixels, their greatest size, and what it is able to: every
terminal answers that, and last. Source: xterm, ctlseqs."""
KITTY_ERASE_ALL = "\x1b_Ga=d,d=A,q=2\x1b\\"
_ABLE = re.compile(r"\x1b\[\?([\d;]*)c")
_KITTY = re.compile(r"\x1b_Gi=1;OK\x1b\\")
_CELL = re.compile(r"\x1b\[6;(\d+);(\d+)t")
_COLOURS = re.compile(r"\x1b\[\?1;0;(\d+)S")
_LARGEST = re.compile(r"\x1b\[\?2;0;(\d+);(\d+)S")
_ANSWER = re.compile(r"\x1b\[\?[\d;]*[cS]|\x1b\[6;\d+;\d+t|\x1b_G[^\x1b]*\x1b\\")
_BEGINNING = re.compile(r"\x1b(\[(\?[\d;]*|6[\d;]*)?|_(G[^\x1b]{0,200}\x1b?)?)?")
_DEFINED = re.compile(r"#(\d+);2;\d+;\d+;\d+")
ANSWERED_WITHIN_S = 60.0
"""What comes later is no answer: a slow line is, another program may have read it."""
PIECES_WITHIN_S = 0.1
"""As long as Textual waits for the rest of a sequence."""
SIXEL, FEWEST_COLOURS, MOST_COLOURS = "4", 64, 256
"""With fewer colours, half-blocks look better: they have them all."""
MOST_BYTES = 500_000
"""Of one picture: half of what may wait for the terminal."""
MOST_S = 5.0
"""Of the line that one picture may take if it has a limit: half of the greatest debt."""
MOST_FOR_KITTY = 300_000
"""Pixels, which it takes losslessly."""
FIRST, LAST = 0x100000, 0x10FFFD
"""The characters of pictures: for private use, and so in no text that comes from outside."""
PICTURE = re.compile(f"[{chr(FIRST)}-{chr(LAST)}]+")


def are_wanted(wish: str, limit: int) -> bool:
    """Whether to ask for pixels, with this limit in bytes a second, 0 for none: one picture is some 100 kB."""
    return wish == "on" or (wish != "off" and not limit)


def in_multiplexer(env: Mapping[str, str]) -> bool:
    """Whether this is tmux or screen, also at the other end of SSH: they take kitty's question for a title."""
    return bool(env.get("TMUX") or env.get("STY") or env.get("TERM", "").startswith(("tmux", "screen")))


class GraphicsChanged(Message, bubble=False):
    """The terminal has pixels now, or no more, or other cells: what shows pictures makes them anew."""


def most_bytes(limit: int) -> int:
    """Return how large a picture may be with this limit in bytes a second, 0 for none."""
    return min(MOST_BYTES, round(MOST_S * limit)) if limit else MOST_BYTES


class Graphics(NamedTuple):
    """What a terminal understands."""

    protocol: str
    """`sixel` or `kitty`."""
    cell: tuple[int, int]
    """Width and height in pixels."""
    colours: int = MOST_COLOURS
    largest: tuple[int, int] = (10_000, 10_000)
    """Width and height of a picture in pixels."""


def graphics_of(said: str, cell: tuple[int, int] = (0, 0)) -> Graphics | None:
    """Return what a terminal understands that has answered this; None if it has no pixels.

    `cell` is the size of a cell that the system knows: xterm does not tell it. Konsole and WezTerm
    have both protocols: sixels go by themselves where text is written.
    """
    if found := _CELL.search(said):
        cell = int(found[2]), int(found[1])
    able = _ABLE.search(said)
    if able is None or 0 in cell:
        return None
    if SIXEL in able[1].split(";")[1:]:
        colours, largest = _COLOURS.search(said), _LARGEST.search(said)
        graphics = Graphics("sixel", cell, MOST_COLOURS if colours is None else min(int(colours[1]), MOST_COLOURS))
        if largest is not None:
            graphics = graphics._replace(largest=(int(largest[1]), int(largest[2])))
        return graphics if graphics.colours >= FEWEST_COLOURS else None
    return Graphics("kitty", cell) if _KITTY.search(said) else None


@dataclass(eq=False)
class PixelPicture:
    """A picture as the terminal takes it."""

    char: str
    draw: str
    """What draws it with its upper left corner in the cell of the cursor."""
    erase: str
    """What takes it away; empty where any text does."""
    halves: NDArray[np.uint8]
    """The same in half-blocks, shape (twice the rows, columns, 3): where something covers a part."""


@dataclass
class Pixels:
    """What one terminal has answered, and the pictures on it."""

    wanted: bool = False
    """Whether to ask at all."""
    graphics: Graphics | None = None
    most_bytes: int = MOST_BYTES
    pictures: WeakValueDictionary[str, PixelPicture] = field(default_factory=WeakValueDictionary)
    """Those that somebody shows, by character."""
    _cell: tuple[int, int] = (0, 0)
    _answers: str = ""
    _held: str = ""
    """What may become an answer."""
    _asked_s: float = 0.0
    _questions: int = 0
    """Those asked so far; each is answered by itself, and with several open only the last answer ends it."""
    _answered: int = 0
    """Written by the thread that reads keys alone, as `_questions` by that which asks."""
    _fed_s: float = 0.0
    _chars: cycle[int] = field(default_factory=lambda: cycle(range(FIRST, LAST + 1)))

    def asked(self, cell: tuple[int, int] = (0, 0)) -> None:
        """Expect answers, from now on, of a terminal with cells of this size as the system knows.

        If they may have another size than before, there are no pixels until it has answered.
        """
        if 0 in cell or cell != self._cell:
            self.graphics = None
        self._cell, self._asked_s = cell, clock.steady()
        self._questions += 1

    def sift(self, typed: str) -> str:
        """Return what was typed without the terminal's answers, which may come in pieces.

        Without anything typed, what has been held for long enough.
        """
        now_s = clock.steady()
        late = not typed and now_s - self._fed_s > PIECES_WITHIN_S
        if now_s - self._asked_s > ANSWERED_WITHIN_S:
            self._answers, self._answered = "", self._questions
        if late or self._answered == self._questions:
            held, self._held = self._held, ""
            return held + typed
        keys: list[str] = []
        for char in typed:
            self._held += char
            if _ANSWER.fullmatch(self._held):
                self._take(self._held)
                self._held = ""
            elif not _BEGINNING.fullmatch(self._held):
                begun = self._held[-1] == "\x1b"
                keys.append(self._held[:-1] if begun else self._held)
                self._held = "\x1b" if begun else ""
        self._fed_s = now_s if typed else self._fed_s
        return "".join(keys)

    def _take(self, answer: str) -> None:
        self._answers += answer
        if _ABLE.fullmatch(answer):
            self.graphics = graphics_of(self._answers, self._cell)
            self._answers, self._answered = "", min(self._answered + 1, self._questions)

    async def made(self, rgb: NDArray[np.uint8], halves: NDArray[np.uint8]) -> PixelPicture | None:
        """Return a picture for the cells that `halves` takes, made on another thread.

        None if it is too large, or the terminal has changed meanwhile.
        """
        graphics, char = self.graphics, chr(next(self._chars))
        if graphics is None:
            return None
        cells = halves.shape[1], len(halves) // 2
        draw, erase = await asyncio.to_thread(encoded, rgb, cells, char, graphics)
        picture = PixelPicture(char, draw, erase, halves)
        self.pictures[char] = picture
        return picture if len(draw) <= self.most_bytes and graphics == self.graphics else None


def encoded(rgb: NDArray[np.uint8], cells: tuple[int, int], char: str, graphics: Graphics) -> tuple[str, str]:
    """Return what draws a picture on all of so many columns and rows, and what erases it; takes some 40 ms."""
    from PIL import Image
    from textual_image._pixeldata import PixelData
    from textual_image._sixel import SixelOptions, image_to_sixels

    wide, high = cells[0] * graphics.cell[0], cells[1] * graphics.cell[1]
    if graphics.protocol == "kitty":
        # It enlarges pictures itself.
        smaller = min(1.0, rgb.shape[1] / wide, (MOST_FOR_KITTY / (wide * high)) ** 0.5)
        wide, high = max(1, round(wide * smaller)), max(1, round(high * smaller))
    # A copy is contiguous: a BGR picture is the view of another one.
    page = Image.fromarray(rgb.copy()).resize((wide, high), Image.Resampling.BILINEAR)
    if graphics.protocol == "kitty":
        number = ord(char) - FIRST + 1
        draw = _for_kitty(PixelData(page).to_base64(), number, cells)
        erase = f"\x1b_Ga=d,d=I,i={number},q=2\x1b\\"
    else:
        # To define a colour is to choose it, for the library, but not for xterm.
        draw, erase = _DEFINED.sub(r"\g<0>#\1", image_to_sixels(page, SixelOptions(graphics.colours))), ""
    return draw, erase


def _for_kitty(png: str, number: int, cells: tuple[int, int]) -> str:
    """Return the picture in pieces, the first of which says what to do with it."""
    head, size = f"a=T,f=100,i={number},p=1,c={cells[0]},r={cells[1]},C=1,q=2,", 4096
    return "".join(
        f"\x1b_G{head if not at else ''}m={int(at + size < len(png))};{png[at : at + size]}\x1b\\"
        for at in range(0, len(png), size)
    )
