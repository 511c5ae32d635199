"""A brain that hears and speaks by itself: sound up, sound down, over OpenAI's Realtime protocol.

It takes the place of `ai_brain`, `hearing` and `speaking`. The microphone's sound goes to the
server of the user's settings (`realtime_model`), all of it, as long as the node runs; the model's
voice comes on /audio/speaker_raw. Commands come as the call of a function, are checked, and go to
/llm_raw_json, through llm_parser and the gate. Whoever speaks interrupts the model. The words for
stop, as the server understood them, and an emergency stop break its answer off; until somebody
speaks again it can do nothing. If the connection is lost, the robot stands, and it is made anew.

Use a headset, or a microphone that cancels the loudspeaker's echo: otherwise the model hears and
interrupts itself.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from std_msgs.msg import ByteMultiArray, Float32, String

from brain.faults import FaultKind, ModelError
from brain.prompt import prompt_file, read_prompt
from nodes.parts.node import DEPTH, LessonNode, NodeUsageError, Number, SensorListener, Text, Whole
from nodes.parts.runner import run
from nodes.parts.sound import sound_message, sound_of
from nodes.parts.stop_news import StopNews
from nodes.thinking.model import AskedModel, BrainState
from nodes.thinking.senses import Senses
from robot.commands.brain import asks_to_stop, spoken
from robot.commands.schema import DriveCommand, LlmResponse
from robot.sound import RATE_HZ, SAMPLE, Resampler, text_in
from robot.topics import LLM_RAW_JSON, MICROPHONE, SONAR_FRONT, SPEAKER
from text.i18n import N_

if TYPE_CHECKING:
    from brain.budget import TokenUsage
    from brain.realtime import RealtimeTalk, TalkHandlers

BLOCK_S = 0.1
_AHEAD = 3
"""Blocks that are published at once at the beginning: what the loudspeaker may be late by."""


class PacedSpeaker:
    """Publishes sound on /audio/speaker_raw at the pace at which it is played: so it can be broken off."""

    def __init__(self, node: LessonNode, rate_hz: int) -> None:
        self._publisher = node.create_publisher(ByteMultiArray, SPEAKER, DEPTH)
        self._block = round(rate_hz * BLOCK_S) * SAMPLE
        self._waiting = bytearray()
        self._ahead = 0
        node.every(BLOCK_S, self._tick)

    def play(self, pcm: bytes) -> None:
        """Have this played after what waits already."""
        self._waiting += pcm
        while self._waiting and self._ahead < _AHEAD:
            self._publish()

    def drop(self) -> None:
        """Play nothing of what waits."""
        self._waiting.clear()

    def _tick(self) -> None:
        self._ahead = max(0, self._ahead - 1)
        if self._waiting:
            self._publish()

    def _publish(self) -> None:
        self._ahead += 1
        self._publisher.publish(sound_message(bytes(self._waiting[: self._block])))
        del self._waiting[: self._block]


_STARTED = N_("The microphone's sound goes to {model} at {url}, all of it")
_NO_MODEL = N_("No talk is possible: {problem}")
_HEARD = N_('Heard: "{words}"')
_SAID = N_('Says: "{words}"')
_ACTS = N_('The model thinks: "{thought}" ({count} commands)')
_REFUSED = N_("Refused, nothing is done: {problem}")
_LOST = N_("No talk: {problem}; I stand")
_AGAIN = N_("Trying again in {seconds:.0f} s")
_FIRST_WAIT_S, _LONGEST_WAIT_S = 1.0, 30.0
_FOR_GOOD = (FaultKind.SETTINGS, FaultKind.PROMPT, FaultKind.BUDGET, FaultKind.KEY, FaultKind.MODEL)
"""After these, another attempt would end the same way, and might cost money."""
_STANDS = LlmResponse(thought="stand still", commands=[DriveCommand(action="drive", speed=0, steering=0)])


class RealtimeBrain(LessonNode):
    """Keeps one talk going."""

    NAME = "ai_brain"
    prompt = Text("", "File with the system prompt; empty: Deck's own", may_be_empty=True)
    sample_rate = Whole(RATE_HZ, "Samples a second, of both topics", fixed=True, low=8000, high=96_000, unit="Hz")
    stale_after_s = Number(2.5, "An older distance is ignored", low=0.1, high=60.0, unit="s")

    def __init__(self) -> None:
        super().__init__()
        from brain.realtime import RATE_HZ as TALK_HZ

        rate_hz = self.sample_rate
        self._up, self._down = Resampler(rate_hz, TALK_HZ), Resampler(TALK_HZ, rate_hz)
        try:
            self._model = AskedModel(self, lambda settings: settings.realtime_model)
        except ModelError as error:
            raise NodeUsageError(_NO_MODEL, problem=error.words) from None
        self._state = BrainState(self, self._model)
        self._speaker = PacedSpeaker(self, rate_hz)
        self._json = self.create_publisher(String, LLM_RAW_JSON, DEPTH)
        self._front_m: float | None = None
        self._front_s = 0.0
        self._senses = Senses(self, self.stale_after_s)
        self._talk: RealtimeTalk | None = None
        self._wait_s = _FIRST_WAIT_S
        self._retry = self.every(_FIRST_WAIT_S, self._begin)
        SensorListener(self, Float32, SONAR_FRONT, self._measure)
        self.create_subscription(ByteMultiArray, MICROPHONE, self._hear, DEPTH)
        StopNews(self, self._stop)
        url = self._model.settings.base_url
        self.say.info(_STARTED, model=self._model.name, url=url)
        self._begin()

    def before_end(self) -> None:
        self._model.close()

    # ---------------------------------------------------------------- the talk

    def _begin(self) -> None:
        from brain.realtime import RealtimeTalk

        self._retry.cancel()
        try:
            prompt = read_prompt(prompt_file(self.prompt, "brain", self.say.language))
        except ModelError as error:
            self._lost(error)
            return
        model = self._model
        talk = RealtimeTalk(model.settings, model.key, model.ledger, model.who, prompt, self._handlers())
        self._talk = talk
        self._state.waits()
        model.run(talk.run(), lambda _: None, self._lost)

    def _lost(self, error: ModelError) -> None:
        self._talk = None
        self._speaker.drop()
        self._stand()
        self._state.failed(error)
        self.say.error(_LOST, problem=error.words)
        if error.kind in _FOR_GOOD:
            return
        wait_s = max(self._wait_s, error.retry_after_s or 0.0)
        self._wait_s = min(2 * self._wait_s, _LONGEST_WAIT_S)
        self.say.info(_AGAIN, seconds=wait_s)
        self._retry.timer_period_ns = int(wait_s * 1e9)
        self._retry.reset()

    def _handlers(self) -> TalkHandlers:
        """Return what the talk calls on its own thread, each to be done on the node's."""
        from brain.realtime import TalkHandlers

        later = self._model.later
        return TalkHandlers(
            sound=lambda pcm: later(lambda: self._speaker.play(self._down.feed(pcm))),
            interrupted=lambda: later(self._interrupted),
            heard=lambda words: later(lambda: self._heard(words)),
            said=lambda words: later(lambda: self._said(words)),
            act=lambda response: later(lambda: self._act(response)),
            refused=lambda problem: later(lambda: self._refused(problem)),
            sense=self._sensed,
            used=lambda usage: later(lambda: self._used(usage)),
        )

    def _sensed(self) -> str:
        fresh = time.monotonic() - self._front_s <= self.stale_after_s
        return self._senses.situation("", self._front_m if fresh else None).senses()

    def _used(self, usage: TokenUsage) -> None:
        self._wait_s = _FIRST_WAIT_S
        self._state.answered(usage)

    def _interrupted(self) -> None:
        self._speaker.drop()
        self._state.thinks()

    def _heard(self, words: str) -> None:
        self.say.info(_HEARD, words=words)
        if asks_to_stop(words):
            self._stop()

    def _said(self, words: str) -> None:
        self.say.info(_SAID, words=words)

    def _refused(self, problem: str) -> None:
        self.say.warn(_REFUSED, problem=problem)

    def _act(self, response: LlmResponse) -> None:
        self.say.info(_ACTS, thought=response.thought, count=len(response.commands))
        self._json.publish(String(data=response.model_dump_json()))

    def _stand(self) -> None:
        self._json.publish(String(data=_STANDS.model_dump_json()))

    def _stop(self) -> None:
        self._speaker.drop()
        self._stand()
        if self._talk is not None:
            self._model.begin(self._talk.stop())

    # ---------------------------------------------------------------- what the node hears

    def _measure(self, message: Float32) -> None:
        self._front_m, self._front_s = message.data, time.monotonic()

    def _hear(self, message: ByteMultiArray) -> None:
        sound, talk = sound_of(message), self._talk
        if talk is None or not sound:
            return
        if text_in(sound) is None:
            pcm = self._up.feed(sound[: len(sound) // SAMPLE * SAMPLE])
            self._model.call(lambda: talk.hear(pcm))
            return
        words = spoken(sound)
        self._heard(words)
        if not asks_to_stop(words):
            self._model.begin(talk.tell(words))


if __name__ == "__main__":
    raise SystemExit(run(RealtimeBrain))
