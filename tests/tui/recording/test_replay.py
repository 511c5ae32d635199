"""A recording on the screen: its keys, what it refuses, and the list that it is chosen from."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Static

from graph.replay.replay import Replay
from launcher.rundir import recordings_path
from tests.tui.recorded import RecordedOpener
from tests.tui.replayed import BagOpener, replayed
from tests.tui.snapshots import opened, seen
from tests.unit.bags import write_bag, write_robot_bag
from tests.waiting import until
from tui.app import DeckApp
from tui.bags.listing import RecordingsScreen
from tui.frame.key_bar import KeyBar
from tui.session.requests import OpenRequest, ReplayRequest
from tui.widgets.rows import Rows


@pytest.fixture
def drive(tmp_path: Path) -> Path:
    return write_robot_bag(tmp_path / "drive")


def state_is(replay: Replay, **wanted: object) -> bool:
    return all(getattr(replay.state, name) == value for name, value in wanted.items())


@pytest.mark.nightly
async def test_keys_play_pause_step_jump_and_change_the_rate(drive: Path) -> None:
    async with replayed(drive) as (_app, pilot, replay):
        await pilot.press("full_stop")
        await until(lambda: replay.state.position_s == pytest.approx(0.1), "0.1 s")
        await pilot.press("shift+right")
        await until(lambda: replay.state.position_s == pytest.approx(5.1), "5.1 s")
        await pilot.press("shift+left")
        await until(lambda: replay.state.position_s == pytest.approx(0.1), "0.1 s")
        await pilot.press("plus")
        await until(lambda: state_is(replay, rate=2.0), "twice the rate")
        await pilot.press("minus", "minus")
        await until(lambda: state_is(replay, rate=0.5), "half the rate")
        await pilot.press("shift+f7")
        await until(lambda: state_is(replay, loop=True), "the loop")
        await pilot.press("f7")
        await until(lambda: state_is(replay, paused=False), "the replay at work")
        await until(lambda: replay.state.position_s > 0.2, "the next messages")


@pytest.mark.nightly
async def test_the_emergency_stop_has_nothing_to_stop(drive: Path) -> None:
    async with replayed(drive) as (app, pilot, _replay):
        await pilot.press("space")
        await pilot.pause()
        told = [notice.message for notice in app._notifications]
        assert told == ["This is a recording: there is nothing to stop."]
        assert not app.emergency.state.engaged


@pytest.mark.nightly
async def test_the_footer_offers_nothing_that_needs_a_robot(drive: Path) -> None:
    async with replayed(drive) as (app, pilot, _replay):
        for key, title in (("1", "Restart"), ("2", "Publish"), ("3", "Send"), ("5", "Parameters")):
            await pilot.press(key)
            await pilot.pause()
            shown = str(app.screen.query_one(KeyBar).render())
            assert "f7 P" in shown
            for robots in (title, "STOP", "Start", "Stop", "Mute"):
                assert robots not in shown, (key, shown)


@pytest.mark.nightly
async def test_what_is_no_bag_ends_with_a_word_and_two(tmp_path: Path) -> None:
    app = DeckApp(BagOpener(), OpenRequest(replay=ReplayRequest(tmp_path / "nothing")), "deck")
    async with app.run_test():
        await until(lambda: app.sessions.parting_words, "a word")
    assert app.return_code == 2
    assert "there is no such file or folder" in app.sessions.parting_words


@pytest.mark.nightly
async def test_a_damaged_place_is_told_when_it_is_come_to(tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "walk", seconds=5000, hz=20)
    file = bag / "walk.mcap"
    wrong = bytearray(file.read_bytes())
    wrong[len(wrong) // 3 : len(wrong) // 3 + 2000] = b"\xff" * 2000
    file.write_bytes(wrong)
    async with replayed(bag) as (app, _pilot, replay):
        assert "⚠ damaged" not in seen(app)
        replay.seek(4900.0)
        await until(lambda: replay.state.position_s == 4900.0, "the place behind it")
        replay.seek(1600.0)
        replay.step()
        await until(lambda: "⚠ damaged" in seen(app), "the mark")
        await until(lambda: app._notifications, "what is lost")
        (told,) = app._notifications
        assert "is damaged: it cannot be read further than 1596.0 s" in told.message


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
    async with opened(BagOpener(), order=OpenRequest()) as (app, pilot):  # type: ignore[arg-type]
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
