"""Asking the person at the screen whether an agent may drive, on behalf of `deck mcp`.

Whoever asks and whoever answers are clients of the control socket. A question ends by the answer of
a screen, after `ASKED_FOR_S`, with the last screen, with the connection that asks, or by an
emergency stop; in every case but one the agent does not drive.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import Annotated

from launcher.consent import (
    ALLOWED_FOR_S,
    ASKED_FOR_S,
    Agent,
    Agents,
    Approval,
    ConsentAnswer,
    ConsentVerdict,
    Question,
)
from launcher.control.requests import BadRequestError, request
from launcher.status import Severity
from launcher.wire import encode
from text.packing import unpack_text
from text.plain import plain
from text.sentences import say

MAX_AGENTS = 16
MAX_QUESTIONS = 4
"""Most questions at once; a person cannot oversee more."""
REFUSED_FOR_S = 5.0
"""How long nobody asks after a refusal; twice as long after each further one."""
LONGEST_REFUSED_FOR_S = 320.0
MAX_QUESTION_LINES = 6
MAX_SENTENCE_BYTES = 4000
"""Most bytes of a sentence of a question, or of a line for the log, packed."""
LONGEST_NAME = 80


class TooSoonError(BadRequestError):
    """A person has just refused; `.wait_s` says for how long they are left alone."""

    def __init__(self, wait_s: float) -> None:
        seconds = max(wait_s, 1.0)
        words = say("the person has just refused: nothing is asked for another {seconds:.0f} s", seconds=seconds)
        super().__init__(words, "too_soon")
        self.wait_s = wait_s


def _too_many() -> BadRequestError:
    return BadRequestError(say("too many agents ask at once"), "too_many")


def _bounded(packed: object) -> object:
    if not packed or len(encode({"": packed})) > MAX_SENTENCE_BYTES:
        raise ValueError(f"expected a sentence of at most {MAX_SENTENCE_BYTES} bytes")
    return packed


def _short(name: object) -> object:
    if isinstance(name, str) and len(name) > LONGEST_NAME:
        raise ValueError(f"expected at most {LONGEST_NAME} characters")
    return name


def _few(lines: object) -> object:
    if isinstance(lines, list) and not 1 <= len(lines) <= MAX_QUESTION_LINES:
        raise ValueError(f"expected 1 to {MAX_QUESTION_LINES} lines")
    return lines


Short = Annotated[str, _short]
"""The name of an agent, or what distinguishes those of one connection."""
BoundedSentence = Annotated[str, _bounded, unpack_text]
Lines = Annotated[tuple[BoundedSentence, ...], _few]


@dataclass
class _Known:
    """An agent, and for how long it needs not ask (monotonic clock)."""

    agent: Agent
    allowed_until_s: float = 0.0


@dataclass
class _Pending:
    """A question and who waits for its answer."""

    question: Question
    client: Hashable
    key: str
    answered: asyncio.Future[ConsentVerdict] = field(
        default_factory=lambda: asyncio.get_running_loop().create_future()
    )


class ConsentDesk:
    """Knows agents, questions and allowances; serves their requests. `client` is the connection that speaks."""

    def __init__(
        self,
        changed: Callable[[], None],
        told: Callable[[Severity, str], None],
        asked_for_s: float = ASKED_FOR_S,
        allowed_for_s: float = ALLOWED_FOR_S,
        refused_for_s: float = REFUSED_FOR_S,
    ) -> None:
        """`changed` is called when `state` has changed; `told` gets what belongs in the log."""
        self._asked_for_s, self._allowed_for_s = asked_for_s, allowed_for_s
        self._changed = changed
        self._told = told
        self._screens: set[Hashable] = set()
        self._known: dict[tuple[Hashable, str], _Known] = {}
        self._pending: dict[int, _Pending] = {}
        self._last = 0
        self._refused_for_s = refused_for_s
        self._refusals = 0
        """In a row, of whomever: an agent that leaves and comes back has another name."""
        self._not_before_s = 0.0

    @property
    def state(self) -> Agents:
        return Agents(
            tuple(known.agent for known in self._known.values()),
            tuple(pending.question for pending in self._pending.values()),
        )

    # Screens.

    @request
    def attend(self, client: Hashable) -> None:
        """Note that a person can answer at this screen."""
        if any(who is client for who, _key in self._known):
            raise BadRequestError(say("an agent cannot answer its own questions"))
        self._screens.add(client)

    @request
    def answer(self, client: Hashable, question: int, answer: ConsentAnswer) -> bool:
        """Answer a question; return False if it is no longer asked."""
        if client not in self._screens:
            raise BadRequestError(say("only a screen that attends to agents may answer them"))
        pending = self._pending.get(question)
        if pending is None or pending.answered.done():
            return False
        if answer is ConsentAnswer.REFUSE:
            self._refuse()
            pending.answered.set_result(ConsentVerdict.REFUSED)
            return True
        self._refusals = 0
        if answer is ConsentAnswer.FOR_A_TIME:
            self._allow(pending)
        pending.answered.set_result(ConsentVerdict.ALLOWED)
        return True

    @request
    def end_consent(self) -> None:
        """End every question and every allowance: an emergency stop, or a person's wish."""
        allowed = [known for known in self._known.values() if known.allowed_until_s]
        for known in allowed:
            self._disallow(known)
        self._end_questions(lambda _pending: True, ConsentVerdict.ENDED)
        if allowed:
            self._told(Severity.INFO, say("no agent drives without a question any more"))
            self._changed()

    # Agents.

    @request
    def join(self, client: Hashable, key: Short, name: Short, approval: Approval) -> None:
        """Note that an agent is connected; `key` distinguishes those of one connection."""
        if client in self._screens:
            raise BadRequestError(say("an agent cannot answer its own questions"))
        if (client, key) in self._known:
            return
        if len(self._known) >= MAX_AGENTS and not self._forget_one(client):
            raise _too_many()
        name = plain(name)
        self._known[client, key] = _Known(Agent(name, approval))
        self._told(Severity.DEBUG, say("agent “{name}” is connected", name=name))
        if approval is Approval.ALWAYS:
            words = say("agent “{name}” drives without asking: --approve always", name=name)
            self._told(Severity.WARN, words)
        self._changed()

    def _forget_one(self, client: Hashable) -> bool:
        """Forget the agent of a connection that joined first, if it asks and may do nothing now."""
        asking = {(pending.client, pending.key) for pending in self._pending.values()}
        for key, known in self._known.items():
            if key[0] is client and key not in asking and not known.allowed_until_s:
                del self._known[key]
                return True
        return False

    @request
    async def ask(self, client: Hashable, key: Short, lines: Lines, anew: bool = False) -> ConsentVerdict:
        """Ask a person, unless they have allowed it for a time; `anew`: even then.

        Raises:
            TooSoonError: if a person has refused a moment ago.
        """
        known = self._known.get((client, key))
        if known is None:
            raise BadRequestError(say("an agent has to join before it asks"))
        if known.allowed_until_s > time.monotonic() and not anew:
            return ConsentVerdict.ALLOWED_BEFORE
        if not self._screens:
            return ConsentVerdict.NO_SCREEN
        wait_s = self._not_before_s - time.monotonic()
        if wait_s > 0:
            raise TooSoonError(wait_s)
        if len(self._pending) >= MAX_QUESTIONS:
            raise _too_many()
        self._last += 1
        question = Question(self._last, known.agent.name, lines, time.time() + self._asked_for_s)
        pending = self._pending[question.number] = _Pending(question, client, key)
        self._changed()
        try:
            return await asyncio.wait_for(pending.answered, self._asked_for_s)
        except asyncio.TimeoutError:
            return ConsentVerdict.LATE
        finally:
            self._pending.pop(question.number, None)
            self._changed()

    @request
    def tell(self, severity: Severity, words: BoundedSentence) -> None:
        """Add a line about an agent to the log."""
        self._told(severity, words)

    @request
    def withdraw(self, client: Hashable, key: Short | None = None) -> None:
        """End the questions of a connection, or of one of its agents."""
        self._end_questions(lambda one: one.client is client and key in (None, one.key), ConsentVerdict.ENDED)

    def leave(self, client: Hashable) -> None:
        """Forget a connection that has been closed."""
        if client in self._screens:
            self._screens.discard(client)
            if not self._screens:
                self._end_questions(lambda _pending: True, ConsentVerdict.SCREEN_GONE)
                self.end_consent()
        self.withdraw(client)
        mine = [key for key in self._known if key[0] is client]
        for key in mine:
            name = self._known.pop(key).agent.name
            self._told(Severity.DEBUG, say("agent “{name}” has left", name=name))
        if mine:
            self._changed()

    def _refuse(self) -> None:
        wait_s = min(self._refused_for_s * 2**self._refusals, LONGEST_REFUSED_FOR_S)
        if wait_s < LONGEST_REFUSED_FOR_S:
            self._refusals += 1
        self._not_before_s = time.monotonic() + wait_s

    def _allow(self, pending: _Pending) -> None:
        known = self._known.get((pending.client, pending.key))
        if known is None:
            return
        until_s = time.monotonic() + self._allowed_for_s
        known.allowed_until_s = until_s
        known.agent = Agent(known.agent.name, known.agent.approval, time.time() + self._allowed_for_s)
        words = say(
            "agent “{name}” may drive without a question for {minutes:g} min",
            name=known.agent.name,
            minutes=self._allowed_for_s / 60,
        )
        self._told(Severity.WARN, words)
        asyncio.get_running_loop().call_later(self._allowed_for_s, self._run_out, known, until_s)

    def _run_out(self, known: _Known, until_s: float) -> None:
        if known.allowed_until_s == until_s:
            self._disallow(known)
            self._changed()

    def _disallow(self, known: _Known) -> None:
        known.allowed_until_s = 0.0
        known.agent = Agent(known.agent.name, known.agent.approval)

    def _end_questions(self, which: Callable[[_Pending], bool], verdict: ConsentVerdict) -> None:
        for pending in self._pending.values():
            if which(pending) and not pending.answered.done():
                pending.answered.set_result(verdict)
