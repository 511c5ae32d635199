"""Questions of agents through a real supervisor: to its screens, and back."""

from __future__ import annotations

import asyncio

from launcher.client.client import attach
from launcher.consent import Approval, ConsentAnswer, ConsentVerdict
from launcher.events import AgentsEvent
from launcher.status import Severity
from tests.ros.supervised import SLEEPER, Launch
from tests.waiting import until
from text.sentences import say

NODE = {"node": {"exec": SLEEPER}}
LINES = (say("drives {metres} m", metres="0.4"), "because")


async def test_a_question_reaches_the_screen_and_its_answer_the_agent(start: Launch) -> None:
    screen = await start(NODE)
    await screen.attend()
    agent = await attach()
    await agent.join("k", "claude\n\x1b[31m", Approval.ASK)
    asking = asyncio.create_task(agent.ask_consent("k", LINES))
    (question,) = await until(lambda: screen.agents.questions, "the question")
    assert question.agent == "claude␊␛[31m"
    assert question.lines == LINES
    assert await screen.answer(question.number, ConsentAnswer.ONCE)
    assert await asking is ConsentVerdict.ALLOWED
    await until(lambda: not screen.agents.questions, "its end")
    assert not await screen.answer(question.number, ConsentAnswer.ONCE)
    await agent.aclose()
    await until(lambda: not screen.agents.connected, "the end of the agent")


async def test_a_screen_that_goes_away_refuses(start: Launch) -> None:
    agent = await start(NODE)
    await agent.join("k", "claude", Approval.ASK)
    assert await agent.ask_consent("k", LINES) is ConsentVerdict.NO_SCREEN
    screen = await attach()
    await screen.attend()
    asking = asyncio.create_task(agent.ask_consent("k", LINES))
    await until(lambda: screen.agents.questions, "the question")
    await screen.aclose()
    assert await asking is ConsentVerdict.SCREEN_GONE


async def test_what_is_said_of_agents_is_in_the_log_and_screens_hear_of_them(
    start: Launch,
) -> None:
    screen = await start(NODE)
    agent = await attach()
    await agent.join("k", "claude", Approval.ALWAYS)
    await agent.tell(Severity.INFO, say("agent “{name}” is connected", name="claude"))
    lines = [line for line in await screen.history(None, 100) if line.source == "agent"]
    assert [line.text for line in lines] == [
        "agent “claude” is connected",
        "agent “claude” drives without asking: --approve always",
        "agent “claude” is connected",
    ]
    async for event in screen.events():
        if isinstance(event, AgentsEvent) and event.agents.connected:
            assert event.agents.connected[0].approval is Approval.ALWAYS
            break
    await agent.aclose()
