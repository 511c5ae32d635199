"""What human and robot say to each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tui.i18n import N_
from tui.panels.panel import Panel, trouble_of
from tui.widgets.voice import Speaker, VoicePanel

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from graph.data import GraphUpdate

TOPICS: dict[str, Speaker] = {"/audio/mic_raw": "human", "/audio/speaker_raw": "robot"}
HEARD_FIRST = "/audio/mic_raw"


class VoiceFeed(Panel):
    """The talk so far."""

    title = N_("Voice")
    least = 2
    weight = 2
    across_below = 80

    def compose(self) -> ComposeResult:
        """The transcript."""
        yield VoicePanel()

    def followed(self) -> set[str]:
        """Microphone and loudspeaker, nothing missed."""
        return set(TOPICS)

    def show(self, update: GraphUpdate) -> None:
        """Add what was said, in the order in which it came."""
        talk = self.query_one(VoicePanel)
        said = [sample for topic in TOPICS for sample in update.samples.get(topic, ())]
        for sample in sorted(said, key=lambda one: one.received_s):
            data = sample.value.get("data", b"")
            if isinstance(data, bytes):
                talk.hear(TOPICS[sample.topic], data, sample.received_s)
        talk.show_trouble(*trouble_of(update, HEARD_FIRST))

    def words_changed(self) -> None:
        """Draw anew in another language."""
        super().words_changed()
        self.query_one(VoicePanel).words_changed()
