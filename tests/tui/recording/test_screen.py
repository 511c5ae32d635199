"""Recording from the screen: the key, the title, the folder, and the end with the session."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from textual.widgets import Input, Static

from graph.heavy_types import IMAGE
from graph.recording import recorder as recording
from graph.recording.recorder import RecordedTopic, RecordingStatus
from launcher import rundir
from tests.tui.snapshots import opened
from tests.waiting import until
from tui.app import DeckApp
from tui.bags.begin import BeginRecordingScreen
from tui.frame.title_bar import TitleBar
from tui.widgets.rows import Rows

pytestmark = pytest.mark.nightly

ROW = RecordedTopic("/number", "std_msgs/msg/Float32", 240, 3_400_000)
GOING = RecordingStatus("", 0.0, 12.0, 240, 3_400_000, (ROW,), bytes_per_s=280_000)


class Recorder:
    """Stands in for the real one, which the tests with ROS record by: says what it is told to."""

    made: list[Recorder]
    refusal: Exception | None

    def __init__(self, domain: int, discovery: object, folder: Path, *, without: frozenset[str]) -> None:
        self.asked = (domain, discovery, without)
        self.status = replace(GOING, folder=str(folder))
        self.stopped = False

    def start(self) -> None:
        if Recorder.refusal is not None:
            raise Recorder.refusal
        Recorder.made.append(self)

    def stop(self) -> RecordingStatus:
        self.stopped = True
        return self.status


@pytest.fixture(autouse=True)
def stand_in(monkeypatch: pytest.MonkeyPatch) -> None:
    Recorder.made, Recorder.refusal = [], None
    monkeypatch.setattr(recording, "Recorder", Recorder)
    monkeypatch.setattr(rundir, "new_recording", lambda _what: FOLDER)
    monkeypatch.setattr(recording, "room_bytes", lambda _folder: 2_000_000_000)


def title(app: DeckApp) -> str:
    return app.screen.query_one(TitleBar).text


def told(app: DeckApp) -> list[str]:
    return [notice.message for notice in app._notifications]


async def test_a_key_begins_and_ends_it_and_a_toast_tells_where() -> None:
    async with opened() as (app, pilot):
        await pilot.press("f6", "enter")
        await until(lambda: "● rec 12 s 3.4 MB" in title(app), "how much is recorded")
        (recorder,) = Recorder.made
        assert app.feed.session is not None
        session = app.feed.session
        assert recorder.asked == (session.domain, session.discovery, frozenset())
        assert recorder.status.folder == str(FOLDER)
        assert f"Recording into {recorder.status.folder}; f6 ends it." in told(app)
        await pilot.press("f6")
        await until(lambda: recorder.stopped, "the end of the recording")
        await until(lambda: "rec" not in title(app), "a title without it")
        await until(lambda: any("240 messages" in words for words in told(app)), "its size")


async def test_it_ends_before_the_screen_is_left() -> None:
    async with opened() as (app, pilot):
        await pilot.press("f6", "enter")
        await until(lambda: app.recording.active, "the recording")
        await pilot.press("q")
        await until(lambda: app._exit, "the end of the app")
        assert Recorder.made[0].stopped


async def test_what_goes_wrong_is_said_and_ends_it() -> None:
    async with opened() as (app, pilot):
        await pilot.press("f6", "enter")
        await until(lambda: app.recording.active, "the recording")
        (recorder,) = Recorder.made
        recorder.status = replace(recorder.status, error="the disk is full", dropped=3, lost=3)
        await until(lambda: not app.recording.active, "the end of the recording")
        await until(lambda: "the disk is full" in told(app), "the reason")
        assert any(words.startswith("3 messages are missing") for words in told(app))


FOLDER = Path("/home/robot/deck-recordings/09-brain-2026-01-31-12-00-00")
IMAGE_TOPIC = "/camera/color/image_raw"


def shares(app: DeckApp) -> str:
    rows = app.screen.query_one(Rows)
    return "\n".join(rows.render_line(at).text.strip() for at in range(5))


def words(app: DeckApp) -> str:
    return str(app.screen.query_one("#dialog-text", Static).content)


async def test_it_says_where_it_goes_how_large_it_gets_and_how_long_there_is_room() -> None:
    async with opened() as (app, pilot):
        await pilot.press("f6")
        await pilot.pause()
        assert f"Into {FOLDER}" in words(app)
        assert "Room on this disk: 2.0 GB, enough for 3:36" in words(app)
        pictures, _compressed, _clouds, others, together = shares(app).splitlines()
        assert pictures.split() == ["▶", "✓", "Pictures", "(Image)", IMAGE_TOPIC, "553", "MB/min"]
        assert "11 topics" in others
        assert together.split()[-2:] == ["553", "MB/min"]


async def test_pictures_are_left_out_by_choice_and_the_choice_is_kept() -> None:
    async with opened() as (app, pilot):
        await pilot.press("f6", "m")
        await pilot.pause()
        assert shares(app).splitlines()[0].startswith("▶ ○")
        assert shares(app).splitlines()[-1].split()[-2:] == ["337", "kB/min"]
        assert "enough for 4 days" in words(app)
        await pilot.press("enter")
        await until(lambda: app.recording.active, "the recording")
        assert Recorder.made[-1].asked[2] == {IMAGE}
        await pilot.press("f6")
        await until(lambda: Recorder.made[-1].stopped, "its end")
        await pilot.press("f6")
        await pilot.pause()
        assert isinstance(app.screen, BeginRecordingScreen)
        assert app.screen.left_out == {IMAGE}


async def test_a_limit_that_cannot_be_read_is_said_before_anything_is_recorded() -> None:
    async with opened() as (app, pilot):
        await pilot.press("f6", "tab", *"soon", "enter")
        await pilot.pause()
        note = str(app.screen.query_one("#recording-note", Static).content)
        assert note == "expected a time or a size: 10 min, 90 s, 1 h, 500 MB, 2 GB"
        assert isinstance(app.focused, Input)
        assert not Recorder.made
        await pilot.press(*["backspace"] * 4, "enter")
        await until(lambda: app.recording.active, "the recording without a limit")
