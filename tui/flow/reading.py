"""Messages and log lines read as steps; values that repeat are recorded only when they change."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from launcher.status import Severity
from robot.joints import HEAD_PAN, HEAD_TILT, REAR_LEFT_WHEEL, REAR_RIGHT_WHEEL
from robot.topics import (
    AI_COMMAND,
    BRAIN_STATE,
    DRIVE,
    DRIVE_SAFE,
    HEAD_STATE,
    LLM_RAW_JSON,
    MICROPHONE,
    SPEAKER,
    WHEEL_COMMANDS,
)
from text.i18n import localized
from text.plain import plain
from text.robot import robot
from tui.flow.chains import FlowStep, Lane, StepKind
from tui.outcome import words as outcome_words
from tui.outcome.model_usage import COMPOSER, brain_reports, usage_noted
from tui.panels.voice import LEVELS, heard

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from graph.data import Sample, Value
    from launcher.status import LogLine, NodeStatus
    from tui.outcome.model_usage import UsageFigures

TOPICS = robot().story

SPOKEN_LEVEL = 3
"""Of the eight levels of loudness: a quieter sound is not a voice (about -38 dB)."""
PASSED_ON_S = 0.05
"""A node that republishes continuously passes on a new command within this time."""
SAME_CLOCK_S = 1.0
"""A message with a longer transit time than this was stamped by another clock."""
STILL_RAD = math.radians(0.2)
LONGEST = 300
AGENT = "agent"
"""The `source` of lines about agents."""


def lane_of(node: str, roles: Iterable[str] = ()) -> Lane:
    """Return the lane of a node's log, by its roles, or by its name if none are known."""
    plays = roles or robot().named(node)
    if "brain" in plays or node == COMPOSER:
        return Lane.BRAIN
    return Lane.HEAD if "head" in plays else Lane.LOG


class FlowReader:
    """Remembers what is needed of each topic to tell news from repetition."""

    def __init__(self) -> None:
        self._before: dict[str, str] = {}
        self._looked: tuple[float, float] | None = None
        self._told_s: dict[str, float] = {}
        self._head_moves = False
        self._head_s = 0.0
        self._usages: dict[str, UsageFigures | None] = {}

    def messages(self, samples: Mapping[str, Iterable[Sample]], said_by: Mapping[str, str]) -> list[FlowStep]:
        """Read samples; `said_by` has the publishers of each topic."""
        came = [one for topic in TOPICS for one in samples.get(topic, ())]
        came.sort(key=_sent_s)
        return [step for one in came for step in self._read(one, said_by.get(one.topic, ""))]

    def _read(self, sample: Sample, said_by: str) -> Iterator[FlowStep]:
        topic, value, time_s = sample.topic, sample.value, _sent_s(sample)
        if topic in {MICROPHONE, SPEAKER}:
            text = _sound(value)
            if text is not None:
                lane = Lane.MIC if topic == MICROPHONE else Lane.SPEAKER
                yield FlowStep(time_s, lane, topic, said_by, text=text, begins=lane is Lane.MIC)
        elif topic in {AI_COMMAND, LLM_RAW_JSON}:
            lane = Lane.COMMAND if topic == AI_COMMAND else Lane.BRAIN
            text = plain(" ".join(str(value.get("data", ""))[:LONGEST].split()))
            yield FlowStep(time_s, lane, topic, said_by, text=text, begins=True)
        elif topic == BRAIN_STATE:
            yield from self._read_brain(sample, time_s)
        elif topic == HEAD_STATE:
            yield from self._read_head(value, time_s, said_by)
        else:
            yield from self._read_motion(topic, value, time_s, said_by)

    def _read_brain(self, sample: Sample, time_s: float) -> Iterator[FlowStep]:
        """A step for each answer: the same is reported again once a second."""
        for report in brain_reports(sample):
            # Whoever looks through the camera reports here, too, and leads to no commands.
            if lane_of(report.node) is not Lane.BRAIN:
                continue
            is_new = report.node in self._usages and report.usage != self._usages[report.node]
            self._usages[report.node] = report.usage
            if is_new and report.usage is not None:
                yield FlowStep(time_s, Lane.BRAIN, BRAIN_STATE, report.node, usage=report.usage)

    def _read_motion(self, topic: str, value: Mapping[str, Value], time_s: float, said_by: str) -> Iterator[FlowStep]:
        wheels = topic == WHEEL_COMMANDS
        figures = _wheels(value) if wheels else outcome_words.setpoint(value)
        # Values in 32 bits and their repetitions may differ slightly.
        figures = tuple(round(figure, 4) for figure in figures)
        # Compared as text, because nan is not equal to nan.
        changed = repr(figures) != self._before.get(topic)
        self._before[topic] = repr(figures)
        if topic != DRIVE and not changed and not self._passes_on(topic, time_s):
            return
        self._told_s[topic] = time_s
        lane, kind = (Lane.WHEELS, StepKind.WHEELS) if wheels else (Lane.DRIVE, StepKind.DRIVE)
        yield FlowStep(time_s, lane, topic, said_by, kind, figures=figures)

    def _passes_on(self, topic: str, time_s: float) -> bool:
        """Whether it was just given a command that it has not passed on yet."""
        givers = (DRIVE,) if topic == DRIVE_SAFE else (DRIVE, DRIVE_SAFE)
        given_s = max(self._told_s.get(giver, -math.inf) for giver in givers)
        told_s = self._told_s.get(topic, -math.inf)
        return time_s - given_s <= PASSED_ON_S and told_s < given_s

    def _read_head(self, value: Mapping[str, Value], time_s: float, said_by: str) -> Iterator[FlowStep]:
        """Two steps for one movement: where it begins, and where it has come to rest."""
        looks = outcome_words.joint(value, HEAD_PAN), outcome_words.joint(value, HEAD_TILT)
        before, self._looked = self._looked, looks
        if before is None:
            return
        still = all(map(_is_still, looks, before))
        if not still:
            self._head_s = time_s
        if still == self._head_moves:
            self._head_moves = not still
            kind = StepKind.HEAD_THERE if still else StepKind.HEAD_MOVES
            # It has been there since the last message with a new value.
            yield FlowStep(self._head_s, Lane.HEAD, HEAD_STATE, said_by, kind, figures=looks)


