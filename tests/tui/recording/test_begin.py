"""The question before a recording: where it goes, how fast it would grow, what is left out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from textual.widgets import Input, Static

from graph.heavy_types import IMAGE, POINT_CLOUD
from graph.recording import recorder as recording
from launcher import rundir
from tests.tui.app_runs import opened
from tests.tui.recording.test_screen import Recorder, stand_in, told
from tests.waiting import until
from tui.app import DeckApp
from tui.bags.begin import BeginRecordingScreen
from tui.widgets.rows import Rows

pytestmark = pytest.mark.nightly

__all__ = ["stand_in"]

FOLDER = Path("/home/robot/deck-recordings/09-brain-2026-01-31-12-00-00")
IMAGE_TOPIC = "/camera/color/image_raw"


@pytest.fixture(autouse=True)
def _a_small_disk(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rundir, "new_recording", lambda _what: FOLDER)
    monkeypatch.setattr(recording, "room_bytes", lambda _folder: 2_000_000_000)


def asked(app: DeckApp) -> BeginRecordingScreen:
    assert isinstance(app.screen, BeginRecordingScreen)
    return app.screen


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
        pictures, compressed, clouds, others, together = shares(app).splitlines()
        assert pictures.split() == ["▶", "✓", "Pictures", "(Image)", IMAGE_TOPIC, "553", "MB/min"]
        assert compressed.split()[-2:] == ["–", "–"]
        assert clouds.split()[-1] == "–"
        assert "11 topics" in others
        assert together.split()[-2:] == ["553", "MB/min"]


async def test_enter_starts_at_once_and_so_does_the_key_itself() -> None:
    for key in ("enter", "f6"):
        async with opened() as (app, pilot):
            await pilot.press("f6", key)
            await until(lambda: app.recording.active, "the recording")
        recorder = Recorder.made.pop()
        assert recorder.status.folder == str(FOLDER)
        assert recorder.asked[2] == frozenset()


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
        assert asked(app).left_out == {IMAGE}
        await pilot.press("ь", "down", "down", "m", "enter")
        await until(lambda: app.recording.active, "the other recording")
        assert Recorder.made[-1].asked[2] == {POINT_CLOUD}


async def test_a_limit_ends_the_recording_by_itself() -> None:
    async with opened() as (app, pilot):
        await pilot.press("f6", "tab", *"5 min", "enter")
        await until(lambda: app.recording.active, "the recording")
        (recorder,) = Recorder.made
        recorder.status = replace(recorder.status, seconds=299.0)
        await until(lambda: any("4:59" in text for text in app.recording.words), "the length")
        assert app.recording.active
        recorder.status = replace(recorder.status, seconds=300.2)
        await until(lambda: recorder.stopped, "its end")
        await until(lambda: "The recording ends as it was asked to." in told(app), "the reason")


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
