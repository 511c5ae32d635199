"""Days of the Deck that were written down: the first lesson, the LLM lesson, a bad day."""

from __future__ import annotations

from dataclasses import replace

from robot.topics import LLM_RAW_JSON
from tests.tui.recorded import (
    NOW_S,
    SESSION,
    RecordedGraph,
    RecordedOpener,
    RecordedSession,
    lesson_samples,
    lesson_update,
    sample,
)

LLM_JSON = (
    '{"thought": "Turn and look", "commands": [{"action": "drive", "speed": 0.3, "steering": 0.5},'
    ' {"action": "turn_head", "pan": 45, "tilt": 10}]}'
)


def llm() -> RecordedOpener:
    """Lesson 10: a message to the parser, and what came of it."""
    panels = ("composer", "wheels", "head")
    lesson = replace(SESSION, name="10-llm-json", lesson="10", panels=panels)
    results = (
        '{"event": "accepted", "commands": 2, "thought": "Turn and look"}',
        '{"event": "head", "pan": 45, "tilt": 10, "sum": 1}',
    )
    samples = lesson_samples()
    samples["/llm_raw_json"] = (sample("/llm_raw_json", "std_msgs/msg/String", {"data": LLM_JSON}),)
    samples["/llm_result"] = tuple(
        sample("/llm_result", "std_msgs/msg/String", {"data": text}) for text in results
    )
    just_now = {
        topic: tuple(
            replace(
                one, received_s=NOW_S + 16.0 + (0.004 * (n + 1) if topic != LLM_RAW_JSON else 0.0)
            )
            for n, one in enumerate(each)
        )
        for topic, each in samples.items()
    }
    graph = RecordedGraph(lesson_update(samples=just_now))
    return RecordedOpener(RecordedSession(lesson), graph)
