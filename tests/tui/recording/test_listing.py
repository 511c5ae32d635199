"""The recordings on this machine, listed and opened from the screen."""

from __future__ import annotations

import os
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from textual.pilot import Pilot
from textual.widgets import Static

from launcher.rundir import recordings_path
from tests.tui.app_runs import opened
from tests.tui.recorded import RecordedOpener
from tests.tui.replayed import BagOpener
from tests.tui.snapshots import settle
from tests.unit.bags import write_bag, write_robot_bag
from tests.waiting import until
from tui.app import DeckApp
from tui.bags.listing import RecordingsScreen
from tui.dialogs.dialog import Dialog
from tui.frame.key_bar import KeyBar
from tui.picker.screen import PickerScreen
from tui.session.requests import OpenRequest
from tui.widgets.rows import Rows

AT_S = 1_700_000_000


def aged(folder: Path, seconds: int) -> Path:
    """Let the files be that much younger than `AT_S`."""
    for file in folder.iterdir():
        os.utime(file, (AT_S + seconds, AT_S + seconds))
    return folder


def some() -> Path:
    """Make three recordings, the newest of which is damaged, beside things that are none."""
    folder = recordings_path()
    folder.mkdir()
    aged(write_robot_bag(folder / "02-sonar-safety-2026"), 0)
    aged(write_bag(folder / "walk", seconds=75), 60)
    damaged = write_bag(folder / "cut", seconds=5)
    (damaged / "cut.mcap").write_bytes(b"")
    aged(damaged, 120)
    (folder / "notes.txt").write_text("mine")
    (folder / "empty").mkdir()
    (folder / "loop").symlink_to(folder / "loop")
    return folder


@asynccontextmanager
async def picking(size: tuple[int, int] = (120, 40)) -> AsyncIterator[tuple[DeckApp, Pilot[Any]]]:
    """Run the app with the list of lessons in front; recordings are really opened."""
    app = DeckApp(BagOpener(), OpenRequest())
    async with app.run_test(size=size) as pilot:
        await settle(pilot)
        yield app, pilot
        await app.feed.disconnect()


def rows(app: DeckApp) -> list[list[str]]:
    listed = app.screen.query_one(Rows)
    lines = [listed.render_line(at).text.split() for at in range(8)]
    return [line for line in lines if line]


def said(app: DeckApp) -> str:
    return str(app.screen.query_one("#dialog-text", Static).content)


async def listed(app: DeckApp, pilot: Pilot[Any], count: int) -> None:
    """Open the list, and wait until it has so many recordings."""
    await pilot.press("shift+f6")
    await until(lambda: isinstance(app.screen, RecordingsScreen), "the list")
    await until(lambda: len(rows(app)) == count + 1, "the recordings")


async def test_they_are_listed_with_what_is_known_of_them_the_newest_first() -> None:
    folder = some()
    async with picking() as (app, pilot):
        assert "Recordings" in str(app.screen.query_one(KeyBar).render())
        await listed(app, pilot, 3)
        head, cut, walk, sonar = rows(app)
        assert head == ["Name", "Ended", "Length", "Topics", "Messages", "Size"]
        assert cut[:3] == ["▶", "✗", "cut"]
        assert walk[0] == "walk"
        assert walk[3:6] == ["1:15", "3", "753"]
        assert sonar[0] == "02-sonar-safety-2026"
        assert str(folder / "cut") in said(app)
        assert "✗ cut.mcap is empty, nothing was written to it" in said(app)


async def test_enter_plays_the_chosen_one() -> None:
    some()
    async with picking() as (app, pilot):
        await listed(app, pilot, 3)
        await pilot.press("end", "enter")
        await until(lambda: app.feed.replay is not None, "the replay")
        assert app.feed.session is not None
        assert app.feed.session.name == "02-sonar-safety-2026"
        assert not isinstance(app.screen, Dialog)


async def test_from_a_lesson_it_says_that_this_ends_and_ends_it() -> None:
    some()
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await listed(app, pilot, 3)
        assert said(app).endswith("Opening it ends the lesson that runs here.")
        await pilot.press("down", "enter")
        await until(lambda: ("shutdown",) in opener.link.asked, "the end of the lesson")
        await until(lambda: len(opener.orders) == 2, "another order")
        request = opener.orders[-1].replay
        assert request is not None
        assert request.bag == recordings_path() / "walk"
        assert opener.orders[-1].profile is None


async def test_one_that_cannot_be_read_says_why_and_no_lesson_ends_for_it() -> None:
    some()
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await listed(app, pilot, 3)
        await pilot.press("enter")
        await until(lambda: app._notifications, "the reason")
        (notice,) = app._notifications
        assert "cut.mcap is empty" in notice.message
        assert isinstance(app.screen, RecordingsScreen)
        assert not opener.link.asked


async def test_where_there_are_none_it_says_how_to_make_one() -> None:
    async with picking() as (app, pilot):
        await pilot.press("shift+f6")
        await until(lambda: "no recordings in" in said(app), "the words")
        assert said(app).endswith("F6 on the screen or `deck record` makes one")
        await pilot.press("enter", "escape")
        await until(lambda: isinstance(app.screen, PickerScreen), "the lessons")
