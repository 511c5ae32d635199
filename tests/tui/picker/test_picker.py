"""The picker: what there is to be opened, and opening it."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pytest
from textual.screen import Screen
from textual.widgets import Static

from course.lessons.catalog import SHIPPED
from launcher.errors import DomainTakenError, ProfileError, ProfileProblem
from launcher.status import Who
from tests.tui.app_runs import opened
from tests.tui.recorded import LESSONS, NOW_S, SESSION, RecordedOpener
from tests.tui.snapshots import settle
from tests.waiting import until
from text.sentences import say
from tui.app import DeckApp
from tui.lifecycle.domain_taken import DomainTakenScreen
from tui.lifecycle.refused import RefusedScreen
from tui.picker.screen import PickerScreen
from tui.session.requests import Lesson, OpenRequest, Task
from tui.widgets.rows import Rows

OWN = Path("/home/eve/deck-course/02-sonar-safety/lesson.yaml")
"""The learner's files of lesson 2."""
PICK = OpenRequest(hardware="mock", domain=42)
RUNNING = replace(
    SESSION,
    foreground=False,
    name="02-sonar-safety",
    domain=17,
    started_by=Who(4000, "ann", "pts/2", "10.0.0.7"),
    since_s=NOW_S,
)


@pytest.fixture(autouse=True)
def _utc(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("TZ", "UTC")
    time.tzset()
    yield
    monkeypatch.undo()
    time.tzset()


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


async def test_the_list_comes_back_on_the_lesson_that_was_opened_last() -> None:
    opener = RecordedOpener()
    async with opened(opener, order=PICK) as (app, pilot):
        await pilot.press("down", "down", "enter")
        await settle(pilot)
        assert app.sessions.last_lesson == SESSION.name == "09-brain"
        await pilot.press("f8")
        await settle(pilot)
        assert isinstance(app.screen, PickerScreen)
        assert app.screen.query_one(Rows).chosen == "profiles/09-brain.yaml"


@pytest.mark.parametrize("last", ["00", "12"])
async def test_the_whole_list_is_seen_at_80x24_whichever_lesson_is_chosen(last: str) -> None:
    many = [LESSONS[0]._replace(name=f"{at:02}", path=Path(f"{at:02}.yaml")) for at in range(13)]
    app = DeckApp(RecordedOpener(known=many), PICK, "deck")
    app.sessions.last_lesson = last
    async with app.run_test(size=(80, 24)) as pilot:
        await settle(pilot)
        assert shown(app).count("The first node") == 13 + 1
        assert "Look at what runs" in shown(app)


def shown(app: DeckApp) -> str:
    """Return what is on the screen."""
    return "\n".join(strip.text for strip in app.screen._compositor.render_strips())


async def test_one_click_chooses_a_lesson_and_two_open_it() -> None:
    opener = RecordedOpener()
    async with opened(opener, order=PICK) as (app, pilot):
        await pilot.click(Rows, offset=(10, 4))
        await pilot.pause()
        assert "Topics: sonar" in about(app.screen)
        assert opener.orders == []
        await pilot.click(Rows, offset=(10, 4), times=2)
        await pilot.pause()
        assert opener.orders[0].profile == OWN


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
        (row,) = (line for line in shown(app).splitlines() if " ✎ " in line)
        assert "2/5" in row
        assert "3/10" in row
        assert "2 of 5 steps · 3 of 10 points" in about(app.screen)
        assert str(OWN.parent) in about(app.screen)
        await pilot.press("up")
        await pilot.pause()
        assert "✓ 4 of 4 steps" in about(app.screen)


@dataclass
class SlowOpener(RecordedOpener):
    """Reads the steps of the lessons when it is let."""

    let: asyncio.Event = field(default_factory=asyncio.Event)

    async def lessons(self) -> list[Lesson]:
        """Return them as they are first known."""
        return [
            lesson._replace(task=lesson.task._replace(score=None)) if lesson.task else lesson
            for lesson in self.known
        ]

    async def scored(self, lessons: Sequence[Lesson]) -> list[Lesson]:
        """Wait, and read them."""
        del lessons
        await self.let.wait()
        return self.known


async def test_the_list_is_there_and_can_be_used_before_the_steps_have_been_read() -> None:
    opener = SlowOpener()
    async with opened(opener, order=PICK) as (app, pilot):
        await pilot.press("home", "down", "down")
        await pilot.pause()
        assert "Topics: sonar" in shown(app)
        assert "2/5" not in shown(app)
        opener.let.set()
        await until(lambda: "2/5" in shown(app), "the steps")
        assert "2 of 5 steps" in about(app.screen)
        opener.let.clear()
        await pilot.press("f1", "escape")
        await until(lambda: isinstance(app.screen, PickerScreen), "the list again")
        assert "2/5" in shown(app)
        await pilot.press("enter")
        await until(lambda: opener.orders, "the lesson to be opened")
        assert opener.orders == [PICK._replace(profile=OWN)]


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


async def test_it_may_not_where_both_have_the_same_nodes_and_need_not_be_started() -> None:
    opener = RecordedOpener(refusal=taken(can_share=False))
    async with opened(opener, order=PICK) as (app, pilot):
        await pilot.press("enter")
        await settle(pilot)
        await pilot.press("s")
        await settle(pilot)
        assert isinstance(app.screen, DomainTakenScreen)
        assert "one domain is not enough" in str(app.screen.words())
        assert len(opener.orders) == 1
        await pilot.press("escape")
        await settle(pilot)
        assert isinstance(app.screen, PickerScreen)


async def test_one_that_was_named_and_is_not_to_start_ends_with_words() -> None:
    opener = RecordedOpener(refusal=taken(can_share=True))
    async with opened(opener) as (app, pilot):
        assert isinstance(app.screen, DomainTakenScreen)
        await pilot.press("escape")
        await settle(pilot)
        assert app.return_code == 2
        assert "`--domain 43` is free" in app.sessions.parting_words


@pytest.mark.parametrize("language", ["en", "ru"])
async def test_a_lesson_that_cannot_be_opened_says_why_and_the_picker_is_back(
    language: str,
) -> None:
    problem = ProfileProblem("a.yaml", 3, 5, "nodes.x", say("unknown key"))
    opener = RecordedOpener(refusal=ProfileError([problem]))
    async with opened(opener, order=PICK) as (app, pilot):
        app.speak(language)
        await pilot.press("enter")
        await pilot.pause()
        await pilot.pause()
        assert isinstance(app.screen, RefusedScreen)
        said = "неизвестный ключ" if language == "ru" else "unknown key"
        assert f"a.yaml:3:5: nodes.x: {said}" in str(app.screen.words())
        await pilot.press("escape")
        await pilot.pause()
        assert isinstance(app.screen, PickerScreen)
