"""The screen of topics: what it asks of the graph, and what it shows in every case."""

from __future__ import annotations

import sys
from collections.abc import AsyncIterator
from dataclasses import replace

import numpy as np
import pytest
from textual.events import Key

from graph.data import EndpointInfo, GraphUpdate, TopicRow, Trouble
from launcher.status import NodeState
from tests.tui.recorded import NOW_S, TOPICS, RecordedSession, lesson_update, sample
from tests.tui.snapshots import Look, settle
from tests.tui.topics_room import CAMERA, SONAR, Room, opened, row, with_row
from tui.frame.key_bar import KeyBar
from tui.topics.detail import TopicHead

ROSOUT = TopicRow("/rosout", ("rcl_interfaces/msg/Log",), 1, 0)


@pytest.fixture
async def room() -> AsyncIterator[Room]:
    async with opened() as room:
        yield room


async def test_all_rates_are_measured_while_the_screen_is_in_front(room: Room) -> None:
    assert room.measures()
    await room.pilot.press("4")
    await settle(room.pilot)
    assert not room.measures()
    assert room.graph.watched == set()


async def test_only_the_chosen_topic_is_decoded(room: Room) -> None:
    await room.choose(SONAR)
    await room.show(lesson_update())
    assert "data:    1.84" in room.echo()
    assert "std_msgs/msg/Float32" in room.head()
    assert (
        "1.0 Hz · 8 B/s · age <1 s · jitter – · latency – · lost – · 8 B a message" in room.head()
    )


async def test_what_takes_a_message_is_offered_when_one_is_there(room: Room) -> None:
    def offered() -> set[str]:
        keys = room.screen.query_one(KeyBar).keys()
        return {key.title for key in keys}

    await room.choose(SONAR)
    await room.show(lesson_update())
    assert {"Plot field", "Copy"} <= offered()
    await room.choose("/drive")
    assert {"Plot field", "Copy"}.isdisjoint(offered())
    await room.pilot.press("y")
    await room.pilot.pause()
    assert "There is no message to copy." in [one.message for one in room.app._notifications]
    await room.choose(SONAR)
    await room.show(lesson_update())
    assert {"Plot field", "Copy"} <= offered()


async def test_walking_past_topics_subscribes_none_of_them(
    room: Room, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The one that is chosen first is asked for at first.
    for _round in range(500):
        if room.graph.watched:
            break
        await room.pilot.pause(0.02)
    asked: list[set[str]] = []
    monkeypatch.setattr(room.graph, "watch", lambda topics: asked.append(set(topics)))
    # However long the keys take here, they come before the walk is over.
    monkeypatch.setattr("tui.topics.screen.SETTLED_S", 3600.0)
    await room.pilot.press("down", "down", "down")
    assert not asked
    monkeypatch.setattr("tui.topics.screen.SETTLED_S", 0.01)
    await room.pilot.press("down")
    for _round in range(500):
        await room.pilot.pause(0.02)
        if asked:
            break
    assert asked == [{"/drive"}]


async def test_nobody_who_publishes_is_told(room: Room) -> None:
    await room.choose("/emergency_stop")
    assert room.echo().startswith("nobody publishes this topic\nStart the node")


async def test_a_topic_that_only_deck_publishes_is_not_said_to_have_a_silent_publisher(
    room: Room,
) -> None:
    await room.choose(SONAR)
    quiet = row(SONAR, trouble=Trouble.QUIET, publishers=0, age_s=None, hz=None, bytes_per_s=None)
    await room.show(with_row(quiet))
    assert room.echo() == "only Deck itself publishes here\nIt has sent nothing yet."


async def test_topics_that_only_deck_knows_are_not_listed(room: Room) -> None:
    ours = TopicRow("/llm_result", ("std_msgs/msg/String",), 0, 0, trouble=Trouble.NO_PUBLISHER)
    await room.show(lesson_update())
    count = room.count()
    await room.show(with_row(ours))
    assert "/llm_result" not in [row.name for row in room.screen.table.shown]
    assert room.count() == count


async def test_the_chosen_topic_stays_when_everybody_has_left_it(room: Room) -> None:
    await room.choose(SONAR)
    left = row(SONAR, publishers=0, subscribers=0, trouble=Trouble.NO_PUBLISHER)
    await room.show(with_row(left))
    assert room.screen.table.chosen == SONAR
    await room.choose(CAMERA)
    await room.show(with_row(left))
    assert SONAR not in [row.name for row in room.screen.table.shown]


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
    room: Room, state: NodeState, topics: tuple[TopicRow, ...], words: list[str]
) -> None:
    assert isinstance(room.app.feed.link, RecordedSession)
    room.app.feed.link.set_state("camera", state)
    await room.show(lesson_update(time_s=NOW_S + 1, topics=topics))
    lines = [room.screen.table.render_line(y).text.strip() for y in (1, 2)]
    assert lines == words


