"""The dialog that publishes: what it sends, what it refuses, and what it says of it."""

from __future__ import annotations

from collections.abc import AsyncIterator
from dataclasses import replace
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Static

from graph.data import Sample
from graph.observer.requests import Publish, StartPublishing, StopPublishing, StopPublishingAll
from safety.topics import EMERGENCY_STOP
from tests.tui.recorded import NOW_S, RecordedGraph, RecordedOpener, lesson_update
from tests.tui.snapshots import opened
from tests.waiting import until
from tui.app import DeckApp
from tui.emergency.state import TOPIC_TYPE
from tui.topics.publish import PublishDialog
from tui.topics.screen import TopicsScreen

DRIVE = "ackermann_msgs/msg/AckermannDriveStamped"


class Desk:
    """The dialog over the recorded topics, under a pilot."""

    def __init__(self, app: DeckApp, pilot: Pilot[Any], graph: RecordedGraph) -> None:
        self.app, self.pilot, self.graph = app, pilot, graph

    @property
    def dialog(self) -> PublishDialog:
        screen = self.app.screen
        assert isinstance(screen, PublishDialog)
        return screen

    async def open(self, topic: str = "/drive") -> None:
        """Choose a topic, let its message come, and open the dialog."""
        screen = self.app.screen
        assert isinstance(screen, TopicsScreen)
        screen.table.choose(topic)
        await self.pilot.pause()
        before = self.graph.update or lesson_update()
        self.graph.show(replace(lesson_update(), publications=before.publications))
        await self.pilot.pause()
        await self.pilot.press("P")
        await until(lambda: self.dialog.form.value is not None, "a form that is right")

    async def says(self, words: str) -> None:
        """Wait until this is said beside the rate."""
        await until(lambda: words in self.said, lambda: f"{words!r}, but {self.said!r}")

    @property
    def said(self) -> str:
        return str(self.dialog.query_one("#rate-said", Static).content)

    def fill(self, old: str, new: str) -> None:
        text = self.dialog.form.text
        assert old in text
        self.dialog.form.editor.replace_all(text.replace(old, new))


@pytest.fixture
async def desk() -> AsyncIterator[Desk]:
    """The screen of topics, the dialog not yet open."""
    graph = RecordedGraph()
    async with opened(RecordedOpener(graph=graph), "topics") as (app, pilot):
        yield Desk(app, pilot, graph)


async def test_a_message_goes_out_once_and_its_listeners_are_told(desk: Desk) -> None:
    await desk.open()
    assert desk.dialog.topic == "/drive"
    assert desk.dialog.type.value == DRIVE
    desk.fill(" speed: 0.0", " speed: 0.2")
    await desk.pilot.press("ctrl+s")
    await desk.says("Sent: 1 subscriber got it.")
    ((topic, type_name, value, latched),) = desk.graph.asked(Publish)
    assert (topic, type_name, latched) == ("/drive", DRIVE, False)
    assert value["drive"]["speed"] == 0.2


async def test_what_is_wrong_publishes_nothing_and_is_gone_to(desk: Desk) -> None:
    await desk.open()
    desk.fill(" speed: 0.0", " speed: fast")
    desk.dialog.rate_field.focus()
    for key in ("ctrl+s", "ctrl+g"):
        await desk.pilot.press(key)
        await desk.says("Not sent")
    assert (desk.graph.asked(Publish), desk.graph.asked(StartPublishing)) == ([], [])
    assert "line 7: drive.speed: expected a number, got 'fast'" in desk.dialog.form.verdict
    assert desk.dialog.focused is desk.dialog.form.editor
    assert desk.dialog.form.editor.cursor_location == (6, 9)
    desk.fill("fast", "1")
    await until(lambda: desk.said == "", "the word gone that it was not sent")


async def test_a_message_is_published_at_a_rate_until_it_is_stopped(desk: Desk) -> None:
    await desk.open()
    desk.dialog.rate_field.value = "2,5"
    await desk.pilot.press("ctrl+g")
    await desk.says("Publishing to /drive at 2.5 Hz.")
    assert [(topic, hz) for topic, _type, _value, hz in desk.graph.asked(StartPublishing)] == [("/drive", 2.5)]
    listed = desk.dialog.query_one("#publications")
    await until(lambda: desk.dialog.chosen_number == 1, "the publication in the list")
    # Another on the same topic takes its place.
    await desk.pilot.press("ctrl+g")
    await until(lambda: desk.graph.asked(StopPublishing) == [(1,)], "the end of the first")
    await until(lambda: desk.dialog.chosen_number == 2, "the second in the list")
    await desk.pilot.press("f12")
    await desk.says("Stopped: /drive")
    assert desk.graph.asked(StopPublishing) == [(1,), (2,)]
    await until(lambda: not desk.dialog.is_publishing, "the end of all that is published")
    assert not listed.display


