"""A recording on the screen: its bar, its keys, its panels, and what it refuses."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from textual.pilot import Pilot

from graph.bag.errors import unreadable
from graph.bag.reading import Bag, TopicInBag
from graph.replay.replay import Replay
from tests.tui.replayed import BagOpener, replayed
from tests.tui.snapshots import Look, SnapCompare, every_look, one_look
from tests.unit.bags import write_bag, write_robot_bag
from tests.waiting import until
from text.i18n import set_language
from tui.app import DeckApp
from tui.frame.key_bar import KeyBar
from tui.frame.replay_bar import ReplayBar
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


async def there(pilot: Pilot[int], position_s: float = 6.2) -> None:
    """Wait until the bag stands at its place and has been drawn."""
    app = pilot.app
    assert isinstance(app, DeckApp)

    def stands() -> bool:
        replay = app.feed.replay
        return (
            replay is not None and replay.state.position_s == position_s and bool(app.feed.update)
        )

    await until(stands, "the bag at its place")
    await pilot.pause(0.3)
    app.replay_changed()
    await pilot.pause()


@every_look
def test_replay_looks(look: Look, drive: Path, snap_compare: SnapCompare) -> None:
    """Panels over the whole width, no table of nodes; above the keys where the recording is."""
    app = shown(look, drive, "deck")
    assert snap_compare(app, terminal_size=look.size, run_before=there)


@one_look
def test_replayed_topics_look(look: Look, tmp_path: Path, dump_compare: SnapCompare) -> None:
    """Topics of the bag with rates as they were; the battery is of a package nobody has."""
    app = shown(look, write_bag(tmp_path / "walk"), "topics")
    assert dump_compare(app, terminal_size=look.size, run_before=there)


@one_look
def test_a_cut_recording_looks(look: Look, tmp_path: Path, dump_compare: SnapCompare) -> None:
    """The bar says that it is cut short, a toast says what is missing."""
    bag = write_bag(tmp_path / "walk", seconds=2000, hz=10)
    file = bag / "walk.mcap"
    file.write_bytes(file.read_bytes()[:-200_000])

    async def ready(pilot: Pilot[int]) -> None:
        await there(pilot, 300.0)
        # Its path is another in each run.
        pilot.app.clear_notifications()
        await pilot.pause()

    app = shown(look, bag, "topics", 300.0)
    assert dump_compare(app, terminal_size=look.size, run_before=ready)


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


@pytest.mark.every_frame
async def test_a_click_on_the_track_jumps_there(drive: Path) -> None:
    async with replayed(drive) as (app, pilot, replay):
        bar = app.screen.query_one(ReplayBar)
        await until(lambda: bar.track[1], "the track")
        begin, width = bar.track
        await pilot.click(ReplayBar, offset=(begin + width - 1, 0))
        await until(lambda: state_is(replay, position_s=10.0), "the end")
        await pilot.click(ReplayBar, offset=(1, 0))
        await until(lambda: state_is(replay, paused=False), "the replay at work")
        assert replay.state.position_s < 5.0, "at the end it begins anew"


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


@pytest.mark.parametrize(
    ("screen", "told", "untrue"),
    [
        ("flow", "Nobody has spoken so far in this recording", "speak, or wait"),
        ("composer", "This is a recording", "^s sends"),
        ("topics", "Nothing of it was recorded around here", "Look at their logs"),
    ],
)
async def test_no_screen_advises_what_only_a_robot_takes(
    tmp_path: Path, screen: str, told: str, untrue: str
) -> None:
    bag = write_robot_bag(tmp_path / "drive", silent=("/ai_command",))
    app = DeckApp(BagOpener(position_s=6.0), OpenRequest(replay=ReplayRequest(bag)), screen)
    async with app.run_test(size=(120, 40)):
        await until(lambda: told in text_of(app), "what is told")
        assert untrue not in text_of(app)


async def test_a_bag_without_panels_opens_on_its_topics(tmp_path: Path) -> None:
    async with replayed(write_bag(tmp_path / "walk")) as (app, _pilot, _replay):
        await until(lambda: getattr(app.screen, "tab", "") == "topics", "the topics")


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


@pytest.mark.parametrize("key", ["2", "5", "7"])
async def test_a_bag_that_cannot_be_read_is_not_put_down_to_ros(
    drive: Path, monkeypatch: pytest.MonkeyPatch, key: str
) -> None:
    def fail(bag: Bag, *_asked: object) -> Iterator[tuple[TopicInBag, int, bytes]]:
        raise unreadable(bag.path, OSError(5, "Input/output error"))

    monkeypatch.setattr(Bag, "messages", fail)
    async with replayed(drive) as (app, pilot, _replay):
        await pilot.press(key)
        await until(
            lambda: "The recording cannot be read" in text_of(app), "that it cannot be read"
        )
        assert "Input/output error" in text_of(app)
        assert "ROS cannot be observed" not in text_of(app)


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


async def test_leaving_lets_go_of_the_bag(drive: Path) -> None:
    async with replayed(drive) as (app, pilot, replay):
        await pilot.press("q")
        await until(lambda: app._exit, "the end of the app")
        assert replay._thread is not None
        assert not replay._thread.is_alive()


async def test_what_nodes_logged_is_in_the_log(drive: Path) -> None:
    async with replayed(drive) as (app, _pilot, _replay):
        await until(lambda: app.feed.history, "the log")
        (line,) = app.feed.history.all()
        assert (line.node, line.severity.value, line.text) == ("safety_stop", "warn", "too near")
        assert line.time_s == 1_700_000_000