@pytest.mark.parametrize(
    ("more", "words"),
    [(0, "11 из 13 топиков"), (7, "11 из 20 топиков"), (8, "11 из 21 топика")],
)
async def test_of_how_many_topics_is_told_in_good_russian(
    room: Room, more: int, words: str
) -> None:
    room.app.speak("ru")
    hidden = tuple(replace(ROSOUT, name=f"/_hidden/{number}") for number in range(more))
    await room.show(lesson_update(time_s=NOW_S + 1, topics=(*TOPICS, *hidden)))
    assert room.count() == words


async def test_a_qos_mismatch_names_who_and_what_to_change(room: Room) -> None:
    facts = {
        "policy": "reliability", "publisher": "/lidar", "subscriber": "/brain",
        "offered": "best_effort", "requested": "reliable",
    }  # fmt: skip
    await room.choose(SONAR)
    await room.show(
        with_row(row(SONAR, trouble=Trouble.QOS_MISMATCH, hz=None, age_s=None, facts=facts))
    )
    words = " ".join(room.echo().split())
    assert words.startswith("QoS is incompatible")
    assert "/brain does not hear /lidar: reliability reliable is asked for" in words
    assert "Let /lidar offer reliable, or let /brain ask for best_effort." in words


async def test_an_unknown_type_names_its_package(room: Room) -> None:
    facts = {"type": "my_msgs/msg/Thing", "package": "my_msgs", "reason": "not installed"}
    await room.choose(SONAR)
    await room.show(
        with_row(row(SONAR, trouble=Trouble.UNKNOWN_TYPE, hz=None, age_s=None, facts=facts))
    )
    assert "install the package my_msgs" in " ".join(room.echo().split())


async def test_a_package_that_can_be_had_is_told_by_its_names(room: Room) -> None:
    facts = {
        "type": "nav_msgs/msg/Path", "package": "nav_msgs", "reason": "not installed",
        "apt": "ros-jazzy-nav-msgs", "pixi": "ros-jazzy-nav-msgs",
    }  # fmt: skip
    await room.choose(SONAR)
    without = row(SONAR, trouble=Trouble.UNKNOWN_TYPE, hz=9.0, age_s=0.1, facts=facts)
    await room.show(with_row(without))
    words = " ".join(room.echo().split())
    assert "install nav_msgs by `apt install ros-jazzy-nav-msgs` or `pixi add ros-" in words
    assert "pip" not in words
    await room.show(with_row(replace(without, facts={**facts, "pip": "ros-jazzy-nav-msgs"})))
    assert "by `pip install ros-jazzy-nav-msgs`, `apt" in " ".join(room.echo().split())


async def test_a_quiet_topic_keeps_its_last_message_and_says_for_how_long(room: Room) -> None:
    await room.choose(SONAR)
    await room.show(lesson_update())
    publisher = EndpointInfo("/sonar_front", "std_msgs/msg/Float32", "reliable", "volatile")
    await room.show(
        with_row(row(SONAR, trouble=Trouble.QUIET, hz=0.0, age_s=7.4, published_by=(publisher,)))
    )
    assert "data:    1.84" in room.echo()
    _name, state, ends = room.head().splitlines()
    assert state.startswith("no data for 7 s")
    assert ends.startswith("sonar_front → ")


async def test_what_is_not_measured_says_so(room: Room) -> None:
    await room.show(with_row(row(SONAR, measured=False, hz=None, bytes_per_s=None, age_s=None)))
    await room.choose(SONAR)
    assert "not measured: Deck is not subscribed" in room.head()


async def test_a_pause_holds_the_message_and_says_so(room: Room) -> None:
    await room.choose(SONAR)
    await room.show(lesson_update())
    await room.pilot.press("p")
    newer = sample(SONAR, "std_msgs/msg/Float32", {"data": 0.5}, 8)
    await room.show(lesson_update(samples={SONAR: (newer,)}))
    assert "1.84" in room.echo()
    assert "PAUSED" in room.head()
    assert "p Resume" in room.screen.query_one(KeyBar).render().plain
    await room.pilot.press("p")
    await room.pilot.pause()
    assert "0.5" in room.echo()
    assert "PAUSED" not in room.head()


