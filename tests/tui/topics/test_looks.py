"""How the screen of topics looks, at three sizes and in both languages."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import replace
from math import nan, sin
from typing import Any

import pytest
from textual.pilot import Pilot

from graph.data import EndpointInfo, GraphUpdate, Trouble
from tests.tui.recorded import NOW_S, TOPICS, RecordedOpener, lesson_update, sample
from tests.tui.snapshots import Look, SnapCompare, every_look, one_look, settle
from tests.tui.topics_stage import CAMERA, depth_message, jpeg_message, with_camera
from tests.waiting import until
from tui.app import DeckApp
from tui.topics.detail import TopicDetail
from tui.topics.screen import TopicsScreen
from tui.widgets.image_view import ImageView

HOSTILE = (
    "[red]красный[/red] \x1b[31m\x1b]52;c;aGVsbG8=\x07\x00 \ud800 \u202eназад " + "1 MB " * 200_000
)

AWAITED = "awaited"
"""Stands in place of a picture that is to come."""

Before = Callable[[Pilot[Any]], Awaitable[None]]


def shown(topic: str, update: GraphUpdate | None = None, *keys: str) -> Before:
    """Choose this topic, let the graph be `update`, and press these keys."""

    async def before(pilot: Pilot[Any]) -> None:
        await settle(pilot)
        app = pilot.app
        assert isinstance(app, DeckApp)
        screen, graph = app.screen, app.feed.graph
        assert isinstance(screen, TopicsScreen)
        screen.table.choose(topic)
        await pilot.pause()
        graph.show(update or lesson_update())  # type: ignore[union-attr]
        await pilot.pause()
        await pilot.press(*keys)
        for _round in range(3):
            await pilot.pause()

    return before


@every_look
def test_a_message(look: Look, snap_compare: SnapCompare) -> None:
    """Topics with rates; /drive is chosen and stands as a tree: speed 0.3, steering 0.5."""
    before = shown("/drive")
    assert snap_compare(look.app("topics"), terminal_size=look.size, run_before=before)


@one_look
def test_messages_that_fit_an_expression(look: Look, dump_compare: SnapCompare) -> None:
    """Above the message stands the expression, and beside it that 1 of 1 messages fits."""
    before = shown("/drive", None, "f", *"m.drive.speed>0")
    assert dump_compare(look.app("topics"), terminal_size=look.size, run_before=before)


@one_look
def test_an_expression_that_is_wrong(look: Look, dump_compare: SnapCompare) -> None:
    """In red beside the expression: the column, the part, and what is wrong with it."""
    before = shown("/drive", None, "f", *"speed>0")
    assert dump_compare(look.app("topics"), terminal_size=look.size, run_before=before)


@one_look
def test_a_picture(look: Look, snap_compare: SnapCompare) -> None:
    """The camera is chosen: colour bars over a grey ramp, with encoding, size and rate below."""
    before = shown("/camera/color/image_raw")
    assert snap_compare(look.app("topics"), terminal_size=look.size, run_before=before)


@one_look
def test_troubles(look: Look, dump_compare: SnapCompare) -> None:
    """Sorted by state, troubles first, each a mark and a word; the QoS mismatch is explained."""
    publisher = EndpointInfo("/lidar", "std_msgs/msg/Float32", "best_effort", "volatile")
    subscriber = EndpointInfo("/ai_brain", "std_msgs/msg/Float32", "reliable", "volatile")
    facts = {
        "policy": "reliability", "publisher": "/lidar", "subscriber": "/ai_brain",
        "offered": "best_effort", "requested": "reliable",
    }  # fmt: skip
    empty = {"hz": None, "bytes_per_s": None, "age_s": None}
    changed: dict[str, dict[str, Any]] = {
        "/sensor/sonar_front": {
            "trouble": Trouble.QOS_MISMATCH, "facts": facts, "published_by": (publisher,),
            "subscribed_by": (subscriber,), **empty,
        },
        "/safety_state": {"trouble": Trouble.QUIET, "hz": 0.0, "age_s": 71.0},
        "/head_state": {"trouble": Trouble.UNKNOWN_TYPE, **empty},
        "/camera/color/image_raw": {"measured": False, **empty},
    }  # fmt: skip
    rows = tuple(replace(row, **changed.get(row.name, {})) for row in TOPICS)
    update = lesson_update(topics=rows, samples={})
    keys = ("greater_than_sign",) * (7 if look.size[0] >= 100 else 6)
    before = shown("/sensor/sonar_front", update, *keys)
    assert dump_compare(look.app("topics"), terminal_size=look.size, run_before=before)


@one_look
def test_endpoints(look: Look, dump_compare: SnapCompare) -> None:
    """Two mended by words above, a type that differs, then every endpoint with its policies."""
    kind = "std_msgs/msg/Float32"
    lidar = EndpointInfo("/lidar", kind, "best_effort", "volatile", 5, "keep_last", 0.1, 0.5, 2.0,
                         "manual_by_topic")  # fmt: skip
    front = EndpointInfo("/hearing", kind, "reliable", "transient_local", 1, "keep_last")
    brain = EndpointInfo("/ai_brain", kind, "reliable", "transient_local", liveliness="automatic")
    other = replace(front, node="/recorder", type_name="std_msgs/msg/Float64")
    ends: dict[str, Any] = {
        "published_by": (lidar, front), "subscribed_by": (brain, other), "publishers": 2,
        "type_names": (kind, "std_msgs/msg/Float64"), "jitter_s": 0.0123, "latency_s": 0.00045,
        "lost": 12,
    }  # fmt: skip
    rows = tuple(replace(row, **ends) if row.name == "/ai_command" else row for row in TOPICS)
    before = shown("/ai_command", lesson_update(topics=rows), "e")
    assert dump_compare(look.app("topics"), terminal_size=look.size, run_before=before)


@one_look
def test_a_plot_of_two_fields(look: Look, snap_compare: SnapCompare) -> None:
    """A wave with a gap and a line that steps, each with its letter, its range and its marks."""
    before = shown("/drive", None, "enter", "down", "down", "down", "down", "V")

    async def plot(pilot: Pilot[Any]) -> None:
        await shown("/sensor/sonar_front", None, "V")(pilot)
        await before(pilot)
        app = pilot.app
        assert isinstance(app, DeckApp)
        for step in range(0, 112, 8):
            # What is shown while the app does not come to it is one update.
            for quarter in range(step, step + 8):
                app.feed.graph.show(drive_and_sonar(quarter / 4))  # type: ignore[union-attr]
            await pilot.pause()
        for _round in range(3):
            await pilot.pause()

    assert snap_compare(look.app("topics"), terminal_size=look.size, run_before=plot)


async def drawn(pilot: Pilot[Any]) -> None:
    """Wait until the picture, or why there is none, is on the screen."""
    view = pilot.app.screen.query_one(TopicDetail).query_one(ImageView)
    await until(
        lambda: view.has_picture or view.words[0] not in {"", AWAITED}, "a picture or a word"
    )
    for _round in range(3):
        await pilot.pause()


@pytest.mark.parametrize(
    ("type_name", "value"),
    [
        pytest.param("sensor_msgs/msg/Image", depth_message(), id="depth"),
        pytest.param("sensor_msgs/msg/CompressedImage", jpeg_message(), id="jpeg"),
        pytest.param("sensor_msgs/msg/CompressedImage", jpeg_message(5000), id="broken"),
    ],
)
@one_look
def test_other_pictures(
    look: Look, snap_compare: SnapCompare, type_name: str, value: dict[str, Any]
) -> None:
    """Depth by colours with a scale in metres; the camera's bars from JPEG; why there are none."""
    before = shown(CAMERA, with_camera(type_name, value))

    async def decoded(pilot: Pilot[Any]) -> None:
        await before(pilot)
        await drawn(pilot)
        app = pilot.app
        assert isinstance(app, DeckApp)
        # The first one was thinned out to a size that the layout may have changed since, and
        # what was drawn before steadies the colours of what follows.
        app.screen.query_one(TopicDetail).picture.show_words(AWAITED)
        app.feed.graph.show(with_camera(type_name, value))  # type: ignore[union-attr]
        await drawn(pilot)

    assert snap_compare(look.app("topics"), terminal_size=look.size, run_before=decoded)


