"""What the banner says of agents."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from launcher.consent import Approval
from text.i18n import _, localized
from text.plain import plain

if TYPE_CHECKING:
    from launcher.consent import Agent, Agents, Question

MOST_LINES = 3
"""Lines of a question that are shown: the robot's way, the gate, the agent's words."""
LONGEST = 300


def question_head(question: Question, more: int) -> str:
    """Return the headline of a question, with how many `more` wait behind it."""
    head = _("Agent “{name}” asks to move the robot").format(name=plain(question.agent))
    return f"{head} (+{more})" if more else head


def question_lines(question: Question) -> list[str]:
    """Say what it would do, what the gate would say, and why."""
    return [plain(localized(line), LONGEST) for line in question.lines[:MOST_LINES]]


def standing_words(agents: Agents) -> str:
    """Say which agents drive without asking; empty if none does."""
    return " · ".join(filter(None, map(_stands, agents.connected)))


def _stands(agent: Agent) -> str:
    name = plain(agent.name)
    if agent.approval is Approval.ALWAYS:
        return _("⚠ agent “{name}” drives without asking").format(name=name)
    if agent.allowed_until_s:
        until = time.strftime("%H:%M:%S", time.localtime(agent.allowed_until_s))
        return _("agent “{name}” may drive until {time}").format(name=name, time=until)
    return ""
