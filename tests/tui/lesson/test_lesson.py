"""The Lesson screen with a judge that was written down: ticks, hints, the solution, going on."""

from __future__ import annotations

import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Static

from course.judge.kinds import expected
from course.judging import ValuesDrawn
from course.lessons.catalog import SHIPPED
from course.lessons.lesson import LessonFolder
from course.progress import load_progress, noted, state_of
from course.results import CheckResult, State, StepResult
from launcher.status import NodeFault, NodeState, NodeStatus
from tests.tui.recorded import SESSION, RecordedOpener, RecordedSession
from tests.tui.snapshots import opened, seen
from tests.waiting import until
from text.i18n import set_language
from text.sentences import say
from tui.app import DeckApp
from tui.dialogs.choice import ChoiceScreen
from tui.lesson.column import LessonColumn
from tui.session.requests import WholeGrade

LESSON = "02-sonar-safety"
LONG_TASK = "03-head-service"
WORD = re.compile(r"[^\W\d_]{4,}|/\w+")
"""What can be found again however it is wrapped."""
SEED = 4711
SEEN = StepResult(
    "topic",
    State.FAILED,
    2,
    (
        CheckResult(
            State.FAILED,
            expected(LessonFolder(SHIPPED / LESSON).steps[0].checks[0]),
            say("nobody publishes {topic}", topic="/sensor/sonar_front"),
            say("Is create_publisher called in __init__, and is the name of the topic right?"),
        ),
    ),
)
PASSED = StepResult("topic", State.PASSED, 2, (CheckResult(State.PASSED, "/sensor/sonar_front"),))


@pytest.fixture(autouse=True)
def course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("DECK_COURSE", str(tmp_path))
    return tmp_path


def own_opener(
    file: str = "/home/eve/deck-course/02-sonar-safety/mock_sonar.py", kind: str = "warning"
) -> RecordedOpener:
    """Lesson 2 with the learner's own sonar, which has a mistake of this kind."""
    fault = NodeFault(kind, file, 12, 0, "self.publiser = 1", "NameError: name 'x'", "")
    nodes = {
        "sonar_front": NodeStatus("sonar_front", "./mock_sonar.py", NodeState.READY, pid=7, file=file, fault=fault),
        "safety_stop": NodeStatus("safety_stop", "nodes.safety_stop", NodeState.READY, pid=8),
    }
    session = replace(SESSION, name=LESSON, lesson="2", title={}, panels=())
    task = LessonFolder(SHIPPED / LESSON)
    return RecordedOpener(link=RecordedSession(session, nodes, ()), task=task)


@asynccontextmanager
async def learning(opener: RecordedOpener) -> AsyncIterator[tuple[DeckApp, Pilot[Any]]]:
    async with opened(opener, "lesson") as (app, pilot):
        await until(lambda: opener.judged.asked, "the first step to be judged")
        yield app, pilot


def text(app: DeckApp, name: str) -> str:
    return str(app.screen.query_one(f"#lesson-{name}", Static).content)


async def test_at_80x24_a_task_is_seen_whole_above_its_check_however_far_one_reads() -> None:
    set_language("ru")
    opener = replace(own_opener(), task=LessonFolder(SHIPPED / LONG_TASK))
    async with opened(opener, "lesson", (80, 24)) as (app, pilot):
        await until(lambda: opener.judged.asked, "the first step to be judged")
        step = opener.judged.asked[0]
        assert opener.task is not None
        told = WORD.findall(opener.task.texts("ru").task(step))
        opener.judged.say(replace(SEEN, id=step))
        await until(lambda: "→" in text(app, "checks"), "the result")
        await pilot.press("end")
        await pilot.pause()
        words = WORD.findall(seen(app))
        assert told
        assert [word for word in told if word not in words] == []
        assert "✗ /sensor/sonar_front" in seen(app)


async def test_a_passed_step_stays_until_a_key_goes_on_and_is_noted() -> None:
    opener = own_opener()
    async with learning(opener) as (app, pilot):
        assert opener.judged.asked == ["topic"]
        await pilot.press("enter")
        assert text(app, "head").startswith("1/")
        opener.judged.say(ValuesDrawn(SEED))
        opener.judged.say(SEEN)
        await until(lambda: "nobody publishes" in text(app, "checks"), "what was seen")
        assert str(SEED) in text(app, "overview")
        opener.judged.say(PASSED)
        await until(lambda: "Enter" in text(app, "checks"), "the tick")
        assert text(app, "head").startswith("1/")
        assert load_progress().passed(LESSON) == {"topic"}
        await pilot.press("enter")
        await until(lambda: opener.judged.asked == ["topic", "rate"], "the next step judged")
        assert text(app, "head").startswith("2/")
    assert opener.judged.closed


async def test_the_next_time_it_goes_on_where_the_learner_left_off(course: Path) -> None:
    (course / "progress.json").write_text(
        '{"lessons": {"02-sonar-safety": {"topic": {"passed": true, "points": 2}}}}'
    )
    opener = own_opener()
    async with learning(opener) as (app, _pilot):
        assert opener.judged.asked == ["rate"]
        assert opener.judged.passed == {"topic"}
        assert "2 of 10 points" in text(app, "overview")


