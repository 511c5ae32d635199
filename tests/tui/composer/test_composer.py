"""The composer: what is wrong is pointed at, what stands there is sent, what came is told."""

from __future__ import annotations

from collections.abc import AsyncIterator
from dataclasses import replace
from pathlib import Path

import pytest
from textual.events import Paste
from textual.widgets import OptionList, Static

from graph.data import EndpointInfo, Sample, TopicRow
from graph.observer.requests import PreparePublisher, Publish
from tests.tui.composer.test_outcome import result
from tests.tui.recorded import RecordedGraph, RecordedOpener, lesson_update
from tests.tui.screen_stage import ScreenStage, on_stage
from tests.tui.snapshots import settle
from tui import clock
from tui.composer.dialogs import TEMPLATES
from tui.composer.screen import ComposerScreen
from tui.composer.sent import Sent, sent_path
from tui.dialogs.choice import ChoiceScreen
from tui.outcome.trail import FOLLOWED

VALID = '{"thought": "go", "commands": [{"action": "drive", "speed": 0.1, "steering": 0.0}]}'
TOO_FAST = VALID.replace("0.1", "9.0")
STRING = "std_msgs/msg/String"
_LISTENER = EndpointInfo("/llm_parser", STRING, "reliable", "volatile")
PARSER = TopicRow("/llm_raw_json", (STRING,), 0, 1, subscribed_by=(_LISTENER,))


class ComposerStage(ScreenStage[ComposerScreen]):
    """The composer over a recorded graph."""

    name, kind = "composer", ComposerScreen

    async def write(self, text: str) -> None:
        """Put a text into the editor and wait until it is checked."""
        self.screen.draft.editor.replace_all(text)
        self.screen.draft.check()
        await self.pilot.pause()

    async def hear(self, *samples: Sample, after_s: float = 0.02) -> None:
        come = [replace(one, received_s=clock.now() + after_s) for one in samples]
        topics = (*lesson_update().topics, PARSER)
        await self.show(lesson_update(topics=topics, samples={one.topic: (one,) for one in come}))

    def told(self) -> list[str]:
        return [f"{one.mark} {one.topic}: {one.text}" for one in self.screen.outcome.entries]


@pytest.fixture(autouse=True)
def _own_history(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))


@pytest.fixture
async def stage() -> AsyncIterator[ComposerStage]:
    topics = (*lesson_update().topics, PARSER)
    graph = RecordedGraph(update=lesson_update(topics=topics, samples={}))
    async with on_stage(ComposerStage, RecordedOpener(graph=graph)) as found:
        yield found


async def test_it_opens_with_a_valid_example_and_says_who_listens(stage: ComposerStage) -> None:
    assert stage.screen.draft.editor.text == TEMPLATES[0].text()
    assert stage.screen.problems == ()
    to = str(stage.screen.query_one("#composer-to", Static).content)
    assert to == "/llm_raw_json → llm_parser"
    assert stage.graph.asked(PreparePublisher)[-1][:2] == ("/llm_raw_json", "std_msgs/msg/String")


async def test_sending_publishes_exactly_what_stands_there(stage: ComposerStage) -> None:
    text = VALID.replace("go", "вперёд 🤖 \\u0000")
    await stage.write(text)
    await stage.pilot.press("ctrl+s")
    await stage.pilot.pause()
    assert stage.graph.asked(Publish) == [("/llm_raw_json", "std_msgs/msg/String", {"data": text}, False)]
    assert stage.told() == ["· /llm_result: waiting for an answer"]


async def test_the_trail_is_followed_also_while_another_screen_is_in_front(stage: ComposerStage) -> None:
    assert stage.graph.wanted.followed >= FOLLOWED
    await stage.write(VALID)
    await stage.pilot.press("ctrl+s", "f5")
    await settle(stage.pilot)
    assert stage.graph.wanted.followed >= FOLLOWED
    await stage.hear(result(event="accepted", commands=1, thought=""))
    await stage.pilot.press("f4")
    await settle(stage.pilot)
    assert stage.told()[0].startswith("✓ /llm_result: accepted")


