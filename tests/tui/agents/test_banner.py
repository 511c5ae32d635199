"""Agents ask on every screen, and only a person who has read the question lets them drive."""

from __future__ import annotations

import pytest
from textual.widgets import TextArea

from launcher.consent import Agent, Agents, Approval, Question
from launcher.events import AgentsEvent, LogEvent
from launcher.status import LogLine, Severity
from tests.tui.recorded import NOW_S, RecordedOpener
from tests.tui.snapshots import opened
from tests.waiting import until
from text.sentences import say
from tui.app import DeckApp
from tui.flow.screen import FlowScreen
from tui.frame.agent_banner import AgentBanner

LINES = (say("it says: {reason}", reason="to see what is behind the box"),)
CLAUDE = Agent("claude", Approval.ASK)


def asks(number: int = 1, lines: tuple[str, ...] = LINES) -> AgentsEvent:
    return AgentsEvent(Agents((CLAUDE,), (Question(number, "claude", lines, NOW_S + 30),)))


def banner(app: DeckApp) -> str:
    """Return what the banner in front says, empty if it is not there."""
    found = app.screen.query_one(AgentBanner)
    return found.text if found.display else ""


async def read(app: DeckApp) -> None:
    await until(lambda: app.agents.was_read, "a question that was read")


async def test_the_banner_is_on_every_screen_and_goes_with_the_question() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        assert banner(app) == ""
        opener.link.say(asks())
        for key in ("1", "2", "3", "4", "5", "6", "7"):
            await pilot.press(key)
            await pilot.pause()
            assert "claude" in banner(app), key
            if app.focused is not None and isinstance(app.focused, TextArea):
                await pilot.press("escape")
        opener.link.say(AgentsEvent(Agents((CLAUDE,))))
        await until(lambda: banner(app) == "", "the end of the banner")


@pytest.mark.parametrize(("key", "answer"), [("shift+f4", "once"), ("shift+f5", "time")])
async def test_keys_answer_once_the_question_was_read(key: str, answer: str) -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        opener.link.say(asks(7))
        await until(lambda: banner(app), "the banner")
        await pilot.press(key)
        await pilot.pause()
        assert opener.link.asked == [], "too early: nobody can have read it"
        await read(app)
        await pilot.press(key)
        await until(lambda: opener.link.asked, "an answer")
        assert opener.link.asked == [("answer", "7", answer)]


async def test_the_emergency_stop_refuses() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        opener.link.say(asks())
        await until(lambda: banner(app), "the banner")
        await pilot.press("space")
        await until(lambda: ("end_consent",) in opener.link.asked, "a refusal")


async def test_nobody_who_types_into_an_editor_allows_anything() -> None:
    opener = RecordedOpener()
    async with opened(opener, "composer") as (app, pilot):
        app.screen.query_one(TextArea).focus()
        opener.link.say(asks())
        await read(app)
        await pilot.press(*"yes ok y", "enter", "tab", "shift+tab", "ctrl+y", "f4", "f5")
        await pilot.pause()
        assert all(asked[0] != "answer" for asked in opener.link.asked)


async def test_a_question_that_is_covered_is_not_answered() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        opener.link.say(asks())
        await read(app)
        await pilot.press("f1")
        await pilot.pause()
        assert not app.agents.was_read
        await pilot.press("shift+f4")
        await pilot.pause()
        assert opener.link.asked == []


async def test_what_an_agent_does_begins_a_chain() -> None:
    opener = RecordedOpener()
    async with opened(opener, "flow") as (app, _pilot):
        screen = app.screen
        assert isinstance(screen, FlowScreen)
        does = say("agent “{agent}” does {id}: {words}", agent="claude", id="p1", words="drives")
        opener.link.say(LogEvent((LogLine("agent", 1, NOW_S, Severity.WARN, does, "", "agent"),)))
        chains = await until(lambda: [one for one in screen.chains if one.first.lane.value == "agent"], "a chain")
        assert [one.first.text for one in chains] == ["agent “claude” does p1: drives"]