def _is_still(now_rad: float, before_rad: float) -> bool:
    """Whether a joint has not moved; unknown positions count as unmoved."""
    return abs(now_rad - before_rad) < STILL_RAD or (math.isnan(now_rad) and math.isnan(before_rad))


def log_steps(lines: Iterable[LogLine], nodes: Mapping[str, NodeStatus]) -> list[FlowStep]:
    """Read log lines of nodes; `nodes` are those of the session."""
    return [
        _agent_step(line)
        if line.source == AGENT
        else FlowStep(
            line.time_s,
            lane_of(line.node, nodes[line.node].roles if line.node in nodes else ()),
            plain(line.node, LONGEST),
            plain(line.node, LONGEST),
            text=plain(localized(line.text) if line.source == "deck" else line.text, LONGEST),
            usage=usage_noted(line.text) if line.source == "deck" else None,
        )
        for line in lines
        if line.source != "deck" or line.node == COMPOSER
    ]


def _agent_step(line: LogLine) -> FlowStep:
    """Read what an agent has called; what acts begins a chain, what only looks does not."""
    text = plain(localized(line.text), LONGEST)
    begins = line.severity.rank >= Severity.INFO.rank
    return FlowStep(line.time_s, Lane.AGENT, AGENT, AGENT, text=text, begins=begins)


def _sent_s(sample: Sample) -> float:
    """When it was sent; when it arrived, if the sender's clock is not this machine's."""
    arrived_s = sample.received_s - sample.age_s
    if sample.sent_s is not None and 0 <= arrived_s - sample.sent_s <= SAME_CLOCK_S:
        return sample.sent_s
    return arrived_s


def _sound(value: Mapping[str, Value]) -> str | None:
    """What was said as text, None if nothing was: a stream contains silence."""
    data = value.get("data", b"")
    sound = heard(data if isinstance(data, bytes) else b"")
    loudest = max((LEVELS.index(level) for level in sound.levels), default=SPOKEN_LEVEL)
    if loudest < SPOKEN_LEVEL:
        return None
    # Pieces of one sound get the same text, so that they are counted as repetitions.
    return "♪" if sound.is_sound else sound.words[:LONGEST]


def _wheels(value: Mapping[str, Any]) -> tuple[float, ...]:
    return (
        outcome_words.joint(value, REAR_LEFT_WHEEL, "velocity"),
        outcome_words.joint(value, REAR_RIGHT_WHEEL, "velocity"),
    )
