"""Panels whose topic carries another type: which comes, and which is expected."""

from __future__ import annotations

import pytest

from tests.tui.app_runs import opened
from tests.tui.panel_stage import rows
from tests.tui.panels.test_map import Alone
from tests.tui.recorded import RecordedGraph, RecordedOpener, lesson_samples, lesson_update, sample
from tests.tui.recorded_lesson import TOPICS
from tests.tui.recorded_map import map_update
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


async def test_what_the_robot_says_in_another_type_leaves_the_talk_and_stands_below_it() -> None:
    samples = lesson_samples() | {
        "/audio/speaker_raw": (sample("/audio/speaker_raw", STRING, {"data": "yes"}),)
    }
    opener = RecordedOpener(graph=RecordedGraph(lesson_update(samples=samples)))
    async with opened(opener, size=(160, 60)) as (app, pilot):
        await pilot.pause()
        told = " ".join(rows(app.screen.query_one(VoicePanel).children[0]))
        assert "Осмотрись" in told
        assert "/audio/speaker_raw: std_msgs/String comes" in told


async def test_odometry_of_another_type_is_told_by_the_map() -> None:
    app = Alone()
    async with app.run_test(size=(100, 20)):
        words = sample("/odom", STRING, {"data": "1.5"})
        text = app.tell(map_update(odom=(words,), mock_pose=()))
        assert "messages arrive, but of another type" in text
        assert "/odom: std_msgs/String comes; expected: nav_msgs/Odometry" in text
        text = app.tell(map_update())
        assert "another type" not in text
        assert "heading" in text
