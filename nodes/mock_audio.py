"""A simulated microphone and loudspeaker.

Every `period` seconds somebody says a phrase into the microphone, as text in bytes instead of
sound, or nobody if that is 0; what comes for the loudspeaker is written to the log. The first
phrase waits for a subscriber, but not longer than a period. With `sound_file` it is a microphone of
sound: silence, and every `period` seconds what is in the file. The level of the voice goes to
/audio/level.
"""

from __future__ import annotations

import math
import time

from std_msgs.msg import ByteMultiArray, Float32

from brain.speech.faults import SpeechError
from brain.speech.sound import read_sound
from nodes.parts.node import DEPTH, LessonNode, NodeUsageError, Number, Text, change_period
from nodes.parts.runner import run
from nodes.parts.sound import sound_message, sound_of
from robot.sound import LEVEL_S, RATE_HZ, SAMPLE, LevelMeter, mock_level_dbfs, text_in
from robot.topics import AUDIO_LEVEL, MICROPHONE, SPEAKER
from text.i18n import N_

_STARTED = N_("Microphone and loudspeaker are on")
_SAID = N_('Somebody said into the microphone: "{words}"')
_PLAYED = N_('The loudspeaker plays: "{words}"')
_PLAYED_FILE = N_("Somebody speaks into the microphone: {path}")
_PLAYED_SOUND = N_("The loudspeaker plays sound")
_CANNOT = "{problem}"
_PHRASE = N_("VOICE_COMMAND: have a look round and tell me what is there")

_SHORT = 64
"""Bytes: two milliseconds of sound, which nobody plays. Whatever is shorter is meant as text."""
_LOOK_EVERY_S = 0.5
"""How long to wait for a first subscriber."""
_BLOCK_S = 0.1
_SHORTEST_S = 0.1
_SAY_EVERY_S = 5.0


class MockAudio(LessonNode):
    """Speaks now and then, and listens."""

    NAME = "audio_system"
    period = Number(10.0, "Time between two phrases; 0: no phrases", high=3600.0, unit="s")
    first_after = Number(3.0, "Time before the first", low=0.1, high=3600.0, unit="s", fixed=True)
    phrase = Text("", "What is said; empty: a request to look round", may_be_empty=True)
    sound_file = Text("", "Sound in place of the phrase: WAV, FLAC or MP3", fixed=True, may_be_empty=True)

    def __init__(self) -> None:
        super().__init__()
        self._began = self._listened = False
        self._started_s = time.monotonic()
        self._said_s = -math.inf
        self._words = ""
        self._sound = self._read()
        self._left = b""
        """What is still to be said of the file."""
        self._meter = LevelMeter(RATE_HZ)
        self._publisher = self.create_publisher(ByteMultiArray, MICROPHONE, DEPTH)
        self._levels = self.create_publisher(Float32, AUDIO_LEVEL, DEPTH)
        self.create_subscription(ByteMultiArray, SPEAKER, self._play, DEPTH)
        self._timer = self.every(self.first_after, self._speak)
        self.every(LEVEL_S, self._tell_level)
        if self._sound:
            self.every(_BLOCK_S, self._publish_block)
        self.say.info(_STARTED)

    def parameters_changed(self) -> None:
        """Apply the new period, from the next phrase on."""
        if self._began:
            change_period(self._timer, self._period_s())

    def _period_s(self) -> float:
        return max(self.period, _SHORTEST_S)

    def _speak(self) -> None:
        if not self.period:
            return
        if not self._began:
            if not self._has_listener():
                change_period(self._timer, _LOOK_EVERY_S)
                return
            self._began = True
            change_period(self._timer, self._period_s())
        if self._sound:
            self._left = self._sound
            self.say.info(_PLAYED_FILE, path=self.sound_file)
            return
        words = self.phrase or self.say.text(_PHRASE)
        self._publisher.publish(sound_message(words.encode("utf-8", "replace")))
        self._said_s, self._words = time.monotonic(), words
        self.say.info(_SAID, words=words)

    def _read(self) -> bytes:
        if not self.sound_file:
            return b""
        try:
            return read_sound(self.sound_file, RATE_HZ).pcm
        except SpeechError as error:
            raise NodeUsageError(_CANNOT, problem=error.sentence) from None

    def _publish_block(self) -> None:
        size = int(RATE_HZ * _BLOCK_S) * SAMPLE
        block, self._left = self._left[:size].ljust(size, b"\0"), self._left[size:]
        self._meter.feed(block)
        self._publisher.publish(sound_message(block))

    def _tell_level(self) -> None:
        if self._sound:
            self._levels.publish(Float32(data=self._meter.dbfs))
            return
        since_s = time.monotonic() - self._said_s
        self._levels.publish(Float32(data=mock_level_dbfs(self._words, since_s)))

    def _has_listener(self) -> bool:
        """Whether to say the first phrase: somebody is subscribed, or has had enough time to.

        Checked twice in a row, as the two ends do not discover each other at the same moment.
        """
        listened, self._listened = self._listened, self._publisher.get_subscription_count() > 0
        patience_s = self.first_after + self.period
        overdue = time.monotonic() - self._started_s > patience_s
        return overdue or (listened and self._listened)

    def _play(self, message: ByteMultiArray) -> None:
        sound = sound_of(message)
        if len(sound) > _SHORT and text_in(sound) is None:
            self.say.info(_PLAYED_SOUND, every_s=_SAY_EVERY_S)
        else:
            self.say.info(_PLAYED, words=sound.decode("utf-8", "replace"))


if __name__ == "__main__":
    raise SystemExit(run(MockAudio))
