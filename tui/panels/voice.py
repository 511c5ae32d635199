"""The Voice panel: who said what and when, text or sound, and the level of the microphone."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from rich.cells import cell_len

from graph.data import GraphUpdate
from robot.sound import RATE_HZ, SILENCE_DBFS, level_dbfs, samples_of, text_in
from robot.topics import AUDIO_LEVEL, HEARD, MICROPHONE, SPEAKER
from text.figures import whole
from text.i18n import N_, _, decimal, ngettext
from text.plain import plain
from tui.log_view.index import folded
from tui.log_view.rows import clock
from tui.panels.panel import Panel, newest, other_type, row_of, trouble_of
from tui.panels.sonar import EIGHTHS
from tui.widgets.drawing import Drawing, Ink, Line, Placeholder, cells_of, fit

LONGEST_TEXT = 2_000
SHOWN_BYTES = 12
LEAST_PCM = 64
"""In bytes; anything shorter is not audible."""
SLICES = 8
QUIETEST_DB, LOUDEST_DB = -60.0, 0.0
LEVELS = "▁▂▃▄▅▆▇█"


@dataclass(frozen=True)
class Heard:
    """One message: its text, or the duration and loudness of its sound."""

    text: str = ""
    seconds: float = 0.0
    levels: str = ""

    @property
    def is_sound(self) -> bool:
        return bool(self.levels)

    @property
    def words(self) -> str:
        if not self.is_sound:
            return self.text
        return _("PCM {seconds} s {levels}").format(seconds=decimal(f"{self.seconds:.1f}"), levels=self.levels)


def heard(data: bytes, sample_rate_hz: int = RATE_HZ) -> Heard:
    """Read the bytes of a message; any input gives a result that can be shown."""
    if not data:
        return Heard(_("(an empty message)"))
    text = text_in(data)
    if text is not None:
        return Heard(plain(" ".join(text.split()), LONGEST_TEXT))
    if len(data) < LEAST_PCM:
        count = ngettext("{count} byte, not text:", "{count} bytes, not text:", len(data))
        more = "…" if len(data) > SHOWN_BYTES else ""
        return Heard(f"{count.format(count=len(data))} {data[:SHOWN_BYTES].hex(' ')}{more}")
    samples = samples_of(data)
    return Heard("", len(samples) / sample_rate_hz, _levels(samples))


def _levels(samples: NDArray[np.int16]) -> str:
    levels = ""
    for part in np.array_split(samples, SLICES):
        share = 1 - max(QUIETEST_DB, level_dbfs(part.tobytes())) / QUIETEST_DB
        levels += LEVELS[min(len(LEVELS) - 1, int(share * len(LEVELS)))]
    return levels


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

    def __init__(self) -> None:
        super().__init__()
        self.sayings: deque[Saying] = deque(maxlen=KEPT)
        self._dbfs: float | None = None
        self._missing = False

    def hear(self, who: Speaker, data: bytes, time_s: float) -> None:
        """Add a message of bytes with its Unix time: UTF-8 text, 16-bit PCM, or anything else."""
        saying = Saying(who, time_s, heard(data))
        last = next((one for one in reversed(self.sayings) if one.who == who), None)
        in_time = last is not None and abs(time_s - last.time_s) <= SAME_SOUND_S
        if last is not None and in_time and last.what.is_sound and saying.what.is_sound:
            self.sayings.remove(last)
            levels = (last.what.levels + saying.what.levels)[-SLICES:]
            saying = Saying(who, time_s, Heard("", last.what.seconds + saying.what.seconds, levels))
        self.sayings.append(saying)
        self.redraw()

    def show_level(self, dbfs: float | None, *, missing: bool = False) -> None:
        """Show the level of the microphone, None if it is not reported; or that it is `missing`."""
        if (dbfs, missing) != (self._dbfs, self._missing):
            self._dbfs, self._missing = dbfs, missing
            self.redraw()

    @property
    def stale(self) -> bool:
        """Never: past messages do not become outdated."""
        return False

    @property
    def has_value(self) -> bool:
        return bool(self.sayings) or self._dbfs is not None or self._missing

    @property
    def draws(self) -> bool:
        """Whether to draw: the conversation is not hidden by remarks about unreadable messages."""
        return bool(self.sayings) or super().draws

    def draw(self, width: int, height: int) -> list[Line]:
        below = [level_line(self._dbfs, width)] if self._dbfs is not None or self._missing else []
        if not self.sayings:
            return [[Ink(_("nobody has said anything yet"), "muted")], *below][-height:]
        if self._placeholder is not None:
            below[:0] = [[Ink(text, "alert")] for text in folded(self._placeholder.detail, width)]
        talk = self._talk(width, max(1, height - len(below)))
        return [*talk, *below][:height]

    def _talk(self, width: int, height: int) -> list[Line]:
        if height == 1:
            newest = self.sayings[-1]
            lead, room = self._lead(newest, width)
            return [[*lead, Ink(fit(newest.what.words, room).rstrip(), _body(newest.what))]]
        lines: list[Line] = []
        for saying in reversed(self.sayings):
            if len(lines) >= height:
                break
            lines[:0] = self._saying_lines(saying, width, height - len(lines))
        return lines

    def _saying_lines(self, saying: Saying, width: int, most: int) -> list[Line]:
        """Return who said what, in at most so many lines: its end is left out rather than who said it."""
        lead, room = self._lead(saying, width)
        first, *rest = shown = folded(saying.what.words, room)
        if len(shown) > most:
            first, *rest = [*shown[: most - 1], fit(f"{shown[most - 1]} {shown[most]}", room)]
        body = _body(saying.what)
        indent = Ink(" " * (width - room))
        return [[*lead, Ink(first, body)], *([indent, Ink(text, body)] for text in rest)]

    def _lead(self, saying: Saying, width: int) -> tuple[Line, int]:
        names = {"human": _("human"), "robot": _("robot")}
        name = fit(names[saying.who], max(map(cell_len, names.values())))
        when = f"{clock(saying.time_s, 8)} " if width >= WITH_TIME_FROM else ""
        sign, look = ("▸", "accent") if saying.who == "human" else ("◂", "second")
        lead = [Ink(when, "muted"), Ink(f"{sign} {name} ", look)]
        return lead, max(LEAST_TEXT, width - sum(cell_len(ink.text) for ink in lead))


def _body(what: Heard) -> str:
    return "muted" if what.is_sound else ""


TYPE = "std_msgs/msg/ByteMultiArray"
TOPICS: dict[str, Speaker] = {MICROPHONE: "human", SPEAKER: "robot"}
SILENT_S = 2.0
"""A driver that has reported no level for this long has no microphone."""


class VoicePanel(Panel):
    """The conversation so far."""

    view = VoiceView
    title = N_("Voice")
    least = 2
    weight = 3
    across_below = 80

    def __init__(self) -> None:
        super().__init__()
        self._placeholder: dict[str, Placeholder | None] = {}

    def followed(self) -> set[str]:
        return {*TOPICS, HEARD}

    def watched(self) -> set[str]:
        return {AUDIO_LEVEL}

    def show(self, update: GraphUpdate) -> None:
        talk = self.query_one(VoiceView)
        said = [sample for topic in (*TOPICS, HEARD) for sample in update.samples.get(topic, ())]
        for sample in sorted(said, key=lambda one: one.received_s):
            data = sample.value.get("data", b"")
            if sample.topic == HEARD and isinstance(data, str):
                talk.hear("human", data.encode("utf-8", "replace"), sample.received_s)
            elif isinstance(data, bytes):
                talk.hear(TOPICS.get(sample.topic, "human"), data, sample.received_s)
        self._show_level(talk, update)
        placeholder = self._of_another_type(update)
        talk.show_placeholder(placeholder)
        talk.show_trouble(*((None,) if placeholder else trouble_of(update, MICROPHONE)))

    def _of_another_type(self, update: GraphUpdate) -> Placeholder | None:
        for topic in TOPICS:
            if topic in update.samples:
                self._placeholder[topic] = other_type(newest(update, topic), TYPE)
            row, words = row_of(update, topic), self._placeholder.get(topic)
            if row is not None and row.publishers and words is not None:
                return words
        return None

    def _show_level(self, talk: VoiceView, update: GraphUpdate) -> None:
        sample = newest(update, AUDIO_LEVEL)
        dbfs = sample.value.get("data") if sample is not None else None
        if isinstance(dbfs, (int, float)) and math.isfinite(dbfs):
            talk.show_level(float(dbfs))
            return
        teller, microphone = row_of(update, AUDIO_LEVEL), row_of(update, MICROPHONE)
        if teller is not None and teller.publishers:
            if teller.trouble is not None or (teller.age_s or 0.0) > SILENT_S:
                talk.show_level(None, missing=True)
            return
        # The course's own microphone does not report a level.
        there = microphone is not None and microphone.publishers > 0
        talk.show_level(None, missing=not there and bool(talk.sayings))
