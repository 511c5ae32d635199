"""The picker: what there is to be opened, and opening it."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from textual.screen import Screen
from textual.widgets import Static

from course.lessons.catalog import SHIPPED
from launcher.errors import DomainTakenError, ProfileError, ProfileProblem
from launcher.status import SessionInfo, Who
from tests.tui.recorded import LESSONS, NOW_S, SESSION, RecordedOpener
from tests.tui.snapshots import opened, seen, settle
from tests.waiting import until
from text.sentences import say
from tui.app import DeckApp
from tui.lifecycle.dialogs import DomainTakenScreen, RefusedScreen
from tui.picker.screen import PickerScreen
from tui.session.requests import OpenRequest, Task
from tui.widgets.rows import Rows

OWN = Path("/home/eve/deck-course/02-sonar-safety/lesson.yaml")
"""The learner's files of lesson 2."""
PICK = OpenRequest(hardware="mock", domain=42)
ANN = Who(4000, "ann", "pts/2", "10.0.0.7")
RUNNING = replace(SESSION, foreground=False, name="02-sonar-safety", domain=17, started_by=ANN, since_s=NOW_S)


def about(screen: Screen[Any]) -> str:
    """Return what is said of the chosen row."""
    return str(screen.query_one("#about-text", Static).render())


async def test_enter_starts_the_first_lesson_for_a_newcomer() -> None:
    opener = RecordedOpener()
    async with opened(opener, order=PICK) as (app, pilot):
        assert isinstance(app.screen, PickerScreen)
        await pilot.press("enter")
        await pilot.pause()
        assert opener.orders == [PICK._replace(profile=LESSONS[0].path)]
        assert app.feed.session is SESSION
        # As the recorded session is called, the list comes back on lesson 9.
        await pilot.press("f8")
        await settle(pilot)
        assert app.screen.query_one(Rows).chosen == "profiles/09-brain.yaml"


async def test_a_broken_profile_says_what_is_wrong_and_is_not_started() -> None:
    opener = RecordedOpener()
    async with opened(opener, order=PICK) as (app, pilot):
        await pilot.press("end", "enter")
        await pilot.pause()
        assert "cannot be started" in about(app.screen)
        assert "my-robot.yaml:7:5" in about(app.screen)
        assert opener.orders == []


async def test_the_list_tells_how_far_one_is_and_whose_files_there_are() -> None:
    async with opened(order=PICK) as (app, pilot):
        await pilot.press("home", "down", "down")
        await pilot.pause()
        (row,) = (line for line in seen(app).splitlines() if " ✎ " in line)
        assert "2/5" in row
        assert "3/10" in row
        assert "2 of 5 steps · 3 of 10 points" in about(app.screen)
        assert str(OWN.parent) in about(app.screen)
        await pilot.press("up")
        await pilot.pause()
        assert "✓ 4 of 4 steps" in about(app.screen)


async def test_a_key_makes_the_folder_of_a_lesson_and_starts_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DECK_COURSE", str(tmp_path))
    task = Task(SHIPPED / "01-hello", left_off=True)
    opener = RecordedOpener(known=[LESSONS[1], LESSONS[0]._replace(task=task)])
    async with opened(opener, order=PICK) as (_app, pilot):
        await pilot.press("C")
        own = tmp_path / "01-hello" / "lesson.yaml"
        await until(lambda: opener.orders, "the lesson to be opened")
        assert opener.orders == [PICK._replace(profile=own)]
        assert own.is_file()


async def test_what_runs_in_the_background_is_attached_to() -> None:
    opener = RecordedOpener(sessions=[RUNNING])
    async with opened(opener, order=PICK) as (app, pilot):
        assert "Already running" in about(app.screen)
        assert "started by ann on pts/2 from 10.0.0.7 (pid 4000) at 0" in about(app.screen)
        await pilot.press("enter")
        await pilot.pause()
        assert opener.orders == [PICK._replace(attach="02-sonar-safety")]


def taken(*, can_share: bool) -> DomainTakenError:
    who = say("{name}: {who}, supervisor {pid}", name="01-hello", who="ann on pts/2", pid=4100)
    return DomainTakenError(42, [who], 43, can_share=can_share)


async def test_a_domain_that_is_taken_is_told_before_and_another_is_offered() -> None:
    opener = RecordedOpener(refusal=taken(can_share=True))
    async with opened(opener, order=PICK) as (app, pilot):
        await pilot.press("enter")
        await settle(pilot)
        assert isinstance(app.screen, DomainTakenScreen)
        words = str(app.screen.words())
        assert "01-hello: ann on pts/2, supervisor 4100" in words
        assert "Domain 43 is free: 01-hello can start in it." in words
        opener.refusal = None
        await pilot.press("enter")
        await settle(pilot)
        assert [order.domain for order in opener.orders] == [42, 43]
        assert app.feed.session is SESSION


async def test_a_lesson_that_cannot_be_opened_says_why_and_the_picker_is_back() -> None:
    problem = ProfileProblem("a.yaml", 3, 5, "nodes.x", say("unknown key"))
    opener = RecordedOpener(refusal=ProfileError([problem]))
    async with opened(opener, order=PICK) as (app, pilot):
        app.speak("ru")
        await pilot.press("enter")
        await settle(pilot)
        assert isinstance(app.screen, RefusedScreen)
        assert "a.yaml:3:5: nodes.x: неизвестный ключ" in str(app.screen.words())
        await pilot.press("escape")
        await pilot.pause()
        assert isinstance(app.screen, PickerScreen)


async def test_the_cursor_stands_where_one_left_off_whatever_comes_later() -> None:
    heard = asyncio.Event()

    class Late(RecordedOpener):
        async def running(self) -> list[SessionInfo]:
            await heard.wait()
            return self.sessions

    app = DeckApp(Late(sessions=[RUNNING]), PICK, "deck")
    app.sessions.last_lesson = "09-brain"
    async with app.run_test(size=(120, 40)) as pilot:
        await until(lambda: isinstance(app.screen, PickerScreen), "the list")
        rows = app.screen.query_one(Rows)
        await until(lambda: rows.chosen == "profiles/09-brain.yaml", "the lesson")
        heard.set()
        await until(lambda: "Already running" in seen(app), "what runs")
        await settle(pilot)
        assert rows.chosen == "profiles/09-brain.yaml"
