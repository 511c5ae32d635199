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
from launcher.status import Severity
from text.sentences import Words, say

MAX_AGENTS = 16
MAX_QUESTIONS = 4
"""Most questions at once; a person cannot oversee more."""


REFUSED_FOR_S = 5.0
"""How long nobody asks after a refusal; twice as long after each further one."""
LONGEST_REFUSED_FOR_S = 320.0


class TooManyError(Exception):
    """There are too many agents, or too many questions."""


class TooSoonError(Exception):
    """A person has just refused; `.wait_s` says for how long they are left alone."""

    def __init__(self, wait_s: float) -> None:
        super().__init__(wait_s)
        self.wait_s = wait_s


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
    """Knows agents, questions and allowances; `client` is the connection that speaks."""

    def __init__(
        self,
        changed: Callable[[], None],
        told: Callable[[Severity, Words], None],
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

    def attend(self, client: Hashable) -> None:
        """Note that a person can answer at this screen."""
        self._screens.add(client)

    def attends(self, client: Hashable) -> bool:
        return client in self._screens

    def knows(self, client: Hashable, key: str | None = None) -> bool:
        """Whether an agent has joined from there: that of this key, or any."""
        return any(who is client and key in (None, name) for who, name in self._known)

    def answer(self, number: int, answer: ConsentAnswer) -> bool:
        """Answer a question; return False if it is no longer asked."""
        pending = self._pending.get(number)
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

    def end_all(self) -> None:
        """End every question and every allowance: an emergency stop, or a person's wish."""
        allowed = [known for known in self._known.values() if known.allowed_until_s]
        for known in allowed:
            self._disallow(known)
        self._end_questions(lambda _pending: True, ConsentVerdict.ENDED)
        if allowed:
            self._told(Severity.INFO, say("no agent drives without a question any more"))
            self._changed()

    # Agents.

    def join(self, client: Hashable, key: str, name: str, approval: Approval) -> None:
        """Note that an agent is connected; `key` distinguishes those of one connection.

        Raises:
            TooManyError: if there are too many.
        """
        if (client, key) in self._known:
            return
        if len(self._known) >= MAX_AGENTS and not self._forget_one(client):
            raise TooManyError
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

    async def ask(self, client: Hashable, key: str, lines: tuple[str, ...], *, anew: bool = False) -> ConsentVerdict:
        """Ask a person, unless they have allowed it for a time; `anew`: even then.

        Raises:
            TooManyError: if too much is asked at once.
            TooSoonError: if a person has refused a moment ago.
        """
        known = self._known[client, key]
        if known.allowed_until_s > time.monotonic() and not anew:
            return ConsentVerdict.ALLOWED_BEFORE
        if not self._screens:
            return ConsentVerdict.NO_SCREEN
        wait_s = self._not_before_s - time.monotonic()
        if wait_s > 0:
            raise TooSoonError(wait_s)
        if len(self._pending) >= MAX_QUESTIONS:
            raise TooManyError
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

    def withdraw(self, client: Hashable, key: str | None = None) -> None:
        """End the questions of a connection, or of one of its agents."""
        self._end_questions(lambda one: one.client is client and key in (None, one.key), ConsentVerdict.ENDED)

    def leave(self, client: Hashable) -> None:
        """Forget a connection that has been closed."""
        if client in self._screens:
            self._screens.discard(client)
            if not self._screens:
                self._end_questions(lambda _pending: True, ConsentVerdict.SCREEN_GONE)
                self.end_all()
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
