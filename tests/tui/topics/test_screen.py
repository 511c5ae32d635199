"""The screen of topics: what it asks of the graph, what it shows, filters and draws as pictures."""

from __future__ import annotations

import threading
from collections.abc import AsyncIterator
from typing import Any

import pytest
from textual.widgets import Static

from graph.data import EndpointInfo, GraphUpdate, TopicRow, Trouble
from graph.pictures.picture import Picture
from graph.pictures.reading import read_picture
from graph.qos import Mismatch
from launcher.status import NodeState
from tests.tui.recorded import NOW_S, RecordedSession, lesson_update, sample
from tests.tui.topics_stage import CAMERA, SONAR, TopicsStage, jpeg_message, opened, row, with_camera, with_row
from tests.waiting import until
from text.sentences import say
from tui.frame.key_bar import KeyBar
from tui.session.past import SONARS
from tui.widgets import image_view as newest_picture

ROSOUT = TopicRow("/rosout", ("rcl_interfaces/msg/Log",), 1, 0)


@pytest.fixture
async def stage() -> AsyncIterator[TopicsStage]:
    async with opened() as stage:
        yield stage


async def test_only_the_chosen_topic_is_decoded(stage: TopicsStage) -> None:
    await stage.choose(SONAR)
    await stage.show(lesson_update())
    assert "data:    1.84" in stage.echo()
    assert "std_msgs/msg/Float32" in stage.head()
    assert "1.0 Hz · 8 B/s · age <1 s · jitter – · latency – · lost – · 8 B a message" in stage.head()


async def test_walking_past_topics_subscribes_none_of_them(
    stage: TopicsStage, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The one that is chosen first is asked for at first.
    await until(lambda: stage.graph.wanted.watched - set(SONARS), "the first topic asked for")
    asked: list[set[str]] = []
    monkeypatch.setattr(stage.graph, "want", lambda interest: asked.append(set(interest.watched)))
    # However long the keys take here, they come before the walk is over.
    monkeypatch.setattr("tui.topics.screen.SETTLED_S", 3600.0)
    await stage.pilot.press("down", "down", "down")
    assert not asked
    monkeypatch.setattr("tui.topics.screen.SETTLED_S", 0.01)
    await stage.pilot.press("down")
    await until(lambda: asked, "the last topic asked for")
    assert [topics - set(SONARS) for topics in asked] == [{"/drive"}]


@pytest.mark.parametrize(
    ("state", "topics", "words"),
    [
        (NodeState.STARTING, (ROSOUT,), ["no topics yet", "Nodes are starting."]),
        (NodeState.READY, (), ["no topics", "Nobody publishes anything, and nobody listens."]),
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
    found = Mismatch("reliability", "/lidar", "/brain", "best_effort", "reliable")
    detail = say("{what} {mend}", what=found.what, mend=found.mend)
    await stage.choose(SONAR)
    await stage.show(with_row(row(SONAR, trouble=Trouble.QOS_MISMATCH, hz=None, age_s=None, detail=detail)))
    words = " ".join(stage.echo().split())
    assert words.startswith("QoS is incompatible")
    assert "/brain does not hear /lidar: reliability reliable is asked for" in words
    assert "Let /lidar offer reliable, or let /brain ask for best_effort." in words


async def test_a_quiet_topic_keeps_its_last_message_and_says_for_how_long(stage: TopicsStage) -> None:
    await stage.choose(SONAR)
    await stage.show(lesson_update())
    publisher = EndpointInfo("/sonar_front", "std_msgs/msg/Float32", "reliable", "volatile")
    await stage.show(with_row(row(SONAR, trouble=Trouble.QUIET, hz=0.0, age_s=7.4, published_by=(publisher,))))
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


async def test_the_message_is_copied_as_yaml(stage: TopicsStage) -> None:
    await stage.choose("/drive")
    await stage.show(lesson_update())
    await stage.pilot.press("н")
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


def sonar(*metres: float) -> GraphUpdate:
    """So many messages of the sonar in one update."""
    values = tuple(sample(SONAR, "std_msgs/msg/Float32", {"data": each}) for each in metres)
    return lesson_update(samples={SONAR: values})


async def only_if(stage: TopicsStage, expression: str) -> None:
    """Choose the sonar, and let only messages through for which this holds."""
    await stage.choose(SONAR)
    await stage.pilot.press("f")
    field = stage.screen.detail.filter.field
    assert field.has_focus
    field.value = expression
    await stage.pilot.pause()
    await stage.pilot.pause()


def filter_line(stage: TopicsStage) -> str:
    return str(stage.screen.query_one(".filter-told", Static).content)


async def test_only_messages_are_shown_for_which_the_expression_holds(stage: TopicsStage) -> None:
    await only_if(stage, "m.data > 0.5")
    # Each message is looked at, not the newest of an update alone.
    assert SONAR in stage.graph.wanted.followed
    await stage.show(sonar(0.7, 0.2, 0.3))
    assert "0.7" in stage.echo()
    assert filter_line(stage) == "1 of 3 messages"
    await stage.show(sonar(0.1))
    assert "0.7" in stage.echo()
    await stage.show(sonar(0.9))
    assert "0.9" in stage.echo()
    assert filter_line(stage) == "2 of 5 messages"


async def test_an_expression_that_is_wrong_names_the_place_and_lets_nothing_through(stage: TopicsStage) -> None:
    await stage.choose(SONAR)
    await only_if(stage, "m.data > 0.5 and data")
    told = "✗ column 18: data: the message is called m: write m.data"
    assert filter_line(stage) == told
    await stage.show(sonar(0.8))
    assert filter_line(stage) == told
    assert "the expression is wrong" in stage.echo()


async def test_an_image_is_a_picture_and_can_be_a_tree(stage: TopicsStage) -> None:
    await stage.choose(CAMERA)
    await stage.show(lesson_update())
    assert stage.as_picture()
    assert stage.screen.detail.picture.caption == "bgr8 640×480 · 10.0 Hz"
    await stage.pilot.press("i")
    assert not stage.as_picture()
    assert "(921600 bytes)" in stage.echo()
    await stage.show(lesson_update())
    assert not stage.as_picture()


@pytest.mark.parametrize(
    ("encoding", "words"), [("nv21", "pictures of the encoding nv21 cannot be shown"), ("32FC1", "no valid depth")]
)
async def test_a_picture_that_cannot_be_shown_is_told(stage: TopicsStage, encoding: str, words: str) -> None:
    await stage.choose(CAMERA)
    size = {"width": 2, "height": 2, "step": 8, "is_bigendian": 0}
    image = {**size, "encoding": encoding, "data": bytes(16)}
    await stage.show(with_camera("sensor_msgs/msg/Image", image))
    assert stage.screen.detail.picture.words[0] == words


async def test_late_pictures_are_left_out_while_one_is_decoded(
    stage: TopicsStage, monkeypatch: pytest.MonkeyPatch
) -> None:
    release = threading.Event()
    seen: list[object] = []

    def slow(type_name: str, value: Any, fit: Any) -> Picture:
        seen.append(value["number"])
        assert release.wait(30)
        return read_picture(type_name, value, fit)

    monkeypatch.setattr(newest_picture, "read_picture", slow)
    await stage.choose(CAMERA)
    for number in range(5):
        value = {**jpeg_message(), "number": number}
        await stage.show(with_camera("sensor_msgs/msg/CompressedImage", value))
    release.set()
    await stage.decoded()
    assert seen == [0, 4]
