"""A recording on the screen: its bar, its keys, its panels, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import pytest

from graph.replay.replay import Replay
from tests.tui.replayed import BagOpener, replayed
from tests.tui.snapshots import Look
from tests.unit.bags import write_bag, write_robot_bag
from tests.waiting import until
from text.i18n import set_language
from tui.app import DeckApp
from tui.frame.key_bar import KeyBar
from tui.session.requests import OpenRequest, ReplayRequest

pytestmark = pytest.mark.nightly


@pytest.fixture
def drive(tmp_path: Path) -> Path:
    return write_robot_bag(tmp_path / "drive")


def text_of(app: DeckApp) -> str:
    """What stands on the screen, its lines put one after the other."""
    return "\n".join(strip.text for strip in app.screen._compositor.render_strips())


def shown(look: Look, bag: Path, screen: str, position_s: float = 6.2) -> DeckApp:
    set_language(look.language)
    return DeckApp(BagOpener(position_s=position_s), OpenRequest(replay=ReplayRequest(bag)), screen)


def state_is(replay: Replay, **wanted: object) -> bool:
    return all(getattr(replay.state, name) == value for name, value in wanted.items())


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


async def test_the_emergency_stop_has_nothing_to_stop(drive: Path) -> None:
    async with replayed(drive) as (app, pilot, _replay):
        await pilot.press("space")
        await pilot.pause()
        told = [notice.message for notice in app._notifications]
        assert told == ["This is a recording: there is nothing to stop."]
        assert not app.emergency.state.engaged


async def test_the_footer_offers_nothing_that_needs_a_robot(drive: Path) -> None:
    async with replayed(drive) as (app, pilot, _replay):
        for key, title in (
            ("1", "Restart"),
            ("2", "Publish"),
            ("3", "Send"),
            ("5", "Parameters"),
        ):
            await pilot.press(key)
            await pilot.pause()
            shown = str(app.screen.query_one(KeyBar).render())
            assert "f7 P" in shown
            for robots in (title, "STOP", "Start", "Stop", "Mute"):
                assert robots not in shown, (key, shown)


async def test_the_panels_show_what_was_recorded(drive: Path) -> None:
    async with replayed(drive, size=(80, 24), position_s=10.0) as (app, _pilot, _replay):
        await until(lambda: "0.26" in app.export_screenshot(), "the distance")


@pytest.mark.parametrize("name", ["nothing", "link to itself"])
async def test_what_is_no_bag_ends_with_a_word_and_two(tmp_path: Path, name: str) -> None:
    (tmp_path / "link to itself").symlink_to(tmp_path / "link to itself")
    app = DeckApp(BagOpener(), OpenRequest(replay=ReplayRequest(tmp_path / name)), "deck")
    async with app.run_test():
        await until(lambda: app.sessions.parting_words, "a word")
    assert app.return_code == 2
    assert "there is no such file or folder" in app.sessions.parting_words


async def test_a_damaged_place_is_told_when_it_is_come_to(tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "walk", seconds=5000, hz=20)
    file = bag / "walk.mcap"
    wrong = bytearray(file.read_bytes())
    wrong[len(wrong) // 3 : len(wrong) // 3 + 2000] = b"\xff" * 2000
    file.write_bytes(wrong)
    async with replayed(bag) as (app, _pilot, replay):
        assert "⚠ damaged" not in text_of(app)
        replay.seek(4900.0)
        await until(lambda: replay.state.position_s == 4900.0, "the place behind it")
        replay.seek(1600.0)
        replay.step()
        await until(lambda: "⚠ damaged" in text_of(app), "the mark")
        await until(lambda: app._notifications, "what is lost")
        (told,) = app._notifications
        assert "is damaged: messages lost: " in told.message


async def test_what_nodes_logged_is_in_the_log(drive: Path) -> None:
    async with replayed(drive) as (app, _pilot, _replay):
        await until(lambda: app.feed.history, "the log")
        (line,) = app.feed.history.all()
        assert (line.node, line.severity.value, line.text) == ("safety_stop", "warn", "too near")
        assert line.time_s == 1_700_000_000
