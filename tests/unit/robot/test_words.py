"""The words that drive: both languages, and how freely they may be written."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.limits import SPEED, STEERING
from robot.words import STOP, WORDS, DriveSetpoint, parse_spoken, parse_word


@pytest.mark.parametrize(
    ("russian", "english", "setpoint"),
    [
        ("вперед", "forward", DriveSetpoint(0.5, 0.0)),
        ("налево", "left", DriveSetpoint(0.3, 0.5)),
        ("направо", "right", DriveSetpoint(0.3, -0.5)),
        ("назад", "back", DriveSetpoint(-0.3, 0.0)),
        ("стоп", "stop", STOP),
    ],
)
def test_the_course_s_five_words(russian: str, english: str, setpoint: DriveSetpoint) -> None:
    assert parse_word(russian) == parse_word(english) == setpoint


@pytest.mark.parametrize("word", ["вперёд", "ВПЕРЁД", "  Вперед\n", "впере\u0308д", "вперед!"])
def test_spelling_case_and_blanks_do_not_matter(word: str) -> None:
    assert parse_word(word) == DriveSetpoint(0.5, 0.0)


@pytest.mark.parametrize("word", ["", "   ", "прыжок", "forwards", "сто п", "!", "стоп стоп", "\0"])
def test_any_other_word_means_nothing(word: str) -> None:
    assert parse_word(word) is None


def test_every_listed_word_is_known_and_in_one_order() -> None:
    for russian, english in zip(WORDS["ru"], WORDS["en"], strict=True):
        assert parse_word(russian) == parse_word(english)
        assert parse_word(russian) is not None


@given(st.text())
def test_no_text_leads_out_of_range(text: str) -> None:
    setpoint = parse_word(text)
    assert setpoint is None or (setpoint.speed_m_s in SPEED and setpoint.steering_rad in STEERING)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("robot forward", "forward"),
        ("Robot, turn left!", "left"),
        ("Робот, поезжай вперёд.", "вперед"),
        ("робот осмотрись", "осмотрись"),
        ("robot have a look round", "look around"),
        ("stop", "stop"),
        ("Стоп!", "стоп"),
        ("стой", "стоп"),
        ("forward", None),
        ("turn left", None),
        ("вперёд", None),
        ("look around", None),
        ("robot", None),
        ("robot robot forward", None),
        ("robot forward please", None),
        ("the robot stop", None),
        ("", None),
    ],
)
def test_only_what_is_said_to_the_robot_means_something(text: str, meant: str | None) -> None:
    assert parse_spoken(text) == meant
