"""Agents, what they ask for, and what a person answers: plain data, the same at both ends.

An agent is a program that speaks to `deck mcp`. It moves the robot only with the consent of the
person at the screen, which passes through the supervisor, see `launcher.control.consent`.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from launcher.parts import Part, RosName, key
from launcher.wire import Sentence

AUDIT_FILE = "agents.jsonl"
"""In the log folder of a run: what agents have called, one JSON object a line."""
ALLOWED_FOR_S = 300.0
"""How long an allowance for a time lasts."""
ASKED_FOR_S = 30.0
"""How long a person is asked; no answer is a refusal."""


@dataclass(frozen=True)
class AgentRules(Part):
    """What agents that speak to `deck mcp` may do, whatever a person allows them."""

    max_speed_m_s: float = key(0.2, "Fastest speed of a proposal, m/s.", ge=0, le=10)
    max_distance_m: float = key(1.0, "Longest way of one proposal, m.", ge=0, le=100)
    max_total_m: float = key(
        5.0, "Longest way within five minutes of all that nobody was asked about, m.", ge=0, le=1000
    )
    publish: tuple[RosName, ...] = key(
        (), "Topics that agents may publish on; one that moves the robot stays refused.", strict=False
    )
    call: tuple[RosName, ...] = key((), "Services that agents may call.", strict=False)


DEFAULT_RULES = AgentRules()
"""Where a profile says nothing about agents."""


class Approval(str, Enum):
    """Who decides whether an agent drives."""

    NEVER = "never"
    """Nobody: it does not."""
    ASK = "ask"
    """The person at the screen."""
    ALWAYS = "always"
    """Whoever has started `deck mcp`, for all that is to come."""


class ConsentAnswer(str, Enum):
    """What a person answers."""

    ONCE = "once"
    FOR_A_TIME = "time"
    """This, and what the same agent asks for within `ALLOWED_FOR_S`."""
    REFUSE = "refuse"


class ConsentVerdict(str, Enum):
    """What comes of a question."""

    ALLOWED = "allowed"
    ALLOWED_BEFORE = "allowed before"
    """By an allowance for a time, without a question."""
    REFUSED = "refused"
    NO_SCREEN = "no screen"
    """There is nobody to ask."""
    SCREEN_GONE = "screen gone"
    LATE = "late"
    """Nobody has answered in time."""
    ENDED = "ended"
    """An emergency stop, or the agent itself, has ended the question."""

    @property
    def allows(self) -> bool:
        """Whether the agent may drive."""
        return self in (ConsentVerdict.ALLOWED, ConsentVerdict.ALLOWED_BEFORE)


@dataclass(frozen=True)
class Question:
    """What an agent asks a person for."""

    number: int
    agent: str
    """Its name, as it gives it itself."""
    lines: tuple[Sentence, ...]
    """What it would do, in sentences: the most important one first."""
    until_s: float
    """Unix time at which it counts as refused."""


@dataclass(frozen=True)
class Agent:
    """An agent that is connected."""

    name: str
    approval: Approval
    allowed_until_s: float = 0.0
    """Unix time until which it may drive without a question; 0: it may not."""


@dataclass(frozen=True)
class Agents:
    """All agents of a session, and what they ask for, oldest first."""

    connected: tuple[Agent, ...] = ()
    questions: tuple[Question, ...] = ()
