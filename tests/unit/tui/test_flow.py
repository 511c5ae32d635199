"""Chains of steps: what begins one, what belongs to it, what is news and what is repetition."""

from __future__ import annotations

import random
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tui.recorded import NOW_S, line
from tests.tui.recorded_flow import (
    BEFORE,
    command,
    drive,
    head,
    sound,
    topics,
    update,
    voice,
    voice_lines,
    wheels,
    word,
)
from tui.flow.book import MOST_CHAINS, FlowBook
from tui.flow.chains import EARLY_S, LONGEST_S, MOST_STEPS, Chain, FlowStep, Lane, StepKind
from tui.flow.lines import TimeAxis, columns, fit
from tui.flow.reading import FlowReader, log_steps
from tui.flow.words import said_by

PROGRAMS = {"brain": "nodes.ai_brain", "ai_driver": "nodes.ai_driver"}


def step(
    at_s: float, lane: Lane = Lane.DRIVE, source: str = "/drive", text: str = "", **more: Any
) -> FlowStep:
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


def test_a_voice_between_two_words_is_one_utterance_and_after_a_silence_another() -> None:
    assert len(book_of(mic(0, "a"), mic(0.9, "b"), mic(1.8, "c")).chains) == 1
    assert len(book_of(mic(0, "a"), mic(1.1, "b")).chains) == 2


def test_a_brain_may_think_for_long_before_its_command() -> None:
    assert len(book_of(mic(0), said(9.0), step(9.01)).chains) == 1
    assert len(book_of(mic(0), said(21.0)).chains) == 2


def test_a_command_is_a_persons_whatever_seems_to_have_come_a_hair_earlier() -> None:
    wheels_s, said_s = 1.0 - EARLY_S / 2, 1.0
    by_node = FlowStep(said_s, Lane.COMMAND, "/ai_command", "/composer", text="left", begins=True)
    (chain,) = book_of(by_node, FlowStep(wheels_s, Lane.WHEELS, "/wheel_commands", "/gate")).chains
    assert [said_by(one, chain) for one in chain.steps] == ["gate", "a person"]
    (chain,) = book_of(mic(0.5), by_node).chains
    assert [said_by(one, chain) for one in chain.steps] == ["", "composer"]


def test_a_voice_does_not_follow_from_a_command() -> None:
    assert len(book_of(said(0), mic(0.3)).chains) == 2


def test_what_comes_much_later_belongs_to_nothing() -> None:
    (chain,) = book_of(mic(0), step(4.9), step(8.0)).chains
    assert len(chain.steps) == 2
    (chain,) = book_of(mic(0), *(step(at, text=str(at)) for at in range(60))).chains
    assert chain.delay_s(chain.steps[-1]) <= LONGEST_S


def test_other_logs_do_not_keep_a_chain_open() -> None:
    logs = [step(at, Lane.LOG, "sonar", str(at)) for at in range(1, 20)]
    (chain,) = book_of(mic(0), *logs).chains
    assert chain.delay_s(chain.steps[-1]) == 5


def test_a_log_line_that_comes_in_before_its_message_finds_its_place() -> None:
    book = book_of(step(0.001, Lane.BRAIN, "ai_brain", "heard"))
    assert book.add([mic(0)])
    assert sources(book.chains[0]) == ["/audio/mic_raw", "ai_brain"]


def test_a_line_that_comes_in_late_goes_to_the_older_chain() -> None:
    book = book_of(mic(0), mic(3.0))
    book.add([step(0.5, Lane.BRAIN, "ai_brain", "heard")])
    assert [len(chain.steps) for chain in book.chains] == [2, 1]


def test_a_hair_before_the_beginning_counts_as_at_once() -> None:
    (chain,) = book_of(step(9.99, Lane.BRAIN, "ai_brain", "heard"), mic(10.0)).chains
    assert [chain.delay_s(one) for one in chain.steps] == [0.0, 0.0]


def test_the_same_again_is_counted() -> None:
    (chain,) = book_of(said(0), *(step(0.1 + at / 20) for at in range(40))).chains
    assert [one.times for one in chain.steps] == [1, 40]


def test_two_beginnings_of_one_moment_are_two_chains() -> None:
    chains = book_of(mic(1.0), said(1.0), said(1.0, "left"), step(1.1)).chains
    assert len({chain.start_s for chain in chains}) == len(chains)


def test_chains_and_their_steps_are_bounded() -> None:
    many = [mic(at * 2.0) for at in range(3 * MOST_CHAINS)]
    assert len(book_of(*many).chains) == MOST_CHAINS
    (chain,) = book_of(mic(0), *(step(at / 100, text=str(at)) for at in range(200))).chains
    assert (len(chain.steps), chain.more) == (MOST_STEPS, 201 - MOST_STEPS)


@given(st.randoms(use_true_random=False), st.integers(1, 6))
def test_the_order_of_arrival_within_a_moment_does_not_matter(
    shuffle: random.Random, pieces: int
) -> None:
    steps = [mic(0), said(0.01), step(0.02), step(0.03, Lane.WHEELS, "/wheel_commands")]
    steps += [mic(2.0, "again"), said(2.01, "left")]
    steps += [step(0.001, Lane.BRAIN, "ai_brain", "heard")]
    shuffle.shuffle(steps)
    book = FlowBook()
    # Beginnings come in their order; logs and what follows, in any.
    for at in range(0, len(steps), pieces):
        book.add(steps[at : at + pieces])
    first = book.chains[0]
    assert first.start_s == 0 or not any(one.lane is Lane.MIC for one in first.steps)
    for chain in book.chains:
        times = [one.time_s for one in chain.steps]
        assert times == sorted(times)


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


