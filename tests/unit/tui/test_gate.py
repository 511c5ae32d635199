"""What the gate says of itself, in the words of the screen."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from safety.gate_report import Gate
from text.i18n import set_language
from tui.emergency.gate import held_words


@pytest.fixture(autouse=True)
def _english_after() -> Iterator[None]:
    yield
    set_language("en")


@pytest.mark.parametrize(
    ("nodes", "language", "words"),
    [
        (("/mock",), "en", "forward is blocked: mock speaks too rarely ahead"),
        (("/a", "/b"), "en", "forward is blocked: one of a, b speaks too rarely ahead"),
        (("/mock",), "ru", "вперёд нельзя: mock: показания спереди слишком редки"),
    ],
)
def test_who_speaks_too_rarely_is_named_in_place_of_a_silent_sonar(
    nodes: tuple[str, ...], language: str, words: str
) -> None:
    set_language(language)
    gate = Gate("blocked_forward", {"front": "silent"}, too_rare={"front": nodes})
    assert held_words(gate) == words
