"""What the gate says of itself, in the words of the screen."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest

from robot.safety.gate_report import Gate
from text.i18n import set_language
from tui.emergency.gate import gate_words, held_words


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


@pytest.mark.parametrize(
    ("nodes", "language", "words"),
    [
        (("/mock",), "en", "forward is blocked: mock speaks too rarely ahead"),
        (("/a", "/b"), "en", "forward is blocked: one of a, b speaks too rarely ahead"),
        (("/mock",), "ru", "вперёд нельзя: mock: спереди слишком редко"),
    ],
)
def test_who_speaks_too_rarely_is_named_in_place_of_a_silent_sonar(
    nodes: tuple[str, ...], language: str, words: str
) -> None:
    set_language(language)
    gate = Gate("blocked_forward", {"front": "silent"}, too_rare={"front": nodes})
    assert held_words(gate) == words