def test_what_repeats_itself_is_news_only_when_it_changes() -> None:
    reader = FlowReader()
    assert len(read(reader, drive("/drive_safe", 0.0, 0.0, 0.0))) == 1
    repeated = [drive("/drive_safe", 0.0, 0.0, at / 5) for at in range(1, 9)]
    assert not read(reader, *repeated)
    assert not read(reader, *(wheels(float("nan"), 1.0, at / 2) for at in range(4)))[1:]
    assert len(read(reader, drive("/drive_safe", 0.3, 0.0, 2.0))) == 1


def test_the_same_command_again_is_seen_passing_to_the_wheels() -> None:
    reader = FlowReader()
    first = (drive("/drive", 0.5, 0.0, 0.0), drive("/drive_safe", 0.5, 0.0, 0.002))
    read(reader, *first, wheels(9.0, 9.0, 0.003))
    again = (drive("/drive", 0.5, 0.0, 5.0), drive("/drive_safe", 0.5, 0.0, 5.002))
    steps = read(
        reader,
        *(*again, wheels(9.0, 9.0, 5.003), drive("/drive_safe", 0.5, 0.0, 5.02)),
        wheels(9.0, 9.0, 5.5),
    )
    assert [one.source for one in steps] == ["/drive", "/drive_safe", "/wheel_commands"]


def test_the_stamp_of_the_sender_counts_unless_it_is_of_another_clock() -> None:
    late = word("left", 0.5)
    for sent_s, expected_s in ((0.498, 0.498), (-60.0, 0.5), (0.6, 0.5)):
        (step,) = read(FlowReader(), replace(late, sent_s=NOW_S + sent_s))
        assert step.time_s - NOW_S == pytest.approx(expected_s, abs=1e-5)


def test_a_movement_of_the_head_is_its_beginning_and_its_end() -> None:
    reader = FlowReader()
    poses = [(0.0, 0.0), (0.0, 0.5), (10.0, 0.55), (30.0, 0.8), (45.0, 1.0), (45.0, 1.5), (45, 2)]
    steps = read(reader, *(head(pan, at) for pan, at in poses))
    assert [one.kind for one in steps] == [StepKind.HEAD_MOVES, StepKind.HEAD_THERE]
    assert [one.time_s - NOW_S for one in steps] == pytest.approx([0.55, 1.0], abs=1e-5)


def test_a_head_of_which_nobody_knows_where_it_looks_does_not_move() -> None:
    unknown = [replace(head(0.0, at_s), value={"name": ["pan_joint"]}) for at_s in (0.0, 0.5, 1.0)]
    reader = FlowReader()
    assert read(reader, *unknown) == []
    steps = read(reader, head(30.0, 1.5), head(30.0, 2.0))
    assert [one.kind for one in steps] == [StepKind.HEAD_MOVES, StepKind.HEAD_THERE]


def test_silence_in_the_microphone_says_nothing_and_a_loud_sound_does() -> None:
    quiet = sound("/audio/mic_raw", "", 0.0)
    quiet.value["data"] = b"\x01\x00" * 800  # type: ignore[index]
    loud = sound("/audio/mic_raw", "", 0.1)
    loud.value["data"] = b"\x00\x40\x00\xc0" * 400  # type: ignore[index]
    steps = read(FlowReader(), quiet, loud)
    assert [one.text for one in steps] == ["♪"]


def test_hostile_text_is_made_harmless() -> None:
    (step,) = read(FlowReader(), word("left\x1b[31m\n\x00 [red]", 0.0))
    assert step.text == "left␛[31m ␀ [red]"
    (logged,) = log_steps([line("ai_brain", 1, "a\x1b[2Jb")], {})
    assert logged.text == "a␛[2Jb"


def test_who_a_log_line_is_of_is_told_by_the_program_or_the_name() -> None:
    lines = [line("brain", 1, "x"), line("ai_driver", 1, "y"), line("head_controller", 1, "z")]
    lanes = [one.lane for one in log_steps(lines, PROGRAMS)]
    assert lanes == [Lane.BRAIN, Lane.LOG, Lane.HEAD]
    assert not log_steps([line("ai_brain", 1, "exited", source="deck")], {})


def test_a_command_alone_is_a_chain() -> None:
    book = FlowBook()
    book.add(read(FlowReader(), *command(0.0)))
    assert sources(book.chains[0]) == ["/ai_command", "/drive", "/drive_safe", "/wheel_commands"]


# ---------------------------------------------------------------- the axis


@given(st.floats(0.0001, 60.0), st.integers(8, 80), st.booleans(), st.floats(0, 1), st.floats(0, 1))
def test_bars_stay_on_the_axis_and_keep_their_order(
    span: float, width: int, logarithmic: bool, a: float, b: float
) -> None:
    axis = TimeAxis(span, width, logarithmic)
    early, late = sorted((a * span, b * span))
    assert 0 <= axis.cell(early) <= axis.cell(late) < width
    bar = axis.bar(early, late)
    assert len(bar) == width
    assert bar.index("●") == axis.cell(late)
    assert axis.cell(span) == width - 1
    assert len(axis.ruler()) == width


@given(st.integers(70, 300))
def test_the_columns_fit(width: int) -> None:
    room = columns(width)
    gaps = 4 if room.said_by else 3
    total = 10 + room.source + room.said_by + room.bar + room.content + 2 * gaps
    assert total == width
    assert len(fit("x" * 500, room.content)) == room.content
