"""pocketsphinx: recognises the robot's commands in English, offline, in some 50 ms.

A grammar alone turns every sound into a command. So each utterance is heard twice: by the grammar
of `robot.words`, and as any chain of phonemes whatever. The grammar's answer counts only if it
explains the sound nearly as well as the free chain does, with about as many phonemes, and with no
word drawn out. What is not sure is not heard: a robot that stands is better than one that drives
because somebody talked. The bounds are those of bench/voice/words.py.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from brain.speech.faults import missing
from robot.sound import RATE_HZ, samples_of
from robot.words import LOOK, SPOKEN, STOP_WORDS, WAKE_WORDS, parse_spoken

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pocketsphinx

    from brain.speech.sound import Sound

PRONUNCIATIONS = {"robot(5)": "R OW B AO T", "stop(5)": "S T AO P", "stop(6)": "S T AH P"}
"""British ones, in ARPAbet, beside the American ones of the dictionary."""
WORST_NATS_PER_FRAME = -5.0
"""How much worse than the free chain of phonemes the grammar may explain 10 ms of sound."""
WORST_FOR_STOP = -8.0
"""The same for a stop, which may rather be heard once too often."""
FEWER_PHONEMES, MORE_PHONEMES = 2, 3
"""By how many phonemes the free chain may be shorter or longer than the command."""
LONGEST_FRAMES_PER_PHONEME = 20.0
"""A word that takes longer is not the word."""
_BEAM = 1e-20
_LANGUAGE_WEIGHT = 2.0
_LEAST = 1e-300
"""The smallest likelihood: below it floating point has only 0."""
_SILENCE = "SIL"
_FLOOR = 10.0
"""Noise that is added, of 32768: the silence of a file, or of a microphone with a gate, is no sound
that the model knows."""


class SphinxRecogniser:
    """Hears the commands of `robot.words` and nothing else.

    Raises:
        SpeechError: if pocketsphinx is not installed.
    """

    def __init__(self) -> None:
        try:
            import pocketsphinx
        except ImportError:
            raise missing("pocketsphinx", "'deck-robot[voice]'") from None
        self._commands = pocketsphinx.Decoder(lm=None, loglevel="FATAL")
        for word, phonemes in PRONUNCIATIONS.items():
            self._commands.add_word(word, phonemes, True)
        self._commands.add_jsgf_string("commands", grammar())
        self._commands.activate_search("commands")
        self._phonemes = pocketsphinx.Decoder(
            lm=None,
            allphone=pocketsphinx.get_model_path("en-us/en-us-phone.lm.bin"),
            lw=_LANGUAGE_WEIGHT,
            beam=_BEAM,
            pbeam=_BEAM,
            loglevel="FATAL",
        )

    def transcribe(self, said: Sound) -> str:
        """Return a command, empty if it was none for sure."""
        pcm = _with_floor(said.at(RATE_HZ).pcm)
        words = _decode(self._commands, pcm)
        spoken = [word for word in words if not word.word.startswith("<")]
        text = " ".join(word.word.split("(")[0] for word in spoken)
        meant = parse_spoken(text)
        if meant is None:
            # Nothing, or only the beginning of a command.
            return ""
        heard = _decode(self._phonemes, pcm)
        lengths = [_frames(word) for word in spoken]
        worse = (sum(map(_nats, words)) - sum(map(_nats, heard))) / sum(lengths)
        if meant == STOP_WORDS["en"]:
            return text if worse >= WORST_FOR_STOP else ""
        counts = [self._phonemes_in(word.word) for word in spoken]
        more = sum(_is_phoneme(each.word) for each in heard) - sum(counts)
        drawn_out = max(length / count for length, count in zip(lengths, counts, strict=True))
        sure = (
            worse >= WORST_NATS_PER_FRAME
            and -FEWER_PHONEMES <= more <= MORE_PHONEMES
            and drawn_out <= LONGEST_FRAMES_PER_PHONEME
        )
        return text if sure else ""

    def _phonemes_in(self, word: str) -> int:
        return len((self._commands.lookup_word(word) or "").split()) or 1


def grammar() -> str:
    """Return the commands as a grammar in JSGF (https://www.w3.org/TR/jsgf/)."""
    ways = [way for words in SPOKEN["en"].values() for way in words] + list(LOOK["en"])
    always = SPOKEN["en"][STOP_WORDS["en"]]
    return (
        "#JSGF V1.0;\ngrammar commands;\n"
        f"<way> = {' | '.join(ways)};\n"
        f"public <said> = {WAKE_WORDS['en']} <way> | {' | '.join(always)};\n"
    )


def _with_floor(pcm: bytes) -> bytes:
    samples = samples_of(pcm)
    noise = np.random.default_rng(0).normal(0.0, _FLOOR, len(samples))
    return np.clip(samples + noise, -32768, 32767).astype("<i2").tobytes()


def _decode(decoder: pocketsphinx.Decoder, pcm: bytes) -> Sequence[pocketsphinx.Segment]:
    decoder.start_utt()
    decoder.process_raw(pcm, full_utt=True)
    decoder.end_utt()
    if decoder.hyp() is None:
        return ()
    return list(decoder.seg() or ())


def _frames(segment: pocketsphinx.Segment) -> int:
    return int(segment.end_frame) - int(segment.start_frame) + 1


def _nats(segment: pocketsphinx.Segment) -> float:
    return math.log(max(_LEAST, float(segment.ascore)))


def _is_phoneme(name: str) -> bool:
    """Whether it is neither silence nor noise, which is written +SPN+."""
    return name != _SILENCE and not name.startswith("+")
