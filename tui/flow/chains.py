"""What happened after an utterance: steps across nodes, sorted into chains. Plain data.

A step is a message or a log line. The time of a message is the middleware's source timestamp: when
its publisher sent it, by the publisher's clock. Where that is unknown, or comes from the clock of
another machine, it is the time of arrival at Deck's own reader. A log line has the time stamp that
the node itself wrote. On one machine all of these use one clock, so delays and their order are
accurate to a few tenths of a millisecond; a log line is written a moment before or after the event
it describes. Arrival times are accurate to a millisecond on an idle machine and to about ten on a
busy one. A log line without a time stamp of its own has the time at which it was read, which may be
tens of milliseconds late. Service calls are visible only to the client and the server: for the
head's service, the log and /head_state are shown.
"""

from __future__ import annotations

import math
from bisect import insort
from collections import deque
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from tui.outcome.model_usage import UsageFigures

MOST_STEPS = 80
"""Steps of one chain; later ones are only counted."""
UTTERANCE_S = 1.0
"""A longer silence of the microphone ends what is being said."""
BURST_S = 0.5
"""Further messages from the same source within this time do not start a new chain."""
THINKS_S = 20.0
"""How long a brain may think before its first command."""
FOLLOWS_S = 5.0
"""Anything within this time after the beginning belongs to the chain."""
PAUSE_S = 2.0
"""So does anything later without a gap longer than this,"""
LONGEST_S = 30.0
"""up to this time."""
EARLY_S = 0.02
"""How much earlier than its cause an effect may appear to be."""


class Lane(str, Enum):
    """The lanes: who takes part."""

    MIC = "mic"
    AGENT = "agent"
    """What agents that speak to `deck mcp` do."""
    BRAIN = "brain"
    COMMAND = "command"
    HEAD = "head"
    DRIVE = "drive"
    WHEELS = "wheels"
    SPEAKER = "speaker"
    LOG = "log"
    """Log lines of other nodes."""


class StepKind(str, Enum):
    """How the content of a step is to be read."""

    TEXT = "text"
    DRIVE = "drive"
    """Figures: m/s and rad."""
    WHEELS = "wheels"
    """Figures: rad/s left and right."""
    HEAD_MOVES = "head moves"
    """Figures: pan and tilt, rad."""
    HEAD_THERE = "head there"


@dataclass(frozen=True, order=True)
class FlowStep:
    """An event on a lane of the timeline; steps are ordered by time alone."""

    time_s: float
    """Unix time."""
    lane: Lane = field(compare=False)
    source: str = field(compare=False)
    """The topic, or the node that wrote the line."""
    said_by: str = field(compare=False, default="")
    """The node that published it; several, comma-separated, if it is not known which."""
    kind: StepKind = field(compare=False, default=StepKind.TEXT)
    text: str = field(compare=False, default="")
    figures: tuple[float, ...] = field(compare=False, default=())
    times: int = field(compare=False, default=1)
    """How many times in a row the same content came."""
    begins: bool = field(compare=False, default=False)
    """Whether it may start a chain."""
    usage: UsageFigures | None = field(compare=False, default=None)
    """What a model's answer took, if the step tells of one."""

    @property
    def content(self) -> tuple[object, ...]:
        """What two steps that repeat each other have in common."""
        # Compared as text, because nan is not equal to nan.
        return self.source, self.kind, self.text, repr(self.figures), self.usage


class Chain:
    """The first step of a chain, and what followed."""

    def __init__(self, first: FlowStep) -> None:
        self.first = first
        self.steps: list[FlowStep] = [first]
        """In order of time."""
        self.more = 0
        """Steps beyond `MOST_STEPS`."""
        self._heard_s = {first.source: first.time_s}
        self._active_s = first.time_s

    @property
    def start_s(self) -> float:
        """Unix time of the beginning."""
        return self.first.time_s

    @property
    def usage(self) -> UsageFigures | None:
        """What the last answer of a model took, None if none has taken part."""
        return next((step.usage for step in reversed(self.steps) if step.usage), None)

    def delay_s(self, step: FlowStep) -> float:
        """Seconds since the beginning; 0 for what appears to have come slightly before it."""
        return max(0.0, step.time_s - self.start_s)

    def takes(self, step: FlowStep) -> bool:
        """Whether a step belongs to this chain rather than to a new one."""
        age_s = step.time_s - self.start_s
        if not step.begins:
            lasts = step.time_s - self._active_s <= PAUSE_S and age_s <= LONGEST_S
            return age_s >= -EARLY_S and (age_s <= FOLLOWS_S or lasts)
        heard_s = self._heard_s.get(step.source)
        if step.lane is Lane.AGENT:
            return False
        if step.lane is Lane.MIC:
            return heard_s is not None and step.time_s - heard_s <= UTTERANCE_S
        if heard_s is not None:
            return step.time_s - heard_s <= BURST_S
        # A brain turns a voice into JSON and words, never the other way round.
        later = _ORDER[step.lane] > _ORDER[self.first.lane]
        return later and age_s <= THINKS_S

    def add(self, step: FlowStep) -> None:
        """Add a step; a repetition is only counted."""
        self._heard_s[step.source] = max(step.time_s, self._heard_s.get(step.source, step.time_s))
        if step.lane is not Lane.LOG:
            self._active_s = max(self._active_s, step.time_s)
        at = next((at for at in reversed(range(len(self.steps))) if self.steps[at].source == step.source), None)
        if at is not None and step.content == self.steps[at].content:
            self.steps[at] = replace(self.steps[at], times=self.steps[at].times + 1)
        elif len(self.steps) >= MOST_STEPS:
            self.more += 1
        else:
            insort(self.steps, step)


_ORDER = {Lane.MIC: 0, Lane.AGENT: 0, Lane.BRAIN: 1, Lane.COMMAND: 2}

MOST_CHAINS = 50
MOST_LOOSE = 400
"""Steps without a chain yet: a log line may arrive before the message that caused it."""


class FlowBook:
    """Chains of steps that follow one cause, made from messages and log lines in whatever order they come."""

    def __init__(self) -> None:
        self.chains: list[Chain] = []
        """In the order in which they began."""
        self._loose: deque[FlowStep] = deque(maxlen=MOST_LOOSE)

    def clear(self) -> None:
        self.chains.clear()
        self._loose.clear()

    def add(self, steps: Iterable[FlowStep]) -> bool:
        """Add steps; return whether any chain has changed."""
        placed = [self._place(step) for step in sorted(steps)]
        return any(placed)

    def _place(self, step: FlowStep) -> bool:
        chain = self._at(step.time_s)
        if chain is not None and chain.takes(step):
            chain.add(step)
            return True
        if step.begins:
            self._begin(step)
            return True
        self._loose.append(step)
        return False

    def _at(self, time_s: float) -> Chain | None:
        begun = (one for one in reversed(self.chains) if one.start_s <= time_s + EARLY_S)
        return next(begun, None)

    def _begin(self, first: FlowStep) -> None:
        # Chains are identified by their start times.
        while any(chain.start_s == first.time_s for chain in self.chains):
            first = replace(first, time_s=math.nextafter(first.time_s, math.inf))
        chain = Chain(first)
        insort(self.chains, chain, key=lambda one: one.start_s)
        del self.chains[:-MOST_CHAINS]
        waiting = sorted(self._loose)
        self._loose.clear()
        for step in waiting:
            if self._at(step.time_s) is chain and chain.takes(step):
                chain.add(step)
            else:
                self._loose.append(step)