async def test_ticks_fade_when_a_file_changes_and_cheap_ones_are_judged_again(course: Path) -> None:
    file = course / "mock_sonar.py"
    file.write_text("right = 1\n")
    opener = own_opener(str(file))
    async with learning(opener) as (app, pilot):
        opener.judged.say(ValuesDrawn(SEED))
        opener.judged.say(PASSED)
        await until(lambda: "Enter" in text(app, "checks"), "the tick")
        assert text(app, "overview").startswith("[✓]")
        await pilot.press("enter")
        await until(lambda: opener.judged.asked == ["topic", "rate"], "the next step judged")
        file.write_text("while True: pass\n")
        opener.link.set_state("sonar_front", NodeState.READY, pid=9)
        await until(lambda: opener.judged.asked[2:] == ["topic"], "the first one judged again")
        assert text(app, "overview").startswith(" ○ ")
        assert "0 of 10 points" in text(app, "overview")
        opener.judged.say(SEEN)
        await until(lambda: opener.judged.asked[3:] == ["rate"], "the step at hand judged")
        await pilot.press("N")
        await until(lambda: "was right at" in text(app, "head"), "when it was right")
        assert "nobody publishes" in text(app, "checks")


async def test_a_lesson_ends_with_its_grade_and_what_fails_there_loses_its_tick(course: Path) -> None:
    file = course / "mock_sonar.py"
    file.write_text("right = 1\n")
    opener = own_opener(str(file))
    opener.grades = WholeGrade(8, 10, {"ends": "it does not end"})
    async with learning(opener) as (app, pilot):
        lesson = LessonFolder(SHIPPED / LESSON)
        for step in lesson.steps:
            await until(lambda id_=step.id: opener.judged.asked[-1] == id_, step.id)  # type: ignore[misc]
            assert opener.graded == []
            opener.judged.say(StepResult(step.id, State.PASSED, step.points))
            if step.id != "ends":
                await until(lambda: "Passed" in text(app, "checks"), "the tick")
                await pilot.press("enter")
        await until(lambda: "8 of 10" in text(app, "checks"), "the grade")
        assert opener.graded == [course]
        assert "it does not end" in text(app, "checks")
        assert text(app, "overview").startswith(" ✓  ✓  ✓  ✓ [·]")
        assert "ends" not in load_progress().passed(LESSON)


async def test_hints_come_one_by_one_and_then_the_solution_beside_ones_own_file(course: Path) -> None:
    file = course / "mock_sonar.py"
    file.write_text("mine = 1\n")
    async with learning(own_opener(str(file))) as (app, pilot):
        await pilot.press("T")
        assert "Hint 1" in text(app, "hints")
        assert "Hint 2" not in text(app, "hints")
        await pilot.press("T")
        assert "Hint 2" in text(app, "hints")
        assert "mine" not in text(app, "text")
        await pilot.press("T")
        await until(lambda: isinstance(app.screen, ChoiceScreen), "the question")
        await pilot.press("escape")
        assert not load_progress().step(LESSON, "topic").solution
        await pilot.press("T")
        await until(lambda: isinstance(app.screen, ChoiceScreen), "the question again")
        await pilot.press("enter")
        await until(lambda: "- mine = 1" in text(app, "text"), "the difference")
        assert "with the solution" in text(app, "head")
        assert "+ import rclpy" in text(app, "text")
        await pilot.press("tab")
        assert app.focused is app.screen.query_one("#lesson-side")
        step = load_progress().step(LESSON, "topic")
        assert (step.hints, step.solution, step.passed) == (2, True, False)


async def test_what_the_lesson_says_of_a_mistake_waits_for_a_hint_to_be_asked_for(course: Path) -> None:
    opener = own_opener(str(course / "mock_sonar.py"))
    (check,) = SEEN.checks
    async with learning(opener) as (app, pilot):
        opener.judged.say(replace(SEEN, checks=(replace(check, hint="create_publisher(Float32)"),)))
        await until(lambda: "Is create_publisher called" in text(app, "checks"), "where to look")
        await pilot.press("T")
        await until(lambda: "→ create_publisher(Float32)" in text(app, "checks"), "the hint")


async def test_the_last_step_leads_to_the_next_lesson(course: Path) -> None:
    file = course / "mock_sonar.py"
    file.write_text("right = 1\n")
    files = state_of([str(file)])
    for step in LessonFolder(SHIPPED / LESSON).steps:
        noted(LESSON, step.id, {"passed": True, "points": step.points, "files": files, "at": 1})
    opener = own_opener(str(file))
    async with opened(opener, "lesson") as (app, pilot):
        await until(lambda: "10 of 10" in text(app, "overview"), "all steps")
        await pilot.press(*"nnnn")
        await until(lambda: "opens the next lesson, 03-head-service" in text(app, "checks"), "it")
        await pilot.press("enter")
        await until(lambda: len(opener.orders) == 2, "the next lesson to be opened")
    assert opener.orders[-1].profile == course / LONG_TASK / "lesson.yaml"


async def test_decks_own_nodes_are_not_judged_and_a_folder_is_offered(course: Path) -> None:
    opener = own_opener(file="")
    async with opened(opener, "lesson") as (app, pilot):
        await until(lambda: "C starts files" in text(app, "checks"), "the offer")
        assert not opener.judged.asked
        await pilot.press("C")
        await until(lambda: len(opener.orders) == 2, "the folder to be opened")
    assert opener.orders[-1].profile == course / LESSON / "lesson.yaml"
    assert (course / LESSON / "mock_sonar.py").is_file()


def beside(app: DeckApp, part: str) -> str:
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
