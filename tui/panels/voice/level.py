"""How loud the microphone is, as a line of ink: a bar and a number, or that there is none."""

from __future__ import annotations

from rich.cells import cell_len

from robot.sound import SILENCE_DBFS
from text.figures import whole
from text.i18n import _
from tui.panels.sonar.bar import EIGHTHS
from tui.widgets.drawing import Ink, Line, cells_of, fit

QUIETEST_DB, LOUDEST_DB = -60.0, 0.0
"""Ends of the bar."""
FAINT_DB, LOUD_DB, CUT_DB = -50.0, -12.0, -4.0
"""Below: hardly a sound; from here on: loud; so loud that samples are cut off."""
LEAST_BAR = 6
WITH_NAME_FROM = 30


def level_line(dbfs: float | None, width: int) -> Line:
    """The level in dB below full scale in so many cells; None: there is no microphone."""
    if dbfs is None:
        return [Ink(fit(_("no microphone"), width).rstrip(), "alert")]
    number, look = _number(dbfs), _look(dbfs)
    # The bar does not move when the number gets shorter.
    aside = 1 + cell_len(_number(SILENCE_DBFS))
    lead = [Ink(_("microphone") + " ", "muted")] if width >= WITH_NAME_FROM else []
    room = width - aside - cells_of(lead)
    if room < LEAST_BAR:
        return [Ink(fit(number, width).rstrip(), look)]
    # In this order not a number counts as the quietest.
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
