"""The screen of topics: what it asks of the graph, and what it shows in every case."""

from __future__ import annotations

import sys
import threading
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import cv2
import numpy as np
import pytest
from textual.events import Key
from textual.widgets import Static

from graph.data import EndpointInfo, GraphUpdate, TopicRow, Trouble
from graph.pictures import Picture, read_picture
from launcher.status import NodeState
from tests.tui.recorded import (
    NOW_S,
    TOPICS,
    RecordedGraph,
    RecordedPad,
    RecordedSession,
    lesson_update,
    sample,
)
from tests.tui.recorded_image import colour_bars
from tests.tui.snapshots import Look, settle
from tui.screens import topics_pictures
from tui.screens.topics import TopicsScreen
from tui.widgets.key_bar import KeyBar
from tui.widgets.topic_detail import TopicHead

if TYPE_CHECKING:
    from textual.pilot import Pilot

    from tui.app import DeckApp

HOME = Look((120, 40), "en")
SONAR, CAMERA = "/sensor/sonar_front", "/camera/color/image_raw"


class Room:
    """The screen of topics over a recorded graph, under a pilot."""

    def __init__(self, app: DeckApp, pilot: Pilot[Any], graph: RecordedGraph) -> None:
        self.app, self.pilot, self.graph = app, pilot, graph

    @property
    def screen(self) -> TopicsScreen:
        """The screen."""
        screen = self.app.screen
        assert isinstance(screen, TopicsScreen)
        return screen

    async def choose(self, topic: str) -> None:
        """Choose a topic and wait until it is asked for."""
        self.screen.table.choose(topic)
        for _round in range(100):
            await self.pilot.pause(0.02)
            if self.graph.watched == {topic}:
                return
        pytest.fail(f"{topic} is not watched: {self.graph.watched}")

    async def show(self, update: GraphUpdate) -> None:
        """Let the graph be this, and wait until it is drawn."""
        self.graph.show(update)
        await self.pilot.pause()
        await self.pilot.pause()

    async def decoded(self) -> None:
        """Wait until no picture is being decoded."""
        under_way = [worker for worker in self.app.workers if worker.group == "pictures"]
        if under_way:
            await self.app.workers.wait_for_complete(under_way)
        await self.pilot.pause()

    def head(self) -> str:
        """The lines above the message."""
        return self.screen.query_one(TopicHead).render().plain

    def count(self) -> str:
        """How many topics are said to be there."""
        return str(self.screen.query_one("#topics-count", Static).content)

    def echo(self) -> str:
        """The message, or the words in its place."""
        tree = self.screen.detail.echo
        return "\n".join(tree.render_line(y).text.rstrip() for y in range(tree.size.height)).strip()


def row(name: str, **more: Any) -> TopicRow:
    return replace(next(row for row in TOPICS if row.name == name), **more)


def with_row(changed: TopicRow, **samples: Any) -> GraphUpdate:
    others = [row for row in TOPICS if row.name != changed.name]
    return lesson_update(topics=(*others, changed), samples=samples)


@pytest.fixture
def graph() -> RecordedGraph:
    return RecordedGraph()


@pytest.fixture
async def room(graph: RecordedGraph) -> Any:
    app = HOME.app("topics", RecordedPad(graph=graph))
    async with app.run_test(size=HOME.size) as pilot:
        await settle(pilot)
        yield Room(app, pilot, graph)


async def test_all_rates_are_measured_while_the_screen_is_in_front(room: Room) -> None:
    assert room.graph.measured
    await room.pilot.press("4")
    await settle(room.pilot)
    assert not room.graph.measured
    assert room.graph.watched == set()


async def test_only_the_chosen_topic_is_decoded(room: Room) -> None:
    await room.choose(SONAR)
    await room.show(lesson_update())
    assert "data:    1.84" in room.echo()
    assert "std_msgs/msg/Float32" in room.head()
    assert (
        "1.0 Hz · 8 B/s · age <1 s · jitter – · latency – · lost – · 8 B a message" in room.head()
    )


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
    monkeypatch.setattr("tui.screens.topics.SETTLED_S", 3600.0)
    await room.pilot.press("down", "down", "down")
    assert not asked
    monkeypatch.setattr("tui.screens.topics.SETTLED_S", 0.01)
    await room.pilot.press("down")
    for _round in range(500):
        await room.pilot.pause(0.02)
        if asked:
            break
    assert asked == [{"/drive"}]


async def test_an_image_is_a_picture_and_can_be_a_tree(room: Room) -> None:
    await room.choose(CAMERA)
    await room.show(lesson_update())
    assert room.screen.detail.as_picture
    assert room.screen.detail.picture.caption == "bgr8 640×480 · 10.0 Hz"
    await room.pilot.press("i")
    assert not room.screen.detail.as_picture
    assert "(921600 bytes)" in room.echo()
    await room.show(lesson_update())
    assert not room.screen.detail.as_picture


