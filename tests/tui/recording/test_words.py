"""What is said of a recording, in the language of the screen."""

from __future__ import annotations

from graph.recording.recorder import RecordingStatus
from text.i18n import set_language
from text.sentences import say
from tui.recording.words import complaints


def test_why_a_topic_is_not_recorded_is_said_in_russian() -> None:
    set_language("ru")
    reason = say("{path} cannot be created: {reason}", path="/odom", reason="нет места")
    status = RecordingStatus("walk", 0.0, 1.0, skipped={"/odom": reason})
    (sentence,) = complaints(status)
    assert sentence == "/odom не записывается: не удалось создать /odom: нет места"
