"""The learner's own nodes on the Deck: exchanged and back, their mistakes, the editor."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot

from course.folder.folder import new_folder
from course.lessons.catalog import SHIPPED
from course.lessons.lesson import LessonFolder
from launcher.profile.text import SHIPPED as PROFILES
from launcher.status import HALTED, STUCK, NodeFault, NodeState, NodeStatus
from tests.tui.app_runs import opened
from tests.tui.recorded import SESSION, RecordedOpener, RecordedSession
from tests.tui.snapshots import Look, SnapCompare, both_languages
from tests.waiting import until
from text.sentences import say
from tui.app import DeckApp
from tui.dialogs.choice import ChoiceScreen
from tui.frame import title

LESSON = "02-sonar-safety"
MISTAKE = "self.publisher.publish(Float32(data=1))"


@pytest.fixture(autouse=True)
def course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A course folder of the test's own, and no editor."""
    monkeypatch.setenv("DECK_COURSE", str(tmp_path))
    monkeypatch.delenv("EDITOR", raising=False)
    monkeypatch.delenv("VISUAL", raising=False)
    return tmp_path


def lesson_opener(profile: Path, file: str = "", fault: NodeFault | None = None) -> RecordedOpener:
    """Lesson 2, its sonar by Deck or by a file."""
    command = "./mock_sonar.py" if file else "nodes.mock_sonar"
    nodes = {
        "sonar_front": NodeStatus(
            "sonar_front", command, NodeState.READY, pid=7, file=file, fault=fault
        ),
        "safety_stop": NodeStatus("safety_stop", "nodes.safety_stop", NodeState.READY, pid=8),
    }
    session = replace(
        SESSION, name=LESSON, profile=str(profile), lesson="2", title={}, panels=("sonar",)
    )
    return RecordedOpener(link=RecordedSession(session, nodes, ()))


def shown(app: DeckApp) -> str:
    """What is on the screen."""
    return "\n".join(strip.text for strip in app.screen._compositor.render_strips())


def asked(opener: RecordedOpener) -> Callable[[], object]:
    """Whether an exchange was asked for."""
    return lambda: opener.link.asked or None


async def test_decks_node_is_exchanged_for_the_file_of_the_lessons_folder_which_is_made(
    course: Path,
) -> None:
    opener = lesson_opener(PROFILES / f"{LESSON}.yaml")
    async with opened(opener) as (app, pilot):
        await pilot.press("u")
        await until(asked(opener), "the exchange")
        own = course / LESSON / "mock_sonar.py"
        assert opener.link.asked == [("exchange", "sonar_front", str(own))]
        assert own.is_file()
        opener.link.set_state("sonar_front", NodeState.READY, file=str(own))
        await until(lambda: "sonar_front ✎" in shown(app), "the mark")
        await pilot.press("u")
        await until(lambda: len(opener.link.asked) == 2, "the way back")
        assert opener.link.asked[-1] == ("exchange", "sonar_front", "")


async def test_ones_own_profile_can_have_decks_node_for_a_while(course: Path) -> None:
    made = new_folder(LessonFolder(SHIPPED / LESSON))
    file = str(course / LESSON / "mock_sonar.py")
    opener = lesson_opener(made.path / "lesson.yaml", file)
    async with opened(opener) as (_app, pilot):
        await pilot.press("u")
        await until(asked(opener), "the exchange")
        assert opener.link.asked == [("exchange", "sonar_front", "nodes.mock_sonar")]


async def test_of_several_files_one_is_chosen(course: Path) -> None:
    new_folder(LessonFolder(SHIPPED / LESSON))
    (course / "mine").mkdir()
    (course / "mine" / "other.py").write_text("pass\n")
    (course / "mine" / "lesson.yaml").write_text("nodes: {sonar_front: {run: ./other.py}}\n")
    opener = lesson_opener(PROFILES / f"{LESSON}.yaml")
    async with opened(opener) as (app, pilot):
        await pilot.press("u")
        await until(lambda: isinstance(app.screen, ChoiceScreen), "the question")
        await pilot.press("down", "enter")
        await until(asked(opener), "the exchange")
        assert opener.link.asked[0][2] == str(course / "mine" / "other.py")


@both_languages
def test_a_mistake_in_ones_own_file_looks(look: Look, snap_compare: SnapCompare) -> None:
    """Place and exception in the row of the node, the line and what it means below the table."""
    file = f"/home/eve/deck-course/{LESSON}/mock_sonar.py"
    fault = NodeFault(
        "crash",
        file,
        31,
        0,
        f"        {MISTAKE}",
        "AssertionError: The 'data' field must be of type 'float'",
        say("The field {field} is a float: write {value}.0, not {value}.", field="data", value="1"),
    )
    opener = lesson_opener(PROFILES / f"{LESSON}.yaml", file, fault)

    async def settle(pilot: Pilot[Any]) -> None:
        await look.settle(pilot)
        assert isinstance(pilot.app, DeckApp)
        said = shown(pilot.app)
        assert "mock_sonar.py:31" in said
        assert MISTAKE in said

    assert snap_compare(look.app("deck", opener), terminal_size=look.size, run_before=settle)


@pytest.mark.parametrize(("kind", "word"), [(STUCK, "stuck"), (HALTED, "halted")])
async def test_a_node_that_is_not_at_work_is_not_counted_as_ready(kind: str, word: str) -> None:
    opener = lesson_opener(PROFILES / f"{LESSON}.yaml", fault=NodeFault(kind, exception="since"))
    async with opened(opener) as (app, _pilot):
        await until(lambda: f"✗ {word}" in shown(app), "its state")
        assert "○ 1/2" in title.states(app)[0]
        assert "● ready" in shown(app), "the other one is"


async def test_which_editor_is_asked_once_and_kept(
    course: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("micro", "vim"):
        (course / name).write_text("#!/bin/sh\n")
        (course / name).chmod(0o755)
    monkeypatch.setenv("PATH", str(course))
    opener = lesson_opener(PROFILES / f"{LESSON}.yaml", str(course / "mock_sonar.py"))
    async with opened(opener) as (app, pilot):
        await pilot.press("e")
        await until(lambda: isinstance(app.screen, ChoiceScreen), "the question")
        assert "micro" in shown(app)
        await pilot.press("down", "enter")
        await until(lambda: app.editor == "vim", "the answer")
        await until(lambda: not isinstance(app.screen, ChoiceScreen), "the Deck again")
        await pilot.press("e")
        await pilot.pause()
        assert not isinstance(app.screen, ChoiceScreen)
