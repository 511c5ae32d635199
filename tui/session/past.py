"""Messages since the session began, for screens that show the past and are opened later."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from robot.topics import (
    AI_COMMAND,
    BRAIN_STATE,
    DRIVE,
    DRIVE_SAFE,
    HEAD_STATE,
    LLM_RAW_JSON,
    MICROPHONE,
    SONAR_FRONT,
    SONAR_REAR,
    SPEAKER,
    WHEEL_COMMANDS,
)

if TYPE_CHECKING:
    from graph.data import GraphUpdate, Sample, Value

FLOW_TOPICS = (
    MICROPHONE,
    BRAIN_STATE,
    LLM_RAW_JSON,
    AI_COMMAND,
    DRIVE,
    DRIVE_SAFE,
    WHEEL_COMMANDS,
    HEAD_STATE,
    SPEAKER,
)
"""Causes before effects, which decides the order of messages with the same time."""
SONARS = (SONAR_FRONT, SONAR_REAR)
KEPT = 240
"""Messages of a topic, as many as a trend shows."""
KEPT_BYTES = 2_000_000
"""Of a topic: sound is long."""


class Past:
    """The newest messages of some topics; of commands that are repeated the first two."""

    def __init__(self) -> None:
        self._kept: dict[str, deque[Sample]] = {}
        self._bytes: dict[str, int] = {}

    def clear(self) -> None:
        """Forget all, for another session."""
        self._kept.clear()
        self._bytes.clear()

    def take(self, update: GraphUpdate) -> None:
        for topic in (*FLOW_TOPICS, *SONARS):
            for sample in update.samples.get(topic, ()):
                self._keep(topic, sample)

    def _keep(self, topic: str, sample: Sample) -> None:
        kept = self._kept.setdefault(topic, deque())
        if topic not in SONARS and len(kept) > 1:
            said = _said(sample)
            if said == _said(kept[-1]) == _said(kept[-2]):
                return
        kept.append(sample)
        size = self._bytes.get(topic, 0) + sample.size_bytes
        while len(kept) > KEPT or (size > KEPT_BYTES and len(kept) > 1):
            size -= kept.popleft().size_bytes
        self._bytes[topic] = size

    def before(self, update: GraphUpdate, topics: set[str]) -> GraphUpdate:
        """Return the update with all that is kept of these topics in the place of what it has."""
        past = {topic: tuple(self._kept[topic]) for topic in topics & self._kept.keys()}
        return replace(update, samples={**update.samples, **past}) if past else update


def _said(sample: Sample) -> object:
    """Return a message without its time stamp, so that it can be compared."""
    return {name: _comparable(field) for name, field in sample.value.items() if name != "header"}


def _comparable(value: Value) -> object:
    """Return a field with lists in place of arrays; before the first frame there is no numpy."""
    if isinstance(value, Mapping):
        return {name: _comparable(field) for name, field in value.items()}
    if isinstance(value, list):
        return [_comparable(each) for each in value]
    to_list = getattr(value, "tolist", None)
    return value if to_list is None else to_list()
