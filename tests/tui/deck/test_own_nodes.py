"""The learner's own nodes on the Deck: exchanged and back, their mistakes, the editor."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from launcher.profile.defaults import SHIPPED as PROFILES
from launcher.status import HALTED, STUCK, NodeFault, NodeState, NodeStatus
from tests.tui.recorded import SESSION, RecordedOpener, RecordedSession
from tests.tui.snapshots import opened, seen
from tests.waiting import until
from text.sentences import say
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
        "sonar_front": NodeStatus("sonar_front", command, NodeState.READY, pid=7, file=file, fault=fault),
        "safety_stop": NodeStatus("safety_stop", "nodes.safety_stop", NodeState.READY, pid=8),
    }
    session = replace(SESSION, name=LESSON, profile=str(profile), lesson="2", title={}, panels=("sonar",))
    return RecordedOpener(link=RecordedSession(session, nodes, ()))


def asked(opener: RecordedOpener) -> Callable[[], object]:
    return lambda: opener.link.asked or None


async def test_decks_node_is_exchanged_for_the_file_of_the_lessons_folder_which_is_made(course: Path) -> None:
    opener = lesson_opener(PROFILES / f"{LESSON}.yaml")
    async with opened(opener) as (app, pilot):
        await pilot.press("u")
        await until(asked(opener), "the exchange")
        own = course / LESSON / "mock_sonar.py"
        assert opener.link.asked == [("exchange", "sonar_front", str(own))]
        assert own.is_file()
        opener.link.set_state("sonar_front", NodeState.READY, file=str(own))
        await until(lambda: "sonar_front ✎" in seen(app), "the mark")
        await pilot.press("u")
        await until(lambda: len(opener.link.asked) == 2, "the way back")
        assert opener.link.asked[-1] == ("exchange", "sonar_front", "")


async def test_a_mistake_in_ones_own_file_stands_at_its_node_with_place_line_and_mend() -> None:
    file = f"/home/eve/deck-course/{LESSON}/mock_sonar.py"
    words = "AssertionError: The 'data' field must be of type 'float'"
    mend = say("The field {field} is a float: write {value}.0, not {value}.", field="data", value="1")
    fault = NodeFault("crash", file, 31, 0, f"        {MISTAKE}", words, mend)
    opener = lesson_opener(PROFILES / f"{LESSON}.yaml", file, fault)
    async with opened(opener, size=(80, 24)) as (app, _pilot):
        await until(lambda: MISTAKE in seen(app), "the line")
        told = " ".join(seen(app).split())
        assert "mock_sonar.py:31" in told
        assert "write 1.0, not 1." in told


@pytest.mark.parametrize(("kind", "word"), [(STUCK, "stuck"), (HALTED, "halted")])
async def test_a_node_that_is_not_at_work_is_not_counted_as_ready(kind: str, word: str) -> None:
    opener = lesson_opener(PROFILES / f"{LESSON}.yaml", fault=NodeFault(kind, exception="since"))
    async with opened(opener) as (app, _pilot):
        await until(lambda: f"✗ {word}" in seen(app), "its state")
        assert "○ 1/2" in title.states(app)[0]
        assert "● ready" in seen(app), "the other one is"


async def test_which_editor_is_asked_once_and_kept(course: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("micro", "vim"):
        (course / name).write_text("#!/bin/sh\n")
        (course / name).chmod(0o755)
    monkeypatch.setenv("PATH", str(course))
    opener = lesson_opener(PROFILES / f"{LESSON}.yaml", str(course / "mock_sonar.py"))
    async with opened(opener) as (app, pilot):
        await pilot.press("e")
        await until(lambda: isinstance(app.screen, ChoiceScreen), "the question")
        assert "micro" in seen(app)
        await pilot.press("down", "enter")
        await until(lambda: app.editor == "vim", "the answer")
        await until(lambda: not isinstance(app.screen, ChoiceScreen), "the Deck again")
        await pilot.press("e")
        await pilot.pause()
        assert not isinstance(app.screen, ChoiceScreen)
