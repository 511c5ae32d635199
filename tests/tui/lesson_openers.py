"""Days of the Deck that were written down: the first lesson, the LLM lesson, a bad day."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from graph.data import NodeRow, Trouble
from launcher.status import NodeState, NodeStatus
from robot.topics import LLM_RAW_JSON
from tests.tui.recorded import (
    NODES,
    NOW_S,
    SESSION,
    TOPICS,
    RecordedGraph,
    RecordedOpener,
    RecordedSession,
    lesson_samples,
    lesson_update,
    line,
    sample,
)

HELLO = replace(SESSION, name="01-hello", lesson="1", title={"en": "The first node"}, panels=())


def hello() -> RecordedOpener:
    """Lesson 1: one node, no panels."""
    node = replace(NODES["camera"], name="hello_node", command="nodes.hello")
    lines = [line("hello_node", n, f"I have worked for {n} s", at_s=n) for n in range(1, 12)]
    session = RecordedSession(HELLO, {"hello_node": node}, lines)
    graph = lesson_update(topics=(), samples={}, nodes=(NodeRow("/hello_node"),))
    return RecordedOpener(session, RecordedGraph(graph))


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


def without_process(name: str, **told: Any) -> NodeStatus:
    """A node of lesson 9 that does not run now."""
    return replace(
        NODES[name], pid=None, uptime_s=None, cpu_percent=None, memory_bytes=None, **told
    )


def troubled() -> RecordedOpener:
    """Lesson 9 on a bad day: nodes waiting, restarting, failed; every panel without data."""
    session = RecordedSession()
    session.nodes |= {
        "camera": without_process(
            "camera",
            state=NodeState.FAILED,
            exit_code=1,
            restarts=5,
            detail="given up after 5 ends in 12 s",
        ),
        "audio": without_process("audio", state=NodeState.BACKOFF, restarts=2, signal="SIGKILL"),
        "ai_brain": without_process(
            "ai_brain", state=NodeState.WAITING, detail="waits for camera, audio"
        ),
    }
    troubles = {
        "/sensor/sonar_front": (Trouble.QUIET, ""),
        "/wheel_commands": (Trouble.QOS_MISMATCH, "reliable here, best effort there"),
        "/camera/color/image_raw": (Trouble.NO_PUBLISHER, ""),
        "/head_state": (Trouble.UNKNOWN_TYPE, "head_msgs/msg/Head"),
    }
    rows = tuple(
        replace(row, trouble=troubles[row.name][0], detail=troubles[row.name][1], age_s=None)
        if row.name in troubles
        else row
        for row in TOPICS
    )
    return RecordedOpener(session, RecordedGraph(lesson_update(topics=rows, samples={})))
