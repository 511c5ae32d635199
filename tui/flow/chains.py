"""What happened when somebody spoke: steps across nodes, gathered into chains. Plain data.

A step is a message or a log line. The time of a message is the middleware's: when its publisher
handed it over, by the publisher's clock; where that is not told, or is by the clock of another
machine, when it arrived at Deck's own reader. A log line has the stamp that the node itself wrote
into it. On one machine all are of one clock, so delays and their order are good to a few tenths of
a millisecond; a log line is written a moment before or after what it tells. By arrivals they are
good to a millisecond on an idle machine and to some ten on a busy one. A log line without a stamp
of its own has the time at which it was read, which may be tens of milliseconds late. Service calls
are not visible to anybody but the two who talk: of the head's service the log and /head_state are
shown.
"""

from __future__ import annotations

from bisect import insort
from dataclasses import dataclass, field, replace
from enum import Enum

MOST_STEPS = 80
"""Of one chain; what comes after is counted only."""
UTTERANCE_S = 1.0
"""A longer silence of the microphone ends what is being said."""
BURST_S = 0.5
"""The same source again within this time does not begin anew."""
THINKS_S = 20.0
"""How long a brain may think before its first command."""
FOLLOWS_S = 5.0
"""What comes within this time after the beginning belongs to it."""
PAUSE_S = 2.0
"""So does what comes later without a longer pause than this,"""
LONGEST_S = 30.0
"""up to here."""
EARLY_S = 0.02
"""How much before its cause something may seem to have happened."""


class Lane(str, Enum):
    """Who takes part."""

    MIC = "mic"
    BRAIN = "brain"
    COMMAND = "command"
    HEAD = "head"
    DRIVE = "drive"
    WHEELS = "wheels"
    SPEAKER = "speaker"
    LOG = "log"
    """What other nodes write into their logs."""


class StepKind(str, Enum):
    """What a step's content is."""

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
    """One thing that happened."""

    time_s: float
    """Unix time."""
    lane: Lane = field(compare=False)
    source: str = field(compare=False)
    """The topic, or the node that wrote the line."""
    said_by: str = field(compare=False, default="")
    """The node that published it; several, comma-separated, where that cannot be told apart."""
    kind: StepKind = field(compare=False, default=StepKind.TEXT)
    text: str = field(compare=False, default="")
    figures: tuple[float, ...] = field(compare=False, default=())
    times: int = field(compare=False, default=1)
    """How many times in a row the same was said."""
    begins: bool = field(compare=False, default=False)
    """Whether it may be the first of a chain."""

    def repeats(self, other: FlowStep) -> bool:
        """Whether this says the same again."""
        return self._content() == other._content()

    def _content(self) -> tuple[object, ...]:
        # By their names: nan is not nan.
        return self.source, self.kind, self.text, repr(self.figures)


class Chain:
    """One beginning, and what followed."""

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

    def delay_s(self, step: FlowStep) -> float:
        """Seconds since the beginning; what seems to have come a hair before it counts as 0."""
        return max(0.0, step.time_s - self.start_s)

    def takes(self, step: FlowStep) -> bool:
        """Whether a step belongs to this chain and not to a new one."""
        age_s = step.time_s - self.start_s
        if step.begins:
            return self._takes_beginning(step, age_s)
        if age_s < -EARLY_S:
            return False
        return age_s <= FOLLOWS_S or (
            step.time_s - self._active_s <= PAUSE_S and age_s <= LONGEST_S
        )

    def _takes_beginning(self, step: FlowStep, age_s: float) -> bool:
        heard_s = self._heard_s.get(step.source)
        if step.lane is Lane.MIC:
            return heard_s is not None and step.time_s - heard_s <= UTTERANCE_S
        if heard_s is not None:
            return step.time_s - heard_s <= BURST_S
        # A brain turns a voice into JSON and words, never the other way round.
        later = _ORDER[step.lane] > _ORDER[self.first.lane]
        return later and age_s <= THINKS_S

    def add(self, step: FlowStep) -> None:
        """Take a step in; the same again is counted, not repeated."""
        self._heard_s[step.source] = max(step.time_s, self._heard_s.get(step.source, step.time_s))
        if step.lane is not Lane.LOG:
            self._active_s = max(self._active_s, step.time_s)
        at = next(
            (at for at in reversed(range(len(self.steps))) if self.steps[at].source == step.source),
            None,
        )
        if at is not None and step.repeats(self.steps[at]):
            said = self.steps[at]
            self.steps[at] = replace(said, times=said.times + 1)
        elif len(self.steps) >= MOST_STEPS:
            self.more += 1
        else:
            insort(self.steps, step)


_ORDER = {Lane.MIC: 0, Lane.BRAIN: 1, Lane.COMMAND: 2}
