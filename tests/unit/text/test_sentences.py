"""Sentences that errors carry: what was said can still be translated, and something always is."""

from __future__ import annotations

import pytest

from launcher.errors import SessionError
from text.i18n import localized
from text.sentences import reason_of, say

SENTENCE = say("ROS cannot be used: {error}", error="no rclpy")


def test_the_sentence_of_an_error_can_still_be_translated() -> None:
    error = SessionError(SENTENCE)
    assert reason_of(error) == str(error)
    assert localized(reason_of(error), "ru") == "ROS не работает: no rclpy"
    assert localized(str(error), "ru") == str(error)


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (ValueError("not a number"), "not a number"),
        (OSError(5, "Input/output error"), "[Errno 5] Input/output error"),
        (TimeoutError(), "TimeoutError"),
        (RuntimeError(SENTENCE, 7), str(RuntimeError(str(SENTENCE), 7))),
    ],
)
def test_an_error_without_a_sentence_says_its_text_or_its_kind(
    error: Exception, words: str
) -> None:
    assert reason_of(error) == words
