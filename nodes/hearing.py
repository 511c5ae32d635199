"""Ears: words out of the sound of /audio/mic_raw, on /audio/heard.

Each utterance, from the first voice to `silence_s` without one, is recognised by the `backend`:
sphinx (English, the robot's commands only), or vosk (by a `model` folder of yours), both offline. Text in
place of sound, which the lessons send, is left to its listeners.

It hears nothing while the robot itself speaks: for as long as the sound on /audio/speaker_raw
takes, and `echo_s` more. So only the emergency stop interrupts a robot that talks.
"""

from __future__ import annotations

import math
import threading
import time
from typing import TYPE_CHECKING

from std_msgs.msg import ByteMultiArray, String

from brain.speech.faults import SpeechError
from brain.speech.recognisers import BACKENDS, recogniser
from brain.speech.utterances import CLOSING_S, Utterances
from nodes.parts.node import DEPTH, Choice, LessonNode, NodeUsageError, Number, Text, Whole
from nodes.parts.runner import run
from nodes.parts.sound import sound_of
from robot.sound import RATE_HZ, SAMPLE, text_in
from robot.topics import HEARD, MICROPHONE, SPEAKER
from text.i18n import N_

if TYPE_CHECKING:
    from brain.speech.recognisers import Recogniser
    from brain.speech.sound import Sound

TOO_LATE_S = 5.0
"""Words that were recognised this long after they were spoken are not obeyed any more."""
MOST_WAITING_S = 60.0
"""A loudspeaker keeps no more sound than this."""

_STARTED = N_("Listening on {topic}, recognising by {backend}")
_HEARD = N_('Heard: "{words}" ({seconds:.1f} s of speech, recognised in {took:.2f} s)')
_NOTHING = N_("Heard {seconds:.1f} s of speech, but no words in it")
_DROPPED = N_("Still recognising: speech before this is left out")
_LATE = N_("Recognised {age:.1f} s after it was spoken: left out")
_TROUBLE = N_("Cannot recognise: {problem}")
_CANNOT = "{problem}"
_SAY_EVERY_S = 10.0


class Hearing(LessonNode):
    """Cuts the sound in the node's thread and recognises in another."""

    NAME = "hearing"
    backend = Choice("sphinx", "What recognises", choices=BACKENDS, fixed=True)
    language = Choice("en", "Language of the speech", choices=("en", "ru"), fixed=True)
    model = Text("", "Folder of a model, for vosk", fixed=True, may_be_empty=True)
    sample_rate = Whole(RATE_HZ, "Samples a second", fixed=True, low=8000, high=48_000, unit="Hz")
    silence_s = Number(CLOSING_S, "Silence that ends an utterance", fixed=True, low=0.1, high=3.0, unit="s")
    echo_s = Number(0.5, "How long the robot's own words are still heard", low=0.0, high=5.0, unit="s")

    def __init__(self) -> None:
        super().__init__()
        self._rate_hz = self.sample_rate
        backend = self.backend
        try:
            ears = recogniser(backend, self.language, self.model)
            self._utterances = Utterances(self._rate_hz, closing_s=self.silence_s)
        except SpeechError as error:
            raise NodeUsageError(_CANNOT, problem=error.sentence) from None
        self._speaking_until_s = -math.inf
        self._publisher = self.create_publisher(String, HEARD, DEPTH)
        self._worker = _Worker(self, ears)
        self.create_subscription(ByteMultiArray, MICROPHONE, self._hear, DEPTH)
        self.create_subscription(ByteMultiArray, SPEAKER, self._speak, DEPTH)
        self.say.info(_STARTED, topic=MICROPHONE, backend=backend)

    def publish(self, words: str) -> None:
        """Publish what was heard; called by the worker's thread."""
        if self.context.ok():
            self._publisher.publish(String(data=words))

    def _hear(self, message: ByteMultiArray) -> None:
        sound = sound_of(message)
        if text_in(sound) is not None:
            return
        if time.monotonic() < self._speaking_until_s + self.echo_s:
            self._utterances.reset()
            return
        for said in self._utterances.feed(sound):
            self._worker.take(said)

    def _speak(self, message: ByteMultiArray) -> None:
        sound = sound_of(message)
        if text_in(sound) is None:
            # What is published faster than it is played waits.
            now_s = time.monotonic()
            until_s = max(now_s, self._speaking_until_s) + len(sound) / SAMPLE / self._rate_hz
            self._speaking_until_s = min(until_s, now_s + MOST_WAITING_S)


class _Worker:
    """Recognises one utterance after the other; only the newest waits."""

    def __init__(self, node: Hearing, ears: Recogniser) -> None:
        self._node, self._ears = node, ears
        self._waiting: tuple[Sound, float] | None = None
        self._changed = threading.Condition()
        threading.Thread(target=self._live, name="recogniser", daemon=True).start()

    def take(self, said: Sound) -> None:
        """Recognise an utterance that has ended just now."""
        with self._changed:
            if self._waiting is not None:
                self._node.say.warn(_DROPPED)
            self._waiting = said, time.monotonic()
            self._changed.notify()

    def _live(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._waiting is not None)
                assert self._waiting is not None
                (said, ended_s), self._waiting = self._waiting, None
            self._recognise(said, ended_s)

    def _recognise(self, said: Sound, ended_s: float) -> None:
        say, begun_s = self._node.say, time.monotonic()
        try:
            words = self._ears.transcribe(said)
        except SpeechError as error:
            say.warn(_TROUBLE, every_s=_SAY_EVERY_S, problem=error.sentence)
            return
        now_s = time.monotonic()
        if not words:
            say.info(_NOTHING, seconds=said.seconds)
        elif now_s - ended_s > TOO_LATE_S:
            say.warn(_LATE, age=now_s - ended_s)
        else:
            say.info(_HEARD, words=words, seconds=said.seconds, took=now_s - begun_s)
            self._node.publish(words)


if __name__ == "__main__":
    raise SystemExit(run(Hearing))
