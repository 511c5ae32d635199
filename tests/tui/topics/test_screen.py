"""The screen of topics: what it asks of the graph, and what it shows in every case."""

from __future__ import annotations

import sys
from collections.abc import AsyncIterator
from dataclasses import replace

import numpy as np
import pytest

from graph.data import EndpointInfo, GraphUpdate, TopicRow, Trouble
from launcher.status import NodeState
from tests.tui.recorded import NOW_S, RecordedSession, lesson_update, sample
from tests.tui.snapshots import settle
from tests.tui.topics_stage import SONAR, TopicsStage, opened, row, with_row
from tests.waiting import until
from tui.frame.key_bar import KeyBar

ROSOUT = TopicRow("/rosout", ("rcl_interfaces/msg/Log",), 1, 0)


@pytest.fixture
async def stage() -> AsyncIterator[TopicsStage]:
    async with opened() as stage:
        yield stage


async def test_all_rates_are_measured_while_the_screen_is_in_front(stage: TopicsStage) -> None:
    assert stage.measures()
    await stage.pilot.press("4")
    await settle(stage.pilot)
    assert not stage.measures()
    assert stage.graph.watched == set()


async def test_only_the_chosen_topic_is_decoded(stage: TopicsStage) -> None:
    await stage.choose(SONAR)
    await stage.show(lesson_update())
    assert "data:    1.84" in stage.echo()
    assert "std_msgs/msg/Float32" in stage.head()
    assert (
        "1.0 Hz · 8 B/s · age <1 s · jitter – · latency – · lost – · 8 B a message" in stage.head()
    )


async def test_what_takes_a_message_is_offered_when_one_is_there(stage: TopicsStage) -> None:
    def offered() -> set[str]:
        keys = stage.screen.query_one(KeyBar).keys()
        return {key.title for key in keys}

    await stage.choose(SONAR)
    await stage.show(lesson_update())
    assert {"Plot field", "Copy"} <= offered()
    await stage.choose("/drive")
    assert {"Plot field", "Copy"}.isdisjoint(offered())
    await stage.pilot.press("y")
    await stage.pilot.pause()
    assert "There is no message to copy." in [one.message for one in stage.app._notifications]
    await stage.choose(SONAR)
    await stage.show(lesson_update())
    assert {"Plot field", "Copy"} <= offered()


