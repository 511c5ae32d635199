"""Answering the agents, from any screen.

The keys are function keys with Shift: text that is typed or pasted holds none, so that nobody who
writes in a field allows anything by accident. Refusing needs no care.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from launcher.consent import ConsentAnswer
from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.frame.host import Host


class AgentAction(Action["Host"]):
    """An answer to the question that is on the screen."""

    priority = True

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only while an agent asks."""
        return target.feed.link is not None and target.agents.question is not None


class AllowAgent(AgentAction):
    """Let the agent do it."""

    id = "agents.allow"
    key = "shift+f4"
    title = N_("Allow once")
    tooltip = N_("Let the agent carry out what it asks for, once.")

    @classmethod
    async def run(cls, target: Host) -> None:
        target.agents.answer(ConsentAnswer.ONCE)


class AllowAgentForATime(AgentAction):
    """Let the agent do it, and more."""

    id = "agents.allow_for_a_time"
    key = "shift+f5"
    title = N_("Allow for 5 min")
    tooltip = N_("Let the agent drive for five minutes without asking, within its limits.")

    @classmethod
    async def run(cls, target: Host) -> None:
        target.agents.answer(ConsentAnswer.FOR_A_TIME)


class RefuseAgent(AgentAction):
    """Do not let the agent do it, or do any more."""

    id = "agents.refuse"
    key = "shift+f9"
    title = N_("Refuse")
    tooltip = N_("Refuse what the agent asks for, and end what it was allowed for a time.")

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only while an agent asks, or may drive without a question."""
        asked = target.agents.question is not None or target.agents.allowed
        return target.feed.link is not None and asked

    @classmethod
    async def run(cls, target: Host) -> None:
        target.agents.refuse()


AGENT_ACTIONS = (AllowAgent, AllowAgentForATime, RefuseAgent)