async def test_a_picture_that_cannot_be_shown_is_told(room: Room) -> None:
    await room.choose(CAMERA)
    odd = {"width": 2, "height": 2, "step": 4, "encoding": "nv21", "data": b"1234"}
    await room.show(
        lesson_update(samples={CAMERA: (sample(CAMERA, "sensor_msgs/msg/Image", odd),)})
    )
    headline, detail = room.screen.detail.picture.words
    assert headline == "pictures of the encoding nv21 cannot be shown"
    assert "rgb8" in detail


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


ROSOUT = TopicRow("/rosout", ("rcl_interfaces/msg/Log",), 1, 0)


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
    assert not room.app.brake.state.engaged
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
        room.app.brake.forget()
        widget.focus()
        await room.pilot.press("space")
        await room.pilot.pause()
        assert room.app.brake.state.engaged


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


def depth_message() -> dict[str, Any]:
    """A slope from half a metre to four, without a reading at the left."""
    numbers = np.repeat(np.linspace(520, 3970, 64)[None, :], 48, axis=0).astype("<u2")
    numbers[:, :6] = 0
    size = {"width": 64, "height": 48, "step": 128, "encoding": "16UC1", "is_bigendian": 0}
    return {**size, "data": numbers.tobytes()}


def jpeg_message(cut_to: int | None = None) -> dict[str, Any]:
    """The recorded camera's picture as JPEG, or its beginning only."""
    pixels = np.frombuffer(colour_bars(), np.uint8).reshape(480, 640, 3)
    return {"format": "jpeg", "data": cv2.imencode(".jpg", pixels)[1].tobytes()[:cut_to]}


def with_camera(type_name: str, value: dict[str, Any]) -> GraphUpdate:
    """The lesson with a camera that says this."""
    return with_row(
        row(CAMERA, type_names=(type_name,)), **{CAMERA: (sample(CAMERA, type_name, value),)}
    )


async def test_depth_has_a_scale_in_metres(room: Room) -> None:
    await room.choose(CAMERA)
    await room.show(with_camera("sensor_msgs/msg/Image", depth_message()))
    view = room.screen.detail.picture
    assert view.caption == "16UC1 64×48 · 10.0 Hz"
    scale = view.render_line(view.size.height - 2).text
    assert scale.strip().startswith("near 0.5 m")
    assert scale.strip().endswith("4 m far")


async def test_no_picture_of_the_topic_before_stays_while_the_line_is_busy(room: Room) -> None:
    await room.choose(CAMERA)
    await room.show(with_camera("sensor_msgs/msg/Image", depth_message()))
    view = room.screen.detail.picture
    assert view.has_picture
    room.pilot.app.bandwidth.behind = True
    await room.choose("/drive")
    assert not view.has_picture
    await room.choose(CAMERA)
    await room.show(with_camera("sensor_msgs/msg/CompressedImage", jpeg_message()))
    await room.decoded()
    assert view.caption == "jpeg 640×480 · 10.0 Hz"


async def test_a_compressed_image_is_decoded_and_shown(room: Room) -> None:
    await room.choose(CAMERA)
    await room.show(with_camera("sensor_msgs/msg/CompressedImage", jpeg_message()))
    await room.decoded()
    assert room.screen.detail.picture.caption == "jpeg 640×480 · 10.0 Hz"


async def test_a_compressed_image_that_is_cut_short_says_so(room: Room) -> None:
    await room.choose(CAMERA)
    await room.show(with_camera("sensor_msgs/msg/CompressedImage", jpeg_message(5000)))
    await room.decoded()
    headline, detail = room.screen.detail.picture.words
    assert headline == "this picture cannot be shown"
    assert detail == "the JPEG data are cut short: no end in 5000 bytes"


async def test_late_pictures_are_left_out_while_one_is_decoded(
    room: Room, monkeypatch: pytest.MonkeyPatch
) -> None:
    release = threading.Event()
    seen: list[object] = []

    def slow(type_name: str, value: Any, fit: Any) -> Picture:
        seen.append(value["number"])
        assert release.wait(30)
        return read_picture(type_name, value, fit)

    monkeypatch.setattr(topics_pictures, "read_picture", slow)
    await room.choose(CAMERA)
    for number in range(5):
        value = {**jpeg_message(), "number": number}
        await room.show(with_camera("sensor_msgs/msg/CompressedImage", value))
    release.set()
    await room.decoded()
    assert seen == [0, 4]


async def test_a_picture_asks_for_ten_updates_a_second_and_rates_stay_as_they_are(
    room: Room,
) -> None:
    await room.choose(CAMERA)
    assert room.graph.period_s == 0.25
    await room.show(lesson_update())
    assert room.graph.period_s == 0.1
    faster = [replace(one, hz=99.0) for one in TOPICS]
    await room.show(lesson_update(time_s=NOW_S + 0.1, topics=tuple(faster)))
    assert room.screen.table.chosen_row.hz == 10.0  # type: ignore[union-attr]
    await room.show(lesson_update(time_s=NOW_S + 0.2, topics=tuple(faster)))
    assert room.screen.table.chosen_row.hz == 99.0  # type: ignore[union-attr]
    for key in ("p", "e", "i"):
        await room.pilot.press(key)
        await room.pilot.pause()
        assert room.graph.period_s == 0.25, key
        await room.pilot.press(key)
        await room.pilot.pause()
        assert room.graph.period_s == 0.1, key
    await room.choose(SONAR)
    assert room.graph.period_s == 0.25


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


