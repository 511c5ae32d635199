"""What agents may do: asked, answered and forgotten."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping

import pytest

from launcher.consent import Agents, Approval, ConsentAnswer, ConsentVerdict, Question
from launcher.control.consent import ConsentDesk, TooSoonError
from launcher.control.requests import BadRequestError, requests_of, serve
from tests.waiting import until
from text.sentences import say

SCREEN, AGENT = "screen", "agent"
LINES = (say("drives {metres} m", metres="0.4"),)


def desk(asked_for_s: float = 30.0, allowed_for_s: float = 300.0) -> ConsentDesk:
    made = ConsentDesk(lambda: None, lambda *_: None, asked_for_s, allowed_for_s)
    made.join(AGENT, "k", "claude", Approval.ASK)
    return made


async def asked(made: ConsentDesk) -> tuple[asyncio.Task[ConsentVerdict], Question]:
    """Ask, and return the question that is on the screen now."""
    before = len(made.state.questions)
    asking = asyncio.create_task(made.ask(AGENT, "k", LINES))
    questions = await until(lambda: made.state.questions[before:], "a question")
    return asking, questions[0]


async def serve_agents(made: ConsentDesk, client: str, message: Mapping[str, object]) -> None:
    await serve(requests_of(made), client, message)


async def test_without_a_screen_nothing_is_allowed() -> None:
    assert await desk().ask(AGENT, "k", LINES) is ConsentVerdict.NO_SCREEN


@pytest.mark.parametrize(
    ("answer", "verdict"),
    [
        (ConsentAnswer.ONCE, ConsentVerdict.ALLOWED),
        (ConsentAnswer.FOR_A_TIME, ConsentVerdict.ALLOWED),
        (ConsentAnswer.REFUSE, ConsentVerdict.REFUSED),
    ],
)
async def test_a_person_answers_once(answer: ConsentAnswer, verdict: ConsentVerdict) -> None:
    made = desk()
    made.attend(SCREEN)
    asking, question = await asked(made)
    assert question.agent == "claude"
    assert question.lines == LINES
    assert made.answer(SCREEN, question.number, answer)
    assert await asking is verdict
    assert made.state.questions == ()
    assert not made.answer(SCREEN, question.number, ConsentAnswer.ONCE)


async def test_an_allowance_for_a_time_asks_no_more_until_it_is_ended() -> None:
    made = desk()
    made.attend(SCREEN)
    asking, question = await asked(made)
    made.answer(SCREEN, question.number, ConsentAnswer.FOR_A_TIME)
    await asking
    assert made.state.connected[0].allowed_until_s > 0
    assert await made.ask(AGENT, "k", LINES) is ConsentVerdict.ALLOWED_BEFORE
    made.end_consent()
    assert made.state.connected[0].allowed_until_s == 0
    again, _question = await asked(made)
    made.end_consent()
    assert await again is ConsentVerdict.ENDED


async def test_an_allowance_runs_out() -> None:
    made = desk(allowed_for_s=0.05)
    made.attend(SCREEN)
    asking, question = await asked(made)
    made.answer(SCREEN, question.number, ConsentAnswer.FOR_A_TIME)
    await asking
    await until(lambda: made.state.connected[0].allowed_until_s == 0, "the end of the allowance")
    again, _question = await asked(made)
    made.withdraw(AGENT)
    assert await again is ConsentVerdict.ENDED


async def test_an_allowance_is_for_one_agent() -> None:
    made = desk()
    made.join(AGENT, "other", "gpt", Approval.ASK)
    made.attend(SCREEN)
    asking, question = await asked(made)
    made.answer(SCREEN, question.number, ConsentAnswer.FOR_A_TIME)
    await asking
    other = asyncio.create_task(made.ask(AGENT, "other", LINES))
    await until(lambda: made.state.questions, "a question")
    made.leave(AGENT)
    assert await other is ConsentVerdict.ENDED
    assert made.state == Agents()


async def test_no_answer_is_a_refusal() -> None:
    made = desk(asked_for_s=0.05)
    made.attend(SCREEN)
    assert await made.ask(AGENT, "k", LINES) is ConsentVerdict.LATE
    assert made.state.questions == ()


async def test_the_last_screen_that_goes_takes_questions_and_allowances_with_it() -> None:
    made = desk()
    made.attend(SCREEN)
    asking, question = await asked(made)
    made.answer(SCREEN, question.number, ConsentAnswer.FOR_A_TIME)
    await asking
    made.leave(SCREEN)
    assert made.state.connected[0].allowed_until_s == 0
    made.attend(SCREEN)
    made.attend("another screen")
    again, _question = await asked(made)
    made.leave(SCREEN)
    assert not again.done()
    made.leave("another screen")
    assert await again is ConsentVerdict.SCREEN_GONE


async def test_nobody_answers_for_themselves() -> None:
    made = desk()
    for request in ({"op": "attend"}, {"op": "answer", "question": 1, "answer": "once"}):
        with pytest.raises(BadRequestError):
            await serve_agents(made, AGENT, request)
    await serve_agents(made, SCREEN, {"op": "attend"})
    join = {"op": "join", "key": "k", "name": "x", "approval": "ask"}
    with pytest.raises(BadRequestError):
        await serve_agents(made, SCREEN, join)


@pytest.mark.parametrize(
    "request_",
    [
        {"op": "join", "key": "k", "name": "x" * 100, "approval": "ask"},
        {"op": "join", "key": 1, "name": "x", "approval": "ask"},
        {"op": "join", "key": "k", "name": "x", "approval": "yes"},
        {"op": "ask", "key": "unknown", "lines": ["a"]},
        {"op": "ask", "key": "k", "lines": []},
        {"op": "ask", "key": "k", "lines": ["x" * 5000]},
        {"op": "ask", "key": "k", "lines": [3]},
        {"op": "ask", "key": "k", "lines": [["a"]]},
        {"op": "tell", "severity": "loud", "words": "a"},
        {"op": "tell", "severity": "info", "words": None},
    ],
)
async def test_nonsense_is_refused(request_: dict[str, object]) -> None:
    with pytest.raises(BadRequestError):
        await serve_agents(desk(), AGENT, request_)


async def test_whoever_was_refused_leaves_the_person_alone_for_longer_each_time() -> None:
    """A new name does not help; what a person allows ends it."""
    waited = []
    made = ConsentDesk(lambda: None, lambda *_: None, refused_for_s=0.1)
    made.join(AGENT, "k", "claude", Approval.ASK)
    made.attend(SCREEN)
    for number in range(3):
        asking, question = await asked(made)
        made.answer(SCREEN, question.number, ConsentAnswer.REFUSE)
        assert await asking is ConsentVerdict.REFUSED
        made.join("another", str(number), f"new {number}", Approval.ASK)
        with pytest.raises(TooSoonError) as soon:
            await made.ask("another", str(number), LINES)
        waited.append(soon.value.wait_s)
        assert made.state.questions == ()
        await asyncio.sleep(soon.value.wait_s)
    assert 0.0 < waited[0] <= 0.1
    assert 0.1 < waited[1] <= 0.2
    assert 0.2 < waited[2] <= 0.4
    asking, question = await asked(made)
    made.answer(SCREEN, question.number, ConsentAnswer.ONCE)
    assert await asking is ConsentVerdict.ALLOWED
    asking, question = await asked(made)
    made.answer(SCREEN, question.number, ConsentAnswer.REFUSE)
    await asking
    with pytest.raises(TooSoonError) as soon:
        await made.ask(AGENT, "k", LINES)
    assert soon.value.wait_s <= 0.1