@pytest.mark.parametrize("key", ["y", "н"])
async def test_the_message_is_copied_as_yaml(room: Room, key: str) -> None:
    await room.choose("/drive")
    await room.show(lesson_update())
    await room.pilot.press(key)
    assert "steering_angle: 0.5" in room.app.clipboard


async def test_without_a_message_there_is_nothing_to_copy(room: Room) -> None:
    await room.choose("/emergency_stop")
    await room.pilot.press("y")
    assert room.app.clipboard == ""


async def test_the_filter_narrows_down_as_one_types_and_escape_ends_it(room: Room) -> None:
    await room.pilot.press("slash", *"audio", "space", *"mic")
    await room.pilot.pause()
    assert [row.name for row in room.screen.table.shown] == ["/audio/mic_raw"]
    assert room.screen.filter.value == "audio mic"
    assert not room.app.emergency.state.engaged
    await room.pilot.press("enter")
    assert room.screen.table.has_focus
    await room.pilot.press("escape")
    await room.pilot.pause()
    assert len(room.screen.table.shown) == 11


async def test_what_is_typed_without_a_pause_after_the_key_is_in_the_filter(room: Room) -> None:
    for key in ("slash", *"sonar"):
        room.app.post_message(Key(key, "/" if key == "slash" else key))
    await room.pilot.pause()
    assert room.screen.filter.value == "sonar"
    await room.pilot.press("slash", "f")
    assert room.screen.filter.value == "sonar/f"


async def test_space_stops_the_robot_from_table_and_tree(room: Room) -> None:
    for widget in (room.screen.table, room.screen.detail.echo):
        room.app.emergency.forget()
        widget.focus()
        await room.pilot.press("space")
        await room.pilot.pause()
        assert room.app.emergency.state.engaged


async def test_keys_sort_turn_round_and_show_the_topics_of_ros_itself(room: Room) -> None:
    await room.pilot.press("greater_than_sign", "greater_than_sign")
    assert room.screen.table.order.column_id == "publishers"
    await room.pilot.press("less_than_sign")
    assert room.screen.table.order.reverse
    await room.pilot.press("a")
    await room.pilot.pause()
    assert len(room.screen.table.shown) == 13


async def test_an_observer_that_cannot_work_says_why(room: Room) -> None:
    await room.show(GraphUpdate(0.0, error="rclpy is missing: source ROS 2"))
    text = room.screen.table.render_line(1).text + room.screen.table.render_line(2).text
    assert "ROS cannot be observed" in text
    assert "rclpy is missing: source ROS 2" in text


async def test_the_language_changes_under_the_screen(room: Room) -> None:
    await room.choose("/emergency_stop")
    await room.pilot.press("f9")
    await room.pilot.pause()
    assert room.echo().startswith("никто не публикует")
    assert "Топик" in room.screen.table.render_line(0).text


async def test_any_size_is_survived(room: Room) -> None:
    for size in ((1, 1), (10, 4), (30, 8), (59, 19)):
        await room.choose(CAMERA)
        await room.pilot.resize_terminal(*size)
        await room.show(lesson_update())
        await room.choose(SONAR)
        await room.show(lesson_update())


async def test_five_megabytes_are_shown_with_few_objects_and_cut(room: Room) -> None:
    cloud = {
        "height": 1, "width": 312_500, "point_step": 16, "row_step": 5_000_000,
        "data": bytes(5_000_000), "ranges": np.zeros(1_250_000, np.float32),
    }  # fmt: skip
    await room.choose(SONAR)
    said = sample(SONAR, "sensor_msgs/msg/PointCloud2", cloud, 5_000_000)
    before = sys.getallocatedblocks()
    room.screen.detail.show_message(said)
    assert sys.getallocatedblocks() - before < 5000
    assert "(5000000 bytes)" in room.echo()
    assert "(1250000 items)" in room.echo()
    tree = room.screen.detail.echo
    tree.focus()
    await room.pilot.press("end", "enter")
    assert "… 1249800 more items" in tree.lines[-1].text


async def test_a_name_longer_than_a_line_is_told_whole_above_its_message() -> None:
    name = "/robot/front_left/" + "a_rather_long_name_of_a_sonar/" * 3 + "END"
    async with opened(Look((80, 24), "en")) as room:
        await room.show(with_row(replace(row(SONAR), name=name)))
        await room.choose(name)
        head = room.screen.query_one(TopicHead)
        lines = [head.render_line(y).text for y in range(head.size.height)]
        assert name in "".join(lines)
        assert "std_msgs/msg/Float32" in lines[1]
        assert "1.0 Hz" in lines[2]