def sonar(*metres: float) -> GraphUpdate:
    """So many messages of the sonar in one update."""
    values = tuple(sample(SONAR, "std_msgs/msg/Float32", {"data": each}) for each in metres)
    return lesson_update(samples={SONAR: values})


async def only_if(room: Room, expression: str) -> None:
    """Choose the sonar, and let only messages through for which this holds."""
    await room.choose(SONAR)
    await room.pilot.press("f")
    field = room.screen.detail.filter.field
    assert field.has_focus
    field.value = expression
    await room.pilot.pause()
    await room.pilot.pause()


def filter_line(room: Room) -> str:
    """What is said beside the expression."""
    return str(room.screen.query_one(".filter-told", Static).content)


async def test_only_messages_are_shown_for_which_the_expression_holds(room: Room) -> None:
    await only_if(room, "m.data > 0.5")
    # Each message is looked at, not the newest of an update alone.
    assert SONAR in room.graph.followed
    await room.show(sonar(0.7, 0.2, 0.3))
    assert "0.7" in room.echo()
    assert filter_line(room) == "1 of 3 messages"
    await room.show(sonar(0.1))
    assert "0.7" in room.echo()
    await room.show(sonar(0.9))
    assert "0.9" in room.echo()
    assert filter_line(room) == "2 of 5 messages"


async def test_a_message_that_does_not_fit_goes_out_of_sight_and_comes_back(room: Room) -> None:
    await room.choose(SONAR)
    await room.show(sonar(0.25))
    assert "0.25" in room.echo()
    await only_if(room, "m.data > 0.5")
    assert room.echo().splitlines()[0] == "no message fits the expression yet"
    assert "0 of 1 message" in room.echo()
    await room.pilot.press("escape")
    assert "0.25" in room.echo()
    assert not room.screen.detail.filter.display
    assert SONAR not in room.graph.followed


async def test_each_topic_has_its_own_expression(room: Room) -> None:
    await only_if(room, "m.data > 0.5")
    room.screen.table.focus()
    await room.choose("/drive")
    assert not room.screen.detail.filter.display
    await room.show(lesson_update())
    assert "speed" in room.echo()
    await room.choose(SONAR)
    assert room.screen.detail.filter.field.value == "m.data > 0.5"
    await room.show(sonar(0.1, 0.8))
    assert "0.8" in room.echo()
    assert filter_line(room) == "1 of 2 messages"


async def test_an_expression_that_is_wrong_names_the_place_and_lets_nothing_through(
    room: Room,
) -> None:
    await room.choose(SONAR)
    await only_if(room, "m.data > 0.5 and data")
    told = "✗ column 18: data: the message is called m: write m.data"
    assert filter_line(room) == told
    await room.show(sonar(0.8))
    assert filter_line(room) == told
    assert "the expression is wrong" in room.echo()


async def test_a_field_that_is_missing_is_told_once_and_counted(room: Room) -> None:
    await only_if(room, "m.dat > 0.5")
    await room.show(sonar(0.8, 0.9))
    await room.show(sonar(0.8))
    told = "0 of 3 messages · ✗ column 1: m.dat: no such field; did you mean data? (×3)"
    assert filter_line(room) == told
    assert not room.app._notifications


async def test_what_fits_while_another_screen_is_in_front_is_seen_when_one_comes_back(
    room: Room,
) -> None:
    await only_if(room, "m.data > 5")
    await room.app.show_screen("logs")
    assert SONAR in room.graph.followed
    await room.show(sonar(7.5, 0.1))
    await room.app.show_screen("topics")
    await room.show(sonar(0.2))
    assert "7.5" in room.echo()
    assert filter_line(room) == "1 of 3 messages"


async def test_a_name_longer_than_a_line_is_told_whole_above_its_message() -> None:
    name = "/robot/front_left/" + "a_rather_long_name_of_a_sonar/" * 3 + "END"
    graph = RecordedGraph()
    app = HOME.app("topics", RecordedPad(graph=graph))
    async with app.run_test(size=(80, 24)) as pilot:
        await settle(pilot)
        room = Room(app, pilot, graph)
        await room.show(with_row(replace(row(SONAR), name=name)))
        await room.choose(name)
        head = room.screen.query_one(TopicHead)
        lines = [head.render_line(y).text for y in range(head.size.height)]
        assert name in "".join(lines)
        assert "std_msgs/msg/Float32" in lines[1]
        assert "1.0 Hz" in lines[2]
