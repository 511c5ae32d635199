"""A real microphone and a real loudspeaker, through miniaudio.

Publishes the microphone's sound on /audio/mic_raw and plays the sound from /audio/speaker_raw:
bytes of 16-bit little-endian samples, one channel, `sample_rate` of them per second. The level of
the microphone goes to /audio/level ten times a second. A device that disappears is reopened when it
returns; the state of both goes to /diagnostics once a second.
"""

from __future__ import annotations

import time
from functools import partial

from std_msgs.msg import ByteMultiArray, Float32

from nodes.drivers.diagnostics import tell_every_second
from nodes.drivers.sound_device import IN, OUT
from nodes.drivers.sound_port import EMPTY, LATE, ODD, UNPLAYED, WORDS, SoundPort
from nodes.parts.node import DEPTH, LessonNode, Number, Text, Whole
from nodes.parts.runner import run
from nodes.parts.sound import sound_message, sound_of
from robot.sound import LEVEL_S, RATE_HZ, SAMPLE, LevelMeter, text_in
from robot.topics import AUDIO_LEVEL, MICROPHONE, SPEAKER
from text.i18n import N_

_STARTED = N_("Sound goes to {microphone} and comes from {speaker}")
_SAY_EVERY_S = 5.0
_FRESH_S = 0.5
"""Without a block for this long beyond its length, there is no level."""


_NAMES = N_("name, part of one, number, none; empty: the default")


class Audio(LessonNode):
    """Publishes from the threads of its ports."""

    NAME = "audio_system"
    input_device = Text("", "The microphone", fixed=True, may_be_empty=True, or_number=True, form=_NAMES)
    output_device = Text("", "The loudspeaker", fixed=True, may_be_empty=True, or_number=True, form=_NAMES)
    sample_rate = Whole(RATE_HZ, "Samples a second, of both topics", fixed=True, low=8000, high=96_000, unit="Hz")
    block_ms = Whole(100, "Length of a message", fixed=True, low=10, high=1000, unit="ms")
    speaker_queue_s = Number(
        60.0, "Sound that may wait; beyond that the oldest is dropped", fixed=True, low=0.5, high=600.0, unit="s"
    )

    def __init__(self) -> None:
        super().__init__()
        self._rate_hz, self._block_ms = (self.sample_rate, self.block_ms)
        self._meter = LevelMeter(self._rate_hz)
        self._heard_s = -_FRESH_S
        self._publisher = self.create_publisher(ByteMultiArray, MICROPHONE, DEPTH)
        self._levels = self.create_publisher(Float32, AUDIO_LEVEL, DEPTH)
        form = self._rate_hz, self._block_ms
        self._microphone = SoundPort(self.say, IN, self.input_device, *form, heard=self._hear)
        self._speaker = SoundPort(self.say, OUT, self.output_device, *form, queue_s=self.speaker_queue_s)
        self.create_subscription(ByteMultiArray, SPEAKER, self._play, DEPTH)
        self.every(LEVEL_S, self._tell_level)
        for port, name in ((self._microphone, "microphone"), (self._speaker, "speaker")):
            tell_every_second(self, partial(port.status, f"{self.get_name()}: {name}"))
        self.say.info(_STARTED, microphone=MICROPHONE, speaker=SPEAKER)
        self._microphone.start()
        self._speaker.start()

    def before_end(self) -> None:
        self._microphone.close()
        self._speaker.close()

    # ---------------------------------------------------------------- the microphone's thread

    def _hear(self, block: bytes) -> None:
        self._meter.feed(block)
        self._heard_s = time.monotonic()
        if self.context.ok() and self._publisher.get_subscription_count():
            self._publisher.publish(sound_message(block))

    # ---------------------------------------------------------------- the node's thread

    def _tell_level(self) -> None:
        if time.monotonic() - self._heard_s <= self._block_ms / 1000 + _FRESH_S:
            self._levels.publish(Float32(data=self._meter.dbfs))

    def _play(self, message: ByteMultiArray) -> None:
        sound = sound_of(message)
        if not sound:
            self.say.warn(EMPTY, every_s=_SAY_EVERY_S)
            return
        words = text_in(sound)
        if words is not None:
            self.say.info(WORDS, words=words)
            return
        if len(sound) % SAMPLE:
            self.say.warn(ODD, every_s=_SAY_EVERY_S, count=len(sound))
            sound = sound[:-1]
        if not self._speaker.wants:
            return
        dropped, there = self._speaker.play(sound)
        if dropped:
            seconds = dropped / SAMPLE / self._rate_hz
            self.say.warn(LATE if there else UNPLAYED, every_s=_SAY_EVERY_S, seconds=seconds)


if __name__ == "__main__":
    raise SystemExit(run(Audio))