async def test_what_is_published_outlives_the_dialog_and_can_be_stopped_by_enter(desk: Desk) -> None:
    await desk.open()
    await desk.pilot.press("ctrl+g")
    await desk.says("Publishing to /drive")
    await desk.pilot.press("escape")
    assert isinstance(desk.app.screen, TopicsScreen)
    assert desk.graph.asked(StopPublishing) == []
    await desk.open("/ai_command")
    await until(lambda: desk.dialog.is_publishing, "what is published")
    desk.dialog.query_one("#publications").focus()
    await desk.pilot.press("enter")
    assert desk.graph.asked(StopPublishing) == [(1,)]


async def test_a_rate_that_is_none_is_refused(desk: Desk) -> None:
    await desk.open()
    for rate in ("0", "-1", "nan", "inf", "fast", "", "1e9"):
        desk.dialog.rate_field.value = rate
        desk.dialog.tell(lambda: "", "")
        desk.dialog.form.editor.focus()
        await desk.pilot.press("ctrl+g")
        await desk.says("The rate is")
        assert desk.graph.asked(StartPublishing) == []
        assert desk.dialog.focused is desk.dialog.rate_field


async def test_a_new_topic_needs_a_type_which_is_completed(desk: Desk) -> None:
    await desk.open()
    dialog = desk.dialog
    dialog.topic_field.focus()
    dialog.topic_field.value = "my/new_one"
    dialog.type.field.focus()
    dialog.type.field.value = "float3"
    await until(lambda: dialog.type.is_listing, "the types that fit")
    assert dialog.type.fitting()[0] == "std_msgs/msg/Float32"
    # What is only half typed is no type yet.
    await desk.pilot.press("ctrl+s")
    await desk.says("Choose the type of /my/new_one.")
    await desk.pilot.press("down", "up", "enter")
    await until(lambda: desk.dialog.form.text == "data: 0.0  # float32\n", "the form of a number")
    assert desk.dialog.focused is desk.dialog.form.editor
    await desk.pilot.press("ctrl+s")
    await desk.says("Sent")
    assert desk.graph.asked(Publish)[0][:2] == ("/my/new_one", "std_msgs/msg/Float32")


async def test_what_is_no_name_of_a_topic_is_refused(desk: Desk) -> None:
    await desk.open()
    for name in ("", "/", "/1x", "a b", "/a//b", "/привет", "~/x", "/a/"):
        desk.dialog.topic_field.value = name
        desk.dialog.tell(lambda: "", "")
        await desk.pilot.press("ctrl+s")
        await desk.says("Not a topic name")
        assert desk.graph.asked(Publish) == []


async def test_the_emergency_stop_ends_what_deck_publishes_and_says_so(desk: Desk) -> None:
    await desk.open("/ai_command")
    await desk.pilot.press("ctrl+g")
    await desk.says("Publishing to /ai_command")
    await until(lambda: desk.dialog.is_publishing, "what is published")
    await desk.pilot.press("escape", "space")
    await desk.pilot.pause()
    assert len(desk.graph.asked(StopPublishingAll)) == 1
    told = [notice.message for notice in desk.app._notifications]
    assert told == ["Deck has stopped publishing to /ai_command: the emergency stop ended it."]
    # Nothing was left to be ended.
    await desk.pilot.press("space")
    assert len(desk.app._notifications) == 1


async def test_the_emergency_stop_of_another_ends_it_too(desk: Desk) -> None:
    await desk.open("/ai_command")
    await desk.pilot.press("ctrl+g")
    await until(lambda: desk.dialog.is_publishing, "what is published")
    stop = Sample(EMERGENCY_STOP, TOPIC_TYPE, NOW_S + 1, 0.0, 4, {"data": True})
    assert desk.graph.update is not None
    desk.graph.show(replace(desk.graph.update, samples={EMERGENCY_STOP: (stop,)}))
    await until(lambda: len(desk.graph.asked(StopPublishingAll)) == 1, "the end of all that Deck publishes")
    await until(lambda: not desk.dialog.is_publishing, "the end of all that is published")
    # It is told once, however long the stop is there.
    desk.graph.show(replace(desk.graph.update, samples={EMERGENCY_STOP: (stop,)}))
    await desk.pilot.pause()
    assert len(desk.graph.asked(StopPublishingAll)) == 1


async def test_what_is_published_in_spite_of_a_stop_ends_with_its_release(desk: Desk) -> None:
    """Or the robot would drive off at that moment."""
    await desk.pilot.press("space")
    await desk.open("/ai_command")
    await desk.pilot.press("ctrl+g")
    await until(lambda: desk.dialog.is_publishing, "what is published")
    before = len(desk.graph.asked(StopPublishingAll))
    await desk.pilot.press("ctrl+r")
    await until(lambda: len(desk.graph.asked(StopPublishingAll)) == before + 1, "the end of all that Deck publishes")
    assert desk.graph.asked(Publish)[-1][:3] == (EMERGENCY_STOP, TOPIC_TYPE, {"data": False})
    await until(lambda: not desk.dialog.is_publishing, "the end of all that is published")
