"""What the brain decides: never forward into what it does not see."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.commands.brain import Decision, asks_to_stop, decide, spoken
from robot.safety.distance import RangeState
from robot.words import STOP, DriveSetpoint, parse_word

FORWARD = DriveSetpoint(0.5, 0.0)


@pytest.mark.parametrize(
    ("front", "decision"),
    [
        (RangeState.FREE, Decision.LOOK_AND_GO),
        (RangeState.CLOSE, Decision.OBSTACLE),
        (RangeState.INVALID, Decision.BLIND),
        (RangeState.SILENT, Decision.BLIND),
    ],
)
def test_a_request_is_answered_by_what_is_ahead(front: RangeState, decision: Decision) -> None:
    assert decide(None, front) == decision


@given(st.sampled_from(RangeState))
def test_stop_and_back_are_always_obeyed(front: RangeState) -> None:
    assert decide(STOP, front) == Decision.OBEY
    assert decide(parse_word("назад"), front) == Decision.OBEY


@given(st.sampled_from(RangeState))
def test_forward_is_obeyed_only_where_the_way_is_free(front: RangeState) -> None:
    assert (decide(FORWARD, front) == Decision.OBEY) == (front == RangeState.FREE)


@pytest.mark.parametrize(
    ("sound", "words"),
    [
        (b"VOICE_COMMAND: Look around", "Look around"),
        (" voice_command:  Стоп \n".encode(), "Стоп"),
        (b"left", "left"),
        (b"\xff\xfe", "��"),
        (b"", ""),
    ],
)
def test_the_words_are_taken_from_the_bytes(sound: bytes, words: str) -> None:
    assert spoken(sound) == words


@pytest.mark.parametrize("words", ["stop", "STOP!!", "please stop, robot", "Стоп, машина", "стой!"])
def test_the_word_for_stop_is_found_among_others(words: str) -> None:
    assert asks_to_stop(words)


@pytest.mark.parametrize("words", ["", "forward", "what do you see?", "поехали", "unstoppable"])
def test_other_words_are_no_stop(words: str) -> None:
    assert not asks_to_stop(words)
