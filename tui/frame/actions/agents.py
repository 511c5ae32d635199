"""Answering the agents, from any screen.

The keys are function keys with Shift: text that is typed or pasted holds none, so that nobody who
writes in a field allows anything by accident. Refusing needs no care.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from launcher.consent import ConsentAnswer
from text.i18n import N_
from tui.actions.action import Announce, actions_of

if TYPE_CHECKING:
    from tui.frame.host import Host

action: Announce[Host] = Announce()


def _is_asked(host: Host) -> bool | None:
    """Only while an agent asks."""
    return host.feed.link is not None and host.agents.question is not None


@action(
    "agents.allow",
    "shift+f4",
    N_("Allow once"),
    N_("Let the agent carry out what it asks for, once."),
    priority=True,
    when=_is_asked,
)
def allow_agent(host: Host) -> None:
    host.agents.answer(ConsentAnswer.ONCE)


@action(
    "agents.allow_for_a_time",
    "shift+f5",
    N_("Allow for 5 min"),
    N_("Let the agent drive for five minutes without asking, within its limits."),
    priority=True,
    when=_is_asked,
)
def allow_agent_for_a_time(host: Host) -> None:
    host.agents.answer(ConsentAnswer.FOR_A_TIME)


def _may_refuse(host: Host) -> bool | None:
    """Only while an agent asks, or may drive without a question."""
    asked = host.agents.question is not None or host.agents.allowed
    return host.feed.link is not None and asked


@action(
    "agents.refuse",
    "shift+f9",
    N_("Refuse"),
    N_("Refuse what the agent asks for, and end what it was allowed for a time."),
    priority=True,
    when=_may_refuse,
)
def refuse_agent(host: Host) -> None:
    host.agents.refuse()


AGENT_ACTIONS = actions_of(__name__)