async def test_walking_past_topics_subscribes_none_of_them(
    stage: TopicsStage, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The one that is chosen first is asked for at first.
    await until(lambda: stage.graph.watched, "the first topic asked for")
    asked: list[set[str]] = []
    monkeypatch.setattr(stage.graph, "watch", lambda topics: asked.append(set(topics)))
    # However long the keys take here, they come before the walk is over.
    monkeypatch.setattr("tui.topics.screen.SETTLED_S", 3600.0)
    await stage.pilot.press("down", "down", "down")
    assert not asked
    monkeypatch.setattr("tui.topics.screen.SETTLED_S", 0.01)
    await stage.pilot.press("down")
    await until(lambda: asked, "the last topic asked for")
    assert asked == [{"/drive"}]


async def test_nobody_who_publishes_is_told(stage: TopicsStage) -> None:
    await stage.choose("/emergency_stop")
    assert stage.echo().startswith("nobody publishes this topic\nStart the node")


@pytest.mark.parametrize(
    ("state", "topics", "words"),
    [
        (NodeState.STARTING, (ROSOUT,), ["no topics yet", "Nodes are starting."]),
        (NodeState.READY, (), ["no topics", "Nobody publishes anything, and nobody listens."]),
        (
            NodeState.READY,
            (ROSOUT,),
            ["no topics of the robot", "There are only those of ROS itself: a shows them."],
        ),
    ],
)
async def test_why_there_is_no_topic_is_told(
    stage: TopicsStage, state: NodeState, topics: tuple[TopicRow, ...], words: list[str]
) -> None:
    assert isinstance(stage.app.feed.link, RecordedSession)
    stage.app.feed.link.set_state("camera", state)
    await stage.show(lesson_update(time_s=NOW_S + 1, topics=topics))
    lines = [stage.screen.table.render_line(y).text.strip() for y in (1, 2)]
    assert lines == words


async def test_a_qos_mismatch_names_who_and_what_to_change(stage: TopicsStage) -> None:
    facts = {
        "policy": "reliability", "publisher": "/lidar", "subscriber": "/brain",
        "offered": "best_effort", "requested": "reliable",
    }  # fmt: skip
    await stage.choose(SONAR)
    await stage.show(
        with_row(row(SONAR, trouble=Trouble.QOS_MISMATCH, hz=None, age_s=None, facts=facts))
    )
    words = " ".join(stage.echo().split())
    assert words.startswith("QoS is incompatible")
    assert "/brain does not hear /lidar: reliability reliable is asked for" in words
    assert "Let /lidar offer reliable, or let /brain ask for best_effort." in words


async def test_a_package_that_can_be_had_is_told_by_its_names(stage: TopicsStage) -> None:
    facts = {
        "type": "nav_msgs/msg/Path", "package": "nav_msgs", "reason": "not installed",
        "apt": "ros-jazzy-nav-msgs", "pixi": "ros-jazzy-nav-msgs",
    }  # fmt: skip
    await stage.choose(SONAR)
    without = row(SONAR, trouble=Trouble.UNKNOWN_TYPE, hz=9.0, age_s=0.1, facts=facts)
    await stage.show(with_row(without))
    words = " ".join(stage.echo().split())
    assert "install nav_msgs by `apt install ros-jazzy-nav-msgs` or `pixi add ros-" in words
    assert "pip" not in words
    await stage.show(with_row(replace(without, facts={**facts, "pip": "ros-jazzy-nav-msgs"})))
    assert "by `pip install ros-jazzy-nav-msgs`, `apt" in " ".join(stage.echo().split())


async def test_a_quiet_topic_keeps_its_last_message_and_says_for_how_long(
    stage: TopicsStage,
) -> None:
    await stage.choose(SONAR)
    await stage.show(lesson_update())
    publisher = EndpointInfo("/sonar_front", "std_msgs/msg/Float32", "reliable", "volatile")
    await stage.show(
        with_row(row(SONAR, trouble=Trouble.QUIET, hz=0.0, age_s=7.4, published_by=(publisher,)))
    )
    assert "data:    1.84" in stage.echo()
    _name, state, ends = stage.head().splitlines()
    assert state.startswith("no data for 7 s")
    assert ends.startswith("sonar_front → ")


async def test_a_pause_holds_the_message_and_says_so(stage: TopicsStage) -> None:
    await stage.choose(SONAR)
    await stage.show(lesson_update())
    await stage.pilot.press("p")
    newer = sample(SONAR, "std_msgs/msg/Float32", {"data": 0.5}, 8)
    await stage.show(lesson_update(samples={SONAR: (newer,)}))
    assert "1.84" in stage.echo()
    assert "PAUSED" in stage.head()
    assert "p Resume" in stage.screen.query_one(KeyBar).render().plain
    await stage.pilot.press("p")
    await stage.pilot.pause()
    assert "0.5" in stage.echo()
    assert "PAUSED" not in stage.head()


@pytest.mark.parametrize("key", ["y", "н"])
async def test_the_message_is_copied_as_yaml(stage: TopicsStage, key: str) -> None:
    await stage.choose("/drive")
    await stage.show(lesson_update())
    await stage.pilot.press(key)
    assert "steering_angle: 0.5" in stage.app.clipboard


async def test_the_filter_narrows_down_as_one_types_and_escape_ends_it(stage: TopicsStage) -> None:
    await stage.pilot.press("slash", *"audio", "space", *"mic")
    await stage.pilot.pause()
    assert [row.name for row in stage.screen.table.shown] == ["/audio/mic_raw"]
    assert stage.screen.filter.value == "audio mic"
    assert not stage.app.emergency.state.engaged
    await stage.pilot.press("enter")
    assert stage.screen.table.has_focus
    await stage.pilot.press("escape")
    await stage.pilot.pause()
    assert len(stage.screen.table.shown) == 11


async def test_keys_sort_turn_round_and_show_the_topics_of_ros_itself(stage: TopicsStage) -> None:
    await stage.pilot.press("greater_than_sign", "greater_than_sign")
    assert stage.screen.table.order.column_id == "publishers"
    await stage.pilot.press("less_than_sign")
    assert stage.screen.table.order.reverse
    await stage.pilot.press("a")
    await stage.pilot.pause()
    assert len(stage.screen.table.shown) == 13


async def test_an_observer_that_cannot_work_says_why(stage: TopicsStage) -> None:
    await stage.show(GraphUpdate(0.0, error="rclpy is missing: source ROS 2"))
    text = stage.screen.table.render_line(1).text + stage.screen.table.render_line(2).text
    assert "ROS cannot be observed" in text
    assert "rclpy is missing: source ROS 2" in text


async def test_five_megabytes_are_shown_with_few_objects_and_cut(stage: TopicsStage) -> None:
    cloud = {
        "height": 1, "width": 312_500, "point_step": 16, "row_step": 5_000_000,
        "data": bytes(5_000_000), "ranges": np.zeros(1_250_000, np.float32),
    }  # fmt: skip
    await stage.choose(SONAR)
    said = sample(SONAR, "sensor_msgs/msg/PointCloud2", cloud, 5_000_000)
    before = sys.getallocatedblocks()
    stage.screen.detail.show_message(said)
    assert sys.getallocatedblocks() - before < 5000
    assert "(5000000 bytes)" in stage.echo()
    assert "(1250000 items)" in stage.echo()
    tree = stage.screen.detail.echo
    tree.focus()
    await stage.pilot.press("end", "enter")
    assert "… 1249800 more items" in tree._lines[-1].text
