"""The voice: speaks the words on /say, as sound on /audio/speaker_raw.

The `backend` speaks: espeak (Russian and English), or piper (by a voice file of yours), both offline. One
sentence is spoken after the other; while `WAITING` of them wait, the oldest of these is left out for a
new one. Empty words silence it at once, and what waits with it.

Sound is published in blocks at the pace of speech, a little ahead, so that it can be silenced.
"""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from typing import TYPE_CHECKING

from std_msgs.msg import ByteMultiArray, String

from brain.speech.faults import SpeechError
from brain.speech.voices import BACKENDS, language_of, voice
from nodes.parts.node import DEPTH, Choice, LessonNode, NodeUsageError, Text, Whole
from nodes.parts.runner import run
from nodes.parts.sound import sound_message
from robot.sound import RATE_HZ, SAMPLE
from robot.topics import SAY, SPEAKER
from text.i18n import N_

if TYPE_CHECKING:
    from brain.speech.sound import Sound
    from brain.speech.voices import Voice

WAITING = 3
BLOCK_S = 0.1
AHEAD_S = 0.3
"""How much sooner than it is heard a block is published."""
AUTO = "auto"

_STARTED = N_("Speaking what comes on {topic}, by {backend}")
_SAYING = N_('Saying: "{words}" ({seconds:.1f} s)')
_LEFT_OUT = N_('Too much to say, left out: "{words}"')
_SILENCED = N_("Silenced")
_TROUBLE = N_("Cannot speak: {problem}")
_CANNOT = "{problem}"
_SAY_EVERY_S = 10.0


class Speaking(LessonNode):
    """Takes words in the node's thread and speaks in another."""

    NAME = "speaking"
    backend = Choice("espeak", "What speaks", choices=BACKENDS, fixed=True)
    language = Choice(AUTO, "Language of the words; auto: by their letters", choices=(AUTO, "en", "ru"))
    model = Text("", "Voice file, for piper", fixed=True, may_be_empty=True)
    sample_rate = Whole(RATE_HZ, "Samples a second", fixed=True, low=8000, high=96_000, unit="Hz")

    def __init__(self) -> None:
        super().__init__()
        backend = self.backend
        try:
            self._voice: Voice = voice(backend, self.model)
        except SpeechError as error:
            raise NodeUsageError(_CANNOT, problem=error.sentence) from None
        self._rate_hz = self.sample_rate
        self._publisher = self.create_publisher(ByteMultiArray, SPEAKER, DEPTH)
        self._waiting: deque[str] = deque()
        self._changed = threading.Condition()
        self._turn = 0
        """Goes up when what is being said is to be silenced."""
        self.create_subscription(String, SAY, self._say_next, DEPTH)
        threading.Thread(target=self._live, name="voice", daemon=True).start()
        self.say.info(_STARTED, topic=SAY, backend=backend)

    def _say_next(self, message: String) -> None:
        words = message.data.strip()
        with self._changed:
            if not words:
                self._turn += 1
                self._waiting.clear()
                self._changed.notify()
                self.say.info(_SILENCED)
                return
            if len(self._waiting) >= WAITING:
                self.say.warn(_LEFT_OUT, words=self._waiting.popleft())
            self._waiting.append(words)
            self._changed.notify()

    # ---------------------------------------------------------------- the voice's thread

    def _live(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._waiting)
                words, turn = self._waiting.popleft(), self._turn
            language = self.language
            language = language_of(words) if language == AUTO else language
            try:
                sound = self._voice.speak(words, language).at(self._rate_hz)
            except SpeechError as error:
                self.say.warn(_TROUBLE, every_s=_SAY_EVERY_S, problem=error.sentence)
                continue
            self.say.info(_SAYING, words=words, seconds=sound.seconds)
            self._play(sound, turn)

    def _play(self, sound: Sound, turn: int) -> None:
        """Publish the blocks, unless it is silenced, until the last one has been heard."""
        size = round(self._rate_hz * BLOCK_S) * SAMPLE
        begun_s = time.monotonic()
        for at in range(math.ceil(len(sound.pcm) / size)):
            if self._pause(begun_s + at * BLOCK_S - AHEAD_S, turn):
                return
            if not self.context.ok():
                return
            self._publisher.publish(sound_message(sound.pcm[at * size : (at + 1) * size]))
        self._pause(begun_s + sound.seconds, turn)

    def _pause(self, until_s: float, turn: int) -> bool:
        """Wait, and return whether it was silenced meanwhile."""
        with self._changed:
            left_s = max(0.0, until_s - time.monotonic())
            return self._changed.wait_for(lambda: self._turn != turn, left_s)


if __name__ == "__main__":
    raise SystemExit(run(Speaking))
