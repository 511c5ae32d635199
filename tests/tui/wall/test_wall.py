"""The wall: numbers that are published, large; the stop, the picture, the words."""

from __future__ import annotations

import math
from typing import Any

import pytest
from textual.widgets import Static

from graph.data import GraphUpdate
from robot.topics import BATTERY, ODOMETRY, SONAR_FRONT, SONAR_REAR, WHEEL_COMMANDS
from tests.tui.recorded import lesson_update, sample, topic
from tests.tui.snapshots import opened
from tests.waiting import until
from tui.app import DeckApp
from tui.deck.screen import LessonDeck
from tui.frame.title_bar import TitleBar
from tui.panels.camera import CameraPanel
from tui.panels.sonar import COURSE
from tui.panels.voice import VoicePanel
from tui.wall.numbers import BigNumber, WallNumber, WallReader, big_word
from tui.wall.screen import WallScreen
from tui.widgets.image_view import ImageView

pytestmark = pytest.mark.nightly

TYPES = {
    SONAR_FRONT: "std_msgs/msg/Float32",
    SONAR_REAR: "std_msgs/msg/Float32",
    ODOMETRY: "nav_msgs/msg/Odometry",
    WHEEL_COMMANDS: "sensor_msgs/msg/JointState",
    BATTERY: "sensor_msgs/msg/BatteryState",
}
HALF_FULL = {"percentage": 0.5, "voltage": 11.1}


def moving(speed: object) -> dict[str, Any]:
    return {"twist": {"twist": {"linear": {"x": speed}}}}


def graph(values: dict[str, dict[str, Any]], **more: Any) -> GraphUpdate:
    """Return a graph in which exactly these topics are published, each with a message."""
    rows = tuple(topic(name, TYPES[name], 10.0, **more) for name in values)
    samples = {name: (sample(name, TYPES[name], value),) for name, value in values.items()}
    return lesson_update(topics=rows, samples=samples)


def numbers(values: dict[str, dict[str, Any]], **more: Any) -> list[WallNumber]:
    return WallReader().numbers(graph(values, **more), COURSE)


def on_wall(app: DeckApp) -> list[tuple[str, str, str]]:
    """Return label, digits and note of each number that is shown."""
    shown = [one.shown for one in app.screen.query(BigNumber) if one.display]
    return [one[:3] for one in shown if one is not None]


def state(app: DeckApp) -> str:
    return str(app.screen.query_one("#wall-state", Static).content)


def test_only_what_is_published_is_there_in_a_fixed_order() -> None:
    values = {BATTERY: HALF_FULL, ODOMETRY: moving(0.3), SONAR_FRONT: {"data": 0.3}}
    assert numbers(values) == [
        WallNumber("ahead, m", "0.30", "STOP", "bad"),
        WallNumber("speed, m/s", "0.30", "ahead"),
        WallNumber("battery, %", "50", "11.1 V", "good"),
    ]
    assert numbers({SONAR_REAR: {"data": 0.8}}) == [WallNumber("behind, m", "0.80", "CLOSE", "warn")]
    assert numbers({}) == []


@pytest.mark.parametrize(
    ("metres", "shown"),
    [
        (math.nan, ("---", "no valid reading", "bad")),
        (math.inf, ("∞", "nothing in range", "good")),
        ("1.8", ("---", "no valid reading", "bad")),
    ],
)
def test_what_is_no_distance_is_said_in_words(metres: object, shown: tuple[str, ...]) -> None:
    assert numbers({SONAR_FRONT: {"data": metres}}) == [WallNumber("ahead, m", *shown)]


async def test_a_key_shows_it_and_escape_goes_back() -> None:
    async with opened() as (app, pilot):
        await pilot.press("0")
        await until(lambda: isinstance(app.screen, WallScreen), "the wall")
        await until(lambda: on_wall(app), "the numbers")
        assert on_wall(app) == [("ahead, m", "1.84", "FREE"), ("speed, m/s", "0.30", "ahead")]
        assert app.screen.query_one(ImageView).has_picture
        assert app.screen.query_one(VoicePanel).region.height > 2
        assert state(app) == "● The gate lets the wheels turn"
        await pilot.press("escape")
        await until(lambda: isinstance(app.screen, LessonDeck), "the Deck")


async def test_the_stop_is_in_large_letters_and_the_title_stays() -> None:
    async with opened(screen="wall", size=(80, 24)) as (app, pilot):
        await pilot.press("space")
        await pilot.pause()
        letters = app.screen.query_one("#wall-state", Static)
        assert state(app).startswith(big_word("STOP"))
        assert letters.region.height >= 7
        assert letters.has_class("-stop")
        assert "STOP" in app.screen.query_one(TitleBar).text
        assert app.screen.query_one(CameraPanel).region.height > 2
        await pilot.press("ctrl+r")
        await until(lambda: not state(app).startswith(big_word("STOP")), "the release")
