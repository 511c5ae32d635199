"""The questions of agents, and how a person answers them.

An answer that lets the robot move must not happen by accident. So it is given only where the
question has been on the screen in front for a moment: a key that was on its way when the question
appeared, or a second press, allows nothing.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from launcher.consent import Approval, ConsentAnswer
from launcher.errors import LauncherError
from text.i18n import _
from text.plain import plain

if TYPE_CHECKING:
    from textual.app import App

    from launcher.consent import Agents, Question
    from tui.session.feed import Feed

BANNER = "AgentBanner"
"""The widget that shows the question on each screen."""
READ_S = 1.0
"""For as long a question has to be seen before it can be answered with yes."""
TOLD_S = 20.0


class AgentControl:
    """Answers the oldest question."""

    def __init__(self, app: App[Any], feed: Feed) -> None:
        self._app = app
        self._feed = feed
        self._seen: tuple[Question | None, float] = (None, 0.0)
        """The question that is on the screen in front, and since when (monotonic clock)."""
        self._warned: set[tuple[str, str]] = set()
        """Sessions and names of agents of which it was said that they ask nobody."""

    @property
    def state(self) -> Agents:
        return self._feed.agents

    @property
    def question(self) -> Question | None:
        return next(iter(self.state.questions), None)

    @property
    def allowed(self) -> bool:
        """Whether an agent may drive without a question, until it is ended."""
        return any(agent.allowed_until_s for agent in self.state.connected)

    def shown(self, question: Question | None) -> None:
        """Note that this question is on the screen in front, or none."""
        if question != self._seen[0]:
            self._seen = question, time.monotonic()

    @property
    def was_read(self) -> bool:
        """Whether the question has been in front long enough to be answered with yes."""
        seen, since_s = self._seen
        if seen is None or seen != self.question or time.monotonic() - since_s < READ_S:
            return False
        # Not while a dialog or the help covers it.
        return any(banner.display for banner in self._app.screen.query(BANNER))

    def answer(self, answer: ConsentAnswer) -> None:
        """Answer it; an answer that allows only once it was read."""
        question = self.question
        if question is not None and (answer is ConsentAnswer.REFUSE or self.was_read):
            self._app.run_worker(self._answer(question.number, answer), group="agents")

    def refuse(self) -> None:
        """Refuse what is asked, and end what was allowed for a time."""
        self.answer(ConsentAnswer.REFUSE)
        if self.allowed:
            self._app.run_worker(self._end(), group="agents")

    def stopped(self) -> None:
        """End everything: the emergency stop is engaged."""
        if self.state.questions or self.allowed:
            self._app.run_worker(self._end(), group="agents")

    def see(self) -> None:
        """Say once, loudly, that an agent drives without asking."""
        session = self._feed.session
        for agent in self.state.connected if session is not None else ():
            key = (session.run_id if session is not None else "", agent.name)
            if agent.approval is Approval.ALWAYS and key not in self._warned:
                self._warned.add(key)
                words = _("Agent “{name}” drives without asking: --approve always")
                told = words.format(name=plain(agent.name))
                self._app.notify(told, severity="warning", timeout=TOLD_S, markup=False)

    async def _answer(self, number: int, answer: ConsentAnswer) -> None:
        link = self._feed.link
        try:
            if link is not None and not await link.answer(number, answer):
                self._app.notify(_("The agent does not ask any more."), markup=False)
        except LauncherError:
            # The session has just ended, and with it the question.
            return

    async def _end(self) -> None:
        link = self._feed.link
        try:
            if link is not None:
                await link.end_consent()
        except LauncherError:
            return
