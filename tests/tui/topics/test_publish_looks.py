"""How the dialog that publishes looks, at three sizes and in both languages."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import replace
from typing import Any

import pytest
from textual.pilot import Pilot

from graph.data import Publication
from tests.tui.recorded import lesson_update
from tests.tui.snapshots import Look, SnapCompare, every_look, one_look, settle
from tests.waiting import until
from tui.app import DeckApp
from tui.topics.publish.dialog import PublishDialog
from tui.topics.screen import TopicsScreen

pytestmark = pytest.mark.nightly

DRIVE = "ackermann_msgs/msg/AckermannDriveStamped"
RUNNING = (
    Publication(1, "/drive", DRIVE, 10.0, 1234, 2),
    Publication(2, "/ai_command", "std_msgs/msg/String", 0.5, 17, 0),
    Publication(3, "/gone", "std_msgs/msg/Bool", 1.0, 3, 0, "the observer has been stopped"),
)

Before = Callable[[Pilot[Any]], Awaitable[None]]


def filled(change: Callable[[PublishDialog], None], *keys: str) -> Before:
    """Open the dialog for /drive, change something, and press these keys."""

    async def before(pilot: Pilot[Any]) -> None:
        await settle(pilot)
        app = pilot.app
        assert isinstance(app, DeckApp)
        topics = app.screen
        assert isinstance(topics, TopicsScreen)
        topics.table.choose("/drive")
        await pilot.pause()
        app.feed.graph.show(lesson_update())  # type: ignore[union-attr]
        await pilot.pause()
        await pilot.press("P")
        dialog = app.screen
        assert isinstance(dialog, PublishDialog)
        await drawn(pilot, lambda: dialog.form.value is not None, "a form that is right")
        change(dialog)
        await pilot.pause()
        await pilot.press(*keys)
        await drawn(pilot, lambda: dialog.form.text == dialog.form._checked, "a form looked at")

    return before


async def drawn(pilot: Pilot[Any], condition: Callable[[], bool], what: str) -> None:
    """Wait until this is so, and drawn."""
    await until(condition, what)
    for _round in range(3):
        await pilot.pause()


def nothing(_dialog: PublishDialog) -> None:
    """Leave it as it is."""


def wrong(dialog: PublishDialog) -> None:
    """Write a word where a number belongs."""
    dialog.form.editor.replace_all(dialog.form.text.replace(" speed: 0.0", " speed: fast"))


def running(dialog: PublishDialog) -> None:
    """Let three be published, one of which has ended by itself."""
    update = replace(lesson_update(), publications=RUNNING)
    dialog.deck.feed.graph.show(update)  # type: ignore[union-attr]


def new_topic(dialog: PublishDialog) -> None:
    """Name a new topic."""
    dialog.target.field.value = "/speed_wish"
    dialog.target.type.field.value = ""
    dialog.target.type.field.focus()


@every_look
def test_a_form(look: Look, snap_compare: SnapCompare) -> None:
    """Topic and type, every field of the type with its default, and that nothing is wrong."""
    app = look.app("topics")
    assert snap_compare(app, terminal_size=look.size, run_before=filled(nothing))


@one_look
def test_an_error(look: Look, dump_compare: SnapCompare) -> None:
    """A word for a number: line marked, value underlined, field named, nothing sent."""
    app = look.app("topics")
    assert dump_compare(app, terminal_size=look.size, run_before=filled(wrong, "ctrl+s"))


@one_look
def test_running(look: Look, dump_compare: SnapCompare) -> None:
    """Three publications with rate, count and listeners; the third has ended and says why."""

    async def before(pilot: Pilot[Any]) -> None:
        await filled(running)(pilot)
        dialog = pilot.app.screen
        assert isinstance(dialog, PublishDialog)
        await drawn(pilot, lambda: dialog.is_publishing, "what is published")

    assert dump_compare(look.app("topics"), terminal_size=look.size, run_before=before)


@one_look
def test_a_new_topic(look: Look, dump_compare: SnapCompare) -> None:
    """Half a type is typed: those that fit are listed below, the best one first."""

    async def before(pilot: Pilot[Any]) -> None:
        await filled(new_topic, *"float")(pilot)
        dialog = pilot.app.screen
        assert isinstance(dialog, PublishDialog)
        kind = dialog.target.type
        await drawn(pilot, lambda: kind.is_listing and kind.value == "float", "a list of types")

    assert dump_compare(look.app("topics"), terminal_size=look.size, run_before=before)


@one_look
def test_stopped(look: Look, dump_compare: SnapCompare) -> None:
    """The title is red and says so while the emergency stop is engaged."""

    async def before(pilot: Pilot[Any]) -> None:
        await filled(nothing, "ctrl+x")(pilot)
        dialog = pilot.app.screen
        assert isinstance(dialog, PublishDialog)
        await drawn(pilot, lambda: bool(dialog.query("TitleBar.-stop")), "the stop")

    assert dump_compare(look.app("topics"), terminal_size=look.size, run_before=before)
