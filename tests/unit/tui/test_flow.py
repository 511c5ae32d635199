"""Chains of steps: what begins one, what belongs to it, what is news and what is repetition."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest

from tests.tui.recorded_flow import BEFORE, topics, update, voice, voice_lines
from tui.flow.chains import LONGEST_S, Chain, FlowBook, FlowStep, Lane
from tui.flow.reading import FlowReader, log_steps


def step(at_s: float, lane: Lane = Lane.DRIVE, source: str = "/drive", text: str = "", **more: Any) -> FlowStep:
    return FlowStep(at_s, lane, source, text=text, **more)


def mic(at_s: float, text: str = "hello") -> FlowStep:
    return step(at_s, Lane.MIC, "/audio/mic_raw", text, begins=True)


def said(at_s: float, text: str = "forward") -> FlowStep:
    return step(at_s, Lane.COMMAND, "/ai_command", text, begins=True)


def book_of(*steps: FlowStep) -> FlowBook:
    book = FlowBook()
    book.add(steps)
    return book


def sources(chain: Chain) -> list[str]:
    return [one.source for one in chain.steps]


# ---------------------------------------------------------------- grouping


def test_a_voice_gathers_what_follows_from_it() -> None:
    book = book_of(mic(0), said(0.01), step(0.02), step(1.0, Lane.HEAD, "/head_state"))
    (chain,) = book.chains
    assert sources(chain) == ["/audio/mic_raw", "/ai_command", "/drive", "/head_state"]
    assert [chain.delay_s(one) for one in chain.steps] == [0, 0.01, 0.02, 1.0]


def test_what_nobody_began_is_not_shown() -> None:
    assert not book_of(step(0), step(1.0)).chains


def test_a_command_after_quiet_begins_anew_and_one_in_a_burst_does_not() -> None:
    assert len(book_of(said(0), said(0.2, "left"), said(5.0)).chains) == 2


def test_what_comes_much_later_belongs_to_nothing() -> None:
    (chain,) = book_of(mic(0), step(4.9), step(8.0)).chains
    assert len(chain.steps) == 2
    (chain,) = book_of(mic(0), *(step(at, text=str(at)) for at in range(60))).chains
    assert chain.delay_s(chain.steps[-1]) <= LONGEST_S


# ---------------------------------------------------------------- reading


def read(reader: FlowReader, *samples: object) -> list[FlowStep]:
    return reader.messages(update(*samples).samples, {})  # type: ignore[arg-type]


def test_lesson_nine_is_one_chain_with_rising_delays() -> None:
    reader, book = FlowReader(), FlowBook()
    read(reader, *BEFORE)
    said_by = {row.name: row.published_by[0].node for row in topics() if row.published_by}
    book.add(log_steps(voice_lines(0.0), {}))
    book.add(reader.messages(update(*voice(0.0)).samples, said_by))
    (chain,) = book.chains
    assert sources(chain) == [
        *("/audio/mic_raw", "ai_brain", "ai_brain", "ai_brain", "/ai_command"),
        *("/audio/speaker_raw", "head_controller", "ai_driver", "/drive", "/drive_safe"),
        *("/wheel_commands", "/head_state", "head_controller", "/head_state", "sonar_front"),
    ]
    assert all(a <= b for a, b in pairwise(map(chain.delay_s, chain.steps)))
    assert chain.delay_s(chain.steps[4]) == pytest.approx(0.0042, abs=1e-6)
    assert chain.steps[4].said_by == "/ai_brain"
    assert [one.lane for one in chain.steps if one.source == "ai_driver"] == [Lane.LOG]


# ---------------------------------------------------------------- the axis
