"""What human and robot say to each other."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from robot.topics import AUDIO_LEVEL, HEARD, MICROPHONE, SPEAKER
from text.i18n import N_
from tui.panels.other_type import other_type
from tui.panels.panel import Panel, newest, row_of, trouble_of
from tui.panels.voice.widget import Speaker, VoiceView

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from graph.data import GraphUpdate
    from tui.widgets.drawing import Placeholder

TYPE = "std_msgs/msg/ByteMultiArray"
TOPICS: dict[str, Speaker] = {MICROPHONE: "human", SPEAKER: "robot"}
SILENT_S = 2.0
"""A driver that has reported no level for this long has no microphone."""


class VoicePanel(Panel):
    """The conversation so far."""

    title = N_("Voice")
    least = 2
    weight = 2
    across_below = 80

    def __init__(self) -> None:
        super().__init__()
        self._placeholder: dict[str, Placeholder | None] = {}

    def compose(self) -> ComposeResult:
        yield VoiceView()

    def followed(self) -> set[str]:
        """All messages of microphone and loudspeaker, and the words that were recognised."""
        return {*TOPICS, HEARD}

    def watched(self) -> set[str]:
        return {AUDIO_LEVEL}

    def show(self, update: GraphUpdate) -> None:
        """Add what was said, in order of arrival."""
        talk = self.query_one(VoiceView)
        said = [sample for topic in (*TOPICS, HEARD) for sample in update.samples.get(topic, ())]
        for sample in sorted(said, key=lambda one: one.received_s):
            data = sample.value.get("data", b"")
            if sample.topic == HEARD and isinstance(data, str):
                talk.hear("human", data.encode("utf-8", "replace"), sample.received_s)
            elif isinstance(data, bytes):
                talk.hear(TOPICS.get(sample.topic, "human"), data, sample.received_s)
        self._show_level(talk, update)
        placeholder = self._of_another_type(update)
        talk.show_placeholder(placeholder)
        talk.show_trouble(*((None,) if placeholder else trouble_of(update, MICROPHONE)))

    def _of_another_type(self, update: GraphUpdate) -> Placeholder | None:
        """Return what to show for the first topic with messages of another type."""
        for topic in TOPICS:
            if topic in update.samples:
                self._placeholder[topic] = other_type(newest(update, topic), TYPE)
            row, words = row_of(update, topic), self._placeholder.get(topic)
            if row is not None and row.publishers and words is not None:
                return words
        return None

    def _show_level(self, talk: VoiceView, update: GraphUpdate) -> None:
        sample = newest(update, AUDIO_LEVEL)
        dbfs = sample.value.get("data") if sample is not None else None
        if isinstance(dbfs, (int, float)) and math.isfinite(dbfs):
            talk.show_level(float(dbfs))
            return
        teller, microphone = row_of(update, AUDIO_LEVEL), row_of(update, MICROPHONE)
        if teller is not None and teller.publishers:
            if teller.trouble is not None or (teller.age_s or 0.0) > SILENT_S:
                talk.show_level(None, missing=True)
            return
        # The course's own microphone does not report a level.
        there = microphone is not None and microphone.publishers > 0
        talk.show_level(None, missing=not there and talk.has_talk)
