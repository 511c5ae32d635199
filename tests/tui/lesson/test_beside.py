"""The lesson beside the nodes on the Deck: the same step, judged by the same judge."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from textual.widgets import Static

from course.judging import ValuesDrawn
from tests.tui.app_runs import opened
from tests.tui.lesson.test_lesson import PASSED, SEED, SEEN, own_opener, text
from tests.waiting import until
from tui.lesson.column import LessonColumn

if TYPE_CHECKING:
    from tui.app import DeckApp


@pytest.fixture(autouse=True)
def _course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DECK_COURSE", str(tmp_path))


def beside(app: DeckApp, part: str) -> str:
    """What stands in a part of the column."""
    found = app.screen.query_one(LessonColumn).query_one(f".{part}", Static)
    return str(found.content)


async def test_a_key_brings_the_lesson_and_its_ticks_and_takes_it_away() -> None:
    opener = own_opener()
    async with opened(opener, "deck") as (app, pilot):
        assert not app.screen.query(LessonColumn)
        await pilot.press("shift+f2")
        await until(lambda: opener.judged.asked == ["topic"], "the first step to be judged")
        opener.judged.say(ValuesDrawn(SEED))
        opener.judged.say(SEEN)
        await until(lambda: "nobody publishes" in beside(app, "checks"), "what was seen")
        assert beside(app, "head").startswith("1/")
        opener.judged.say(PASSED)
        await until(lambda: "L, then Enter" in beside(app, "checks"), "the tick")
        await pilot.press("shift+f2")
        await until(lambda: not app.screen.query(LessonColumn), "the Deck without it")


async def test_both_screens_have_one_judge_and_one_step() -> None:
    opener = own_opener()
    async with opened(opener, "deck") as (app, pilot):
        await pilot.press("shift+f2")
        await until(lambda: opener.judged.asked == ["topic"], "the first step to be judged")
        opener.judged.say(PASSED)
        await until(lambda: "Passed" in beside(app, "checks"), "the tick")
        await pilot.press("L")
        await until(lambda: "Passed" in text(app, "checks"), "the same on the Lesson screen")
        await pilot.press("enter")
        await until(lambda: opener.judged.asked == ["topic", "rate"], "the next step judged")
        await pilot.press("1")
        await until(lambda: beside(app, "head").startswith("2/"), "the next step on the Deck")


async def test_where_there_is_no_room_it_is_not_shown_until_there_is() -> None:
    opener = own_opener()
    async with opened(opener, "deck", (80, 24)) as (app, pilot):
        await pilot.press("shift+f2")
        await pilot.pause()
        assert not app.screen.query(LessonColumn)
        await pilot.resize_terminal(120, 40)
        await pilot.press("shift+f2")
        await until(lambda: app.screen.query(LessonColumn), "the column")
        await pilot.resize_terminal(80, 24)
        await until(lambda: not app.screen.query_one(LessonColumn).display, "no room for it")
