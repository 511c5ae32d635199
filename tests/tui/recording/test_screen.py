"""Recording from the screen: the key, the title, the folder, and the end with the session."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from graph.bag.errors import not_made
from graph.recording import recorder as recording
from graph.recording.recorder import RecordedTopic, RecordingStatus
from tests.tui.app_runs import opened
from tests.waiting import until
from tui.app import DeckApp
from tui.frame.title_bar import TitleBar

pytestmark = pytest.mark.nightly

ROW = RecordedTopic("/number", "std_msgs/msg/Float32", 240, 3_400_000)
GOING = RecordingStatus("", 0.0, 12.0, 240, 3_400_000, (ROW,), bytes_per_s=280_000)


class Recorder:
    """Stands in for the real one, which the tests with ROS record by: says what it is told to."""

    made: list[Recorder]
    refusal: Exception | None

    def __init__(
        self, domain: int, discovery: object, folder: Path, *, without: frozenset[str]
    ) -> None:
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
    """Let recordings be made by the stand-in."""
    Recorder.made, Recorder.refusal = [], None
    monkeypatch.setattr(recording, "Recorder", Recorder)


def title(app: DeckApp) -> str:
    return app.screen.query_one(TitleBar).text


def told(app: DeckApp) -> list[str]:
    return [notice.message for notice in app._notifications]


async def test_a_key_begins_and_ends_it_and_a_toast_tells_where(tmp_path: Path) -> None:
    async with opened() as (app, pilot):
        await pilot.press("f6", "enter")
        await until(lambda: "● rec 12 s 3.4 MB" in title(app), "how much is recorded")
        (recorder,) = Recorder.made
        assert app.feed.session is not None
        session = app.feed.session
        assert recorder.asked == (session.domain, session.discovery, frozenset())
        assert recorder.status.folder.startswith(str(tmp_path / "recordings" / "09-brain"))
        assert f"Recording into {recorder.status.folder}; f6 ends it." in told(app)
        await pilot.press("f6")
        await until(lambda: recorder.stopped, "the end of the recording")
        await until(lambda: "rec" not in title(app), "a title without it")
        await until(lambda: any("240 messages" in words for words in told(app)), "its size")


async def test_that_the_disk_will_be_full_is_told_once() -> None:
    async with opened() as (app, pilot):
        await pilot.press("f6", "enter")
        await until(lambda: Recorder.made, "the recorder")
        (recorder,) = Recorder.made
        recorder.status = replace(recorder.status, left_s=90.0)
        full = "Recording: the disk has room for 1:30."
        await until(lambda: full in told(app), "the word that it will be full")
        recorder.status = replace(recorder.status, left_s=80.0, seconds=13.0)
        await until(lambda: "● rec 13 s" in title(app), "another second")
        assert not any("1:20" in words for words in told(app))


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


async def test_a_folder_that_cannot_be_made_is_said() -> None:
    Recorder.refusal = not_made(Path("/full"), OSError(28, "No space left on device"))
    async with opened() as (app, pilot):
        await pilot.press("f6", "enter")
        why = "/full cannot be created: No space left on device"
        await until(lambda: why in told(app), "the reason")
        assert not app.recording.active
