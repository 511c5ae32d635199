"""The conversation between human and robot: who said what and when, the newest at the bottom.

Below it is the level of the microphone.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Literal

from rich.cells import cell_len

from robot.sound import SILENCE_DBFS
from text.figures import whole
from text.i18n import _
from tui.log_view.index import folded
from tui.log_view.rows import clock
from tui.panels.sonar.bar import EIGHTHS
from tui.panels.voice.reading import Heard, heard
from tui.widgets.drawing import Drawing, Ink, Line, cells_of, fit

QUIETEST_DB, LOUDEST_DB = -60.0, 0.0
"""Ends of the bar."""
FAINT_DB, LOUD_DB, CUT_DB = -50.0, -12.0, -4.0
"""Below: barely a sound; from here on: loud; so loud that samples are clipped."""
LEAST_BAR = 6
WITH_NAME_FROM = 30


def level_line(dbfs: float | None, width: int) -> Line:
    """The level in dB below full scale, in this many cells; None: there is no microphone."""
    if dbfs is None:
        return [Ink(fit(_("no microphone"), width).rstrip(), "alert")]
    number, look = _number(dbfs), _look(dbfs)
    # The bar must not move when the number gets shorter.
    aside = 1 + cell_len(_number(SILENCE_DBFS))
    lead = [Ink(_("microphone") + " ", "muted")] if width >= WITH_NAME_FROM else []
    room = width - aside - cells_of(lead)
    if room < LEAST_BAR:
        return [Ink(fit(number, width).rstrip(), look)]
    # In this order nan counts as the quietest.
    heard_db = min(LOUDEST_DB, max(QUIETEST_DB, dbfs))
    share = (heard_db - QUIETEST_DB) / (LOUDEST_DB - QUIETEST_DB)
    full, part = divmod(round(8 * room * share), 8)
    filled = "█" * full + (EIGHTHS[part] if part else "")
    rest = "·" * (room - len(filled)) + " " * (aside - cell_len(number))
    return [*lead, Ink(filled, look), Ink(rest, "muted"), Ink(number, look)]


def _number(dbfs: float) -> str:
    return _("{level} dB").format(level=whole(dbfs))


def _look(dbfs: float) -> str:
    if dbfs >= CUT_DB:
        return "bad"
    if dbfs >= LOUD_DB:
        return "warn"
    return "good" if dbfs >= FAINT_DB else "muted"


Speaker = Literal["human", "robot"]
KEPT = 200
SAME_SOUND_S = 1.0
"""Pieces of sound that follow each other within this time are one sound."""
WITH_TIME_FROM = 36
LEAST_TEXT = 8


@dataclass(frozen=True)
class Saying:
    """Something that was said."""

    who: Speaker
    time_s: float
    what: Heard


class VoiceView(Drawing):
    """Shows messages from the microphone (`human`) and to the loudspeaker (`robot`)."""

    def __init__(self, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._sayings: deque[Saying] = deque(maxlen=KEPT)
        self._dbfs: float | None = None
        self._missing = False

    def hear(self, who: Speaker, data: bytes, time_s: float) -> None:
        """Add a message of bytes with its Unix time: UTF-8 text, 16-bit PCM, or anything else."""
        saying = Saying(who, time_s, heard(data))
        last = next((one for one in reversed(self._sayings) if one.who == who), None)
        if last is not None and _one_sound(last, saying):
            self._sayings.remove(last)
            saying = Saying(who, time_s, last.what.and_then(saying.what))
        self._sayings.append(saying)
        self.redraw()

    def show_level(self, dbfs: float | None, *, missing: bool = False) -> None:
        """Show the level of the microphone, None if it is not reported; or that it is `missing`."""
        if (dbfs, missing) != (self._dbfs, self._missing):
            self._dbfs, self._missing = dbfs, missing
            self.redraw()

    def clear(self) -> None:
        """Remove everything that was said."""
        self._sayings.clear()
        self._dbfs, self._missing = None, False
        self.refresh()

    @property
    def stale(self) -> bool:
        """Never: past messages do not become outdated."""
        return False

    @property
    def has_value(self) -> bool:
        return bool(self._sayings) or self._dbfs is not None or self._missing

    @property
    def has_talk(self) -> bool:
        return bool(self._sayings)

    @property
    def draws(self) -> bool:
        """Whether to draw: the conversation is not hidden by remarks about unreadable messages."""
        return self.has_talk or super().draws

    def draw(self, width: int, height: int) -> list[Line]:
        """Draw as many of the newest messages as fit, and the level."""
        below = [level_line(self._dbfs, width)] if self._tells_level else []
        if not self._sayings:
            return [[Ink(_("nobody has said anything yet"), "muted")], *below][-height:]
        if self._placeholder is not None:
            below[:0] = [[Ink(text, "alert")] for text in folded(self._placeholder.detail, width)]
        talk = self._talk(width, max(1, height - len(below)))
        return [*talk, *below][:height]

    @property
    def _tells_level(self) -> bool:
        return self._dbfs is not None or self._missing

    def _talk(self, width: int, height: int) -> list[Line]:
        if height == 1:
            newest = self._sayings[-1]
            lead, room = self._lead(newest, width)
            return [[*lead, Ink(fit(newest.what.words, room).rstrip(), _body(newest.what))]]
        lines: list[Line] = []
        for saying in reversed(self._sayings):
            lines[:0] = self._saying_lines(saying, width)
            if len(lines) >= height:
                return lines[-height:]
        return lines

    def _saying_lines(self, saying: Saying, width: int) -> list[Line]:
        lead, room = self._lead(saying, width)
        first, *rest = folded(saying.what.words, room)
        body = _body(saying.what)
        indent = Ink(" " * (width - room))
        return [[*lead, Ink(first, body)], *([indent, Ink(text, body)] for text in rest)]

    def _lead(self, saying: Saying, width: int) -> tuple[Line, int]:
        """Speaker and time, and the cells that are left for the text."""
        names = {"human": _("human"), "robot": _("robot")}
        name = fit(names[saying.who], max(map(cell_len, names.values())))
        when = f"{clock(saying.time_s, 8)} " if width >= WITH_TIME_FROM else ""
        sign, look = ("▸", "accent") if saying.who == "human" else ("◂", "second")
        lead = [Ink(when, "muted"), Ink(f"{sign} {name} ", look)]
        return lead, max(LEAST_TEXT, width - sum(cell_len(ink.text) for ink in lead))


def _body(what: Heard) -> str:
    return "muted" if what.is_sound else ""


def _one_sound(last: Saying, saying: Saying) -> bool:
    both = last.what.is_sound and saying.what.is_sound
    return both and abs(saying.time_s - last.time_s) <= SAME_SOUND_S
