"""The chains of steps as rows of a table: when, after the step before, who, and what was said."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from robot.topics import AI_COMMAND, LLM_RAW_JSON, MICROPHONE
from text.figures import figure
from text.i18n import N_, _, ngettext
from tui.flow.chains import Lane, StepKind
from tui.outcome import words as outcome_words
from tui.outcome.model_usage import usage_words
from tui.widgets.rows import Cell, Column, Row

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from tui.flow.chains import Chain, FlowStep

LANES: dict[Lane, str] = {
    Lane.MIC: N_("mic"),
    Lane.AGENT: N_("agent"),
    Lane.BRAIN: N_("brain"),
    Lane.COMMAND: N_("command"),
    Lane.HEAD: N_("head"),
    Lane.DRIVE: N_("drive"),
    Lane.WHEELS: N_("wheels"),
    Lane.SPEAKER: N_("speaker"),
    Lane.LOG: N_("other logs"),
}
MEANINGS = {Lane.BRAIN: "warn", Lane.DRIVE: "good", Lane.WHEELS: "good", Lane.LOG: "dim"}
"""The colours of the lanes, as meanings of `tui.widgets.rows.Cell`."""
SOUND = "♪"
SECOND_MS = 1000
NARROW, WIDE = 100, 150
"""Widths from which on more columns are shown."""


def content_words(step: FlowStep) -> str:
    """Return the content of a step as text."""
    words = _once(step)
    return words if step.times == 1 else f"{words} ×{step.times}"


def _once(step: FlowStep) -> str:
    if step.kind is StepKind.DRIVE:
        return outcome_words.drive_words(*step.figures)
    if step.kind is StepKind.WHEELS:
        return outcome_words.rim_words(*step.figures)
    if step.kind is StepKind.HEAD_MOVES:
        return _("begins to turn")
    if step.kind is StepKind.HEAD_THERE:
        looks = [0.0 if math.isnan(angle) else angle for angle in step.figures]
        return _("has stopped: {pose}").format(pose=outcome_words.head_words(*looks))
    return _("sound") if step.text == SOUND else step.text


def said_by(step: FlowStep, chain: Chain) -> str:
    """Return the node that published it; a command that nothing led to comes from a person."""
    # Found by its identity: a step that seems to have come slightly earlier stands before it.
    is_first = (step.source, step.time_s) == (chain.first.source, chain.start_s)
    if is_first and step.lane not in (Lane.MIC, Lane.AGENT):
        return _("a person")
    return step.said_by.lstrip("/")


def delay(delay_s: float) -> str:
    """Return a delay in milliseconds, with tenths if it is short."""
    milliseconds = delay_s * SECOND_MS
    return _("{n} ms").format(n=figure(milliseconds, 1 if abs(milliseconds) < 100 else 0))


def headline(chain: Chain, shown: Sequence[FlowStep]) -> str:
    """Return what began the chain, how many of its steps are shown, and how long they took."""
    steps = len(shown) + chain.more
    count = ngettext("{n} step", "{n} steps", steps).format(n=steps)
    took = delay(max(map(chain.delay_s, shown), default=0.0))
    return _("“{words}” · {count} in {time}").format(words=_once(chain.first), count=count, time=took)


def model_took(chain: Chain) -> str:
    """Return which model answered and what that took; empty if none has taken part."""
    return "" if chain.usage is None else usage_words(chain.usage)


def nothing_yet(topics: Collection[str], command_key: str, *, recorded: bool) -> list[str]:
    """Say what is missing, and what can be done with the `topics` that exist.

    `recorded`: whether a recording is shown, to which nobody can say anything.
    """
    if recorded:
        return [_("Nobody has spoken so far in this recording: play on, or skip ahead.")]
    said = [_("Nobody has spoken since this screen was opened.")]
    if MICROPHONE in topics:
        said.append(_("The microphone is there: speak, or wait for what is said next."))
    if AI_COMMAND in topics:
        key = _("On the Deck screen, {key} writes a word to {topic}: forward, stop.")
        said.append(key.format(key=command_key, topic=AI_COMMAND))
    if LLM_RAW_JSON in topics:
        said.append(_("The Composer sends JSON to {topic}.").format(topic=LLM_RAW_JSON))
    if not {MICROPHONE, AI_COMMAND, LLM_RAW_JSON} & set(topics):
        none = _("None of {topics} is here: lesson 9 has a voice, lesson 4 takes words.")
        said.append(none.format(topics=f"{MICROPHONE}, {AI_COMMAND}, {LLM_RAW_JSON}"))
    return said


def columns(width: int) -> list[Column]:
    source, by = (16, 0) if width < NARROW else (18, 18) if width < WIDE else (24, 26)
    delays = [Column(_("delay"), 10, right=True), Column(_("step"), 10, right=True)]
    return [*delays, Column(_("source"), source), *([Column(_("node"), by)] if by else []), Column(_("content"))]


def key_of(chain: Chain, number: int = -1) -> str:
    """Return the key of the row of a step, by its number among those shown, or of the headline."""
    return f"{chain.start_s}|{number}"


def rows_of(chain: Chain, at: str, shown: Sequence[FlowStep], width: int, *, folded: bool) -> list[Row]:
    """Return the rows of a chain; `at` is the time of day of its start, `shown` the steps to show."""
    head = Row(key_of(chain), (Cell(f"{'▸' if folded else '▾'} {at}  {headline(chain, shown)}"),))
    if folded:
        return [head]
    found, before_s = [head], 0.0
    if took := model_took(chain):
        found.append(Row("", (Cell(f"  {took}", MEANINGS[Lane.BRAIN]),)))
    for number, step in enumerate(shown):
        after_s, by = chain.delay_s(step), said_by(step, chain)
        cells = [
            Cell(delay(after_s)),
            Cell("+" + delay(after_s - before_s) if number else "", "dim"),
            Cell(step.source, MEANINGS.get(step.lane, "")),
            *([Cell("" if by == step.source else by, "dim")] if width >= NARROW else []),
            Cell(content_words(step)),
        ]
        found.append(Row(key_of(chain, number), tuple(cells)))
        before_s = after_s
    if chain.more:
        found.append(Row("", (Cell(f"… +{chain.more}", "dim"),)))
    return [*found, Row("", (Cell(""),))]