@one_look
def test_an_unknown_type(look: Look, dump_compare: SnapCompare) -> None:
    """Rates stand in the head; in place of the message the package that would bring its type."""
    facts = {"type": "lidar_msgs/msg/Cloud", "package": "lidar_msgs", "reason": "not installed"}
    unknown: dict[str, Any] = {
        "type_names": ("lidar_msgs/msg/Cloud",), "trouble": Trouble.UNKNOWN_TYPE, "facts": facts,
        "detail": "lidar_msgs is not installed",
    }  # fmt: skip
    rows = tuple(
        replace(row, **unknown) if row.name == "/sensor/sonar_front" else row for row in TOPICS
    )
    before = shown("/sensor/sonar_front", lesson_update(topics=rows, samples={}))
    assert dump_compare(look.app("topics"), terminal_size=look.size, run_before=before)


def drive_and_sonar(at_s: float) -> GraphUpdate:
    """One /drive that steps, ten of the sonar in a wave, nan for two seconds."""
    drive, sonar = lesson_update().samples["/drive"][0], "/sensor/sonar_front"
    speed = 0.3 if int(at_s / 5) % 2 else -0.2
    value = {**drive.value, "drive": {**drive.value["drive"], "speed": speed}}  # type: ignore[dict-item]
    kind = "std_msgs/msg/Float32"
    wave = tuple(
        replace(
            sample(sonar, kind, {"data": nan if 8 <= at_s < 10 else 1.5 + sin(at_s + n / 40)}, 8),
            received_s=NOW_S + at_s + n / 40,
        )
        for n in range(10)
    )
    drives = (replace(drive, value=value, received_s=NOW_S + at_s),)
    return lesson_update(time_s=NOW_S + at_s + 0.25, samples={"/drive": drives, sonar: wave})


@pytest.mark.parametrize("language", ["en", "ru"])
def test_hostile_text(language: str, dump_compare: SnapCompare) -> None:
    """A megabyte of escape sequences, markup and half characters: cut, and shown as it is."""
    look = Look((80, 24), language)
    rows = (
        *TOPICS,
        replace(TOPICS[0], name="/\x1b[2J[blink]", type_names=("evil_msgs/msg/\x1b]0;title\x07",)),
    )
    word = sample("/ai_command", "std_msgs/msg/String", {"data": HOSTILE})
    update = lesson_update(topics=rows, samples={"/ai_command": (word,)})
    before = shown("/ai_command", update, "tab", "enter")
    assert dump_compare(look.app("topics"), terminal_size=look.size, run_before=before)


def test_a_tiny_terminal(dump_compare: SnapCompare) -> None:
    """At 40x12 name and rate are left of the table, and a few lines of the message."""
    app = Look((40, 12), "en").app("topics", RecordedOpener())
    assert dump_compare(app, terminal_size=(40, 12), run_before=shown("/drive"))
