"""The outcome of the newest JSON on /llm_raw_json, whoever sent it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.data import GraphUpdate, Sample
from robot.topics import LLM_RAW_JSON
from text.i18n import N_, _
from tui import clock
from tui.frame.actions.app import SHOW
from tui.frame.host import host_of
from tui.outcome.trail import FOLLOWED, OutcomeTrail
from tui.outcome.view import Outcome
from tui.panels.panel import Panel, row_of

if TYPE_CHECKING:
    from robot.commands.schema import LlmResponse


class ComposerPanel(Panel):
    """The trail of the newest message: accepted or refused, drive, wheels, head."""

    view = Outcome
    title = N_("LLM commands")
    least = 4
    weight = 5
    across_below = 100

    def __init__(self) -> None:
        super().__init__()
        self._trail: OutcomeTrail | None = None
        self._newest: dict[str, Sample] = {}

    def on_mount(self) -> None:
        self._say()

    def followed(self) -> set[str]:
        return {LLM_RAW_JSON, *FOLLOWED}

    def show(self, update: GraphUpdate) -> None:
        for sample in update.samples.get(LLM_RAW_JSON, ()):
            row = row_of(update, LLM_RAW_JSON)
            listeners = [str(row.subscribers)] if row is not None and row.subscribers else []
            expected = _read(str(sample.value.get("data", "")))
            self._trail = OutcomeTrail(sample.received_s, listeners, expected, self._newest)
        if self._trail is not None and not self._trail.over(clock.now()):
            self._trail.see(update.samples)
        self._newest.update({topic: update.samples[topic][-1] for topic in FOLLOWED & update.samples.keys()})
        self._say()

    def on_language_changed(self) -> None:
        self._say()

    def _say(self) -> None:
        outcome = self.query_one(Outcome)
        if self._trail is None:
            key = host_of(self).keys_of(SHOW["composer"])[0]
            outcome.show(_("Nothing received yet; {key} opens the Composer.").format(key=key), ())
            return
        at = clock.time_of_day(self._trail.sent_s)
        entries = self._trail.entries(clock.now())
        outcome.show(_("Came at {time}").format(time=at), entries)


def _read(text: str) -> LlmResponse | None:
    # pydantic is imported only for the lessons that need it.
    from robot.commands.schema import CommandError, parse_llm

    try:
        return parse_llm(text)
    except CommandError:
        return None
