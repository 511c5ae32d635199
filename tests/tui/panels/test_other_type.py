"""Panels whose topic carries another type: which comes, and which is expected."""

from __future__ import annotations

import pytest

from tests.tui.app_runs import opened
from tests.tui.panel_stage import rows
from tests.tui.recorded import RecordedGraph, RecordedOpener, lesson_samples, lesson_update, sample
from tests.tui.recorded_lesson import TOPICS
from tui.panels.camera import CameraPanel
from tui.panels.panel import Panel
from tui.panels.voice.panel import VoicePanel
from tui.panels.wheels.panel import WheelsPanel

STRING = "std_msgs/msg/String"


@pytest.mark.parametrize(
    ("kind", "topic", "expected", "gone"),
    [
        (CameraPanel, "/camera/color/image_raw", "sensor_msgs/Image", ""),
        (VoicePanel, "/audio/mic_raw", "std_msgs/ByteMultiArray", "/audio/speaker_raw"),
        (VoicePanel, "/audio/speaker_raw", "std_msgs/ByteMultiArray", "/audio/mic_raw"),
        (WheelsPanel, "/drive", "ackermann_msgs/AckermannDriveStamped", "/wheel_commands"),
    ],
)
async def test_another_type_is_told_and_not_waited_for(
    kind: type[Panel], topic: str, expected: str, gone: str
) -> None:
    topics = tuple(row for row in TOPICS if row.name != gone)
    words = sample(topic, STRING, {"data": "1.5"})
    only = {topic: (words,)}
    opener = RecordedOpener(graph=RecordedGraph(lesson_update(topics=topics, samples=only)))
    async with opened(opener, size=(160, 60)) as (app, pilot):
        await pilot.pause()
        widget = app.screen.query_one(kind).children[0]

        def told() -> str:
            return " ".join(" ".join(rows(widget)).split())

        assert "messages arrive, but of another type" in told()
        assert f"{topic}: std_msgs/String comes; expected: {expected}" in told()
        # A look at which nothing has come changes nothing.
        opener.graph.show(lesson_update(topics=topics, samples={}))
        await pilot.pause()
        await pilot.pause()
        assert "of another type" in told()
        right = {topic: lesson_samples()[topic]}
        opener.graph.show(lesson_update(topics=topics, samples=right))
        await pilot.pause()
        await pilot.pause()
        assert "std_msgs/String" not in told()