async def test_what_is_wrong_is_marked_listed_and_not_sent(stage: ComposerStage) -> None:
    await stage.write(TOO_FAST)
    assert stage.screen.draft.editor.render_line(0).text.startswith("1✗")
    listed = stage.screen.draft.verdict.query_one(OptionList)
    assert str(listed.get_option_at_index(0).prompt) == (
        "line 1, column 61: commands[0].speed: must be from -0.5 to 0.5 m/s, not 9"
    )
    await stage.pilot.press("ctrl+s")
    await stage.pilot.pause()
    assert stage.graph.asked(Publish) == []
    assert stage.screen.draft.editor.cursor_location == (0, 60)


async def test_what_is_wrong_is_sent_by_a_key_of_its_own(stage: ComposerStage) -> None:
    await stage.write(TOO_FAST)
    await stage.pilot.press("ctrl+o")
    problem = {"field": "commands[0].speed", "line": 1, "column": 59, "message": "too fast"}
    await stage.hear(result(event="refused", problems=[problem]))
    assert stage.graph.asked(Publish)[0][2] == {"data": TOO_FAST}
    assert stage.told() == [
        "✗ /llm_result: refused: nothing of it is executed",
        "✗ /llm_result: line 1, column 59: commands[0].speed: too fast",
    ]


async def test_a_key_walks_from_problem_to_problem(stage: ComposerStage) -> None:
    await stage.write('{"thought": 1,\n "commands": [\n {"action": "jump"}]}')
    seen = []
    for _press in range(3):
        await stage.pilot.press("ctrl+n")
        seen.append(stage.screen.draft.editor.cursor_location)
    assert seen == [(0, 12), (2, 12), (0, 12)]


async def test_a_template_takes_the_place_of_the_text(stage: ComposerStage) -> None:
    await stage.pilot.press("ctrl+t")
    await stage.pilot.pause()
    assert isinstance(stage.app.screen, ChoiceScreen)
    await stage.pilot.press("down", "enter")
    await stage.pilot.pause()
    assert stage.screen.draft.editor.text == TEMPLATES[1].text()
    await stage.pilot.press("ctrl+t", "escape")
    await stage.pilot.pause()
    assert stage.screen.draft.editor.text == TEMPLATES[1].text()


def recalled(sent: Sent) -> list[str]:
    """Walk back through all of it; return it from the oldest to the newest."""
    texts: list[str] = []
    while (text := sent.step(-1, "")) is not None:
        texts.append(text)
    return texts[::-1]


async def test_what_was_sent_is_recalled_and_the_draft_comes_back(stage: ComposerStage) -> None:
    for text in (VALID, TOO_FAST):
        await stage.write(text)
        await stage.pilot.press("ctrl+o" if text == TOO_FAST else "ctrl+s")
    await stage.write("draft")
    seen = []
    for key in ("alt+up", "alt+up", "alt+up", "alt+down", "alt+down", "alt+down"):
        await stage.pilot.press(key)
        seen.append(stage.screen.draft.editor.text)
    assert seen == [TOO_FAST, VALID, VALID, TOO_FAST, "draft", "draft"]
    assert recalled(Sent(sent_path())) == [VALID, TOO_FAST]


async def test_without_a_lesson_nothing_is_sent(stage: ComposerStage) -> None:
    await stage.app.feed.disconnect("it has ended")
    await stage.pilot.press("ctrl+s")
    await stage.pilot.pause()
    assert stage.graph.asked(Publish) == []


async def test_a_megabyte_is_not_pasted(stage: ComposerStage) -> None:
    stage.screen.draft.editor.focus()
    await stage.write("")
    for pasted, text in (("x" * 1_000_000, ""), ("[1]", "[1]")):
        stage.app.post_message(Paste(pasted))
        await stage.pilot.pause()
        assert stage.screen.draft.editor.text == text


async def test_escape_gives_the_keys_back_that_enter_has_given_to_the_editor(stage: ComposerStage) -> None:
    await stage.write("")
    await stage.press("7", "3", "enter", "4", "5", "escape", "4")
    assert stage.screen.draft.editor.text == "45", "typed only after Enter"
    assert getattr(stage.app.screen, "tab", "") == "logs"
