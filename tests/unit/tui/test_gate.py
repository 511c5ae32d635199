"""What the gate says of itself, in the words of the screen."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest

from robot.safety.gate_report import Gate
from text.i18n import set_language
from tui.emergency.gate import gate_words


@pytest.fixture(autouse=True)
def _english_after() -> Iterator[None]:
    yield
    set_language("en")


@pytest.mark.parametrize(
    ("language", "words"),
    [
        ("en", ("obstacle ahead too close to measure", "obstacle behind too close to measure")),
        ("ru", ("препятствие впереди слишком близко", "препятствие сзади слишком близко")),
    ],
)
def test_what_is_nearer_than_can_be_measured_has_words_of_its_own(
    language: str, words: tuple[str, str]
) -> None:
    set_language(language)
    states = {"front": "close", "rear": "close"}
    gate = Gate("blocked", states, dict.fromkeys(states, -math.inf))
    assert gate_words(gate).endswith(": " + ", ".join(words))
