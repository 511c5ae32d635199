"""How well spoken commands are heard, offline: `python -m bench.voice.words [--all]`.

Voices of eSpeak NG say every command of `robot.words`, fast and slow, high and low, with more and
less noise; then they say what is no command: ordinary sentences, words that sound like commands,
and sentences about a robot. A motion that nobody asked for counts for more than one that was not
heard, because it moves the robot.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bench.voice.texts import CHAT, NEAR, ROBOT
from brain.speech.espeak import EspeakVoice
from brain.speech.sound import Sound
from brain.speech.sphinx import SphinxRecogniser
from brain.speech.utterances import Utterances
from robot.sound import RATE_HZ
from robot.words import LOOK, SPOKEN, STOP_WORDS, WAKE_WORDS, parse_spoken

if TYPE_CHECKING:
    from collections.abc import Iterator

VOICES = (
    *("en-us", "en", "en-gb-scotland", "en-gb-x-rp", "en-029", "en-us-nyc"),
    *("en-us+f2", "en+f4", "en-us+m3", "en+m5", "en-gb-x-gbcwmd+f1"),
)
MANNERS = ((35, 160, 50), (20, 190, 70), (12, 130, 30), (25, 145, 60))
"""Signal to noise in dB, words a minute, pitch."""
BEFORE_S, AFTER_S = 0.5, 0.8


@dataclass(frozen=True)
class Spoken:
    """Something said, and how."""

    text: str
    voice: str
    noise_db: int
    sound: Sound


def speak(text: str, voice: str, manner: tuple[int, int, int], seed: int) -> Spoken:
    """Return a text in a noisy room."""
    noise_db, words_per_min, pitch = manner
    said = EspeakVoice(words_per_min=words_per_min, pitch=pitch).speak(text, voice).at(RATE_HZ)
    wave = np.frombuffer(said.pcm, "<i2").astype(np.float64)
    power = float(np.mean(np.square(wave[wave != 0])))
    before, after = (np.zeros(int(seconds * RATE_HZ)) for seconds in (BEFORE_S, AFTER_S))
    wave = np.concatenate((before, wave, after))
    spectrum = np.fft.rfft(np.random.default_rng(seed).normal(size=len(wave)))
    # Pink, as rooms are.
    noise = np.fft.irfft(spectrum / np.sqrt(np.maximum(1, np.arange(len(spectrum)))), len(wave))
    wave += noise / noise.std() * np.sqrt(power / 10 ** (noise_db / 10))
    pcm = np.clip(wave, -32768, 32767).astype("<i2").tobytes()
    return Spoken(text, voice, noise_db, Sound(pcm, RATE_HZ))


def commands() -> Iterator[Spoken]:
    """Yield every command in every voice."""
    ways = [way for words in SPOKEN["en"].values() for way in words] + list(LOOK["en"])
    texts = [f"{WAKE_WORDS['en']} {way}" for way in ways]
    texts += SPOKEN["en"][STOP_WORDS["en"]]
    number = 0
    for text in texts:
        for voice in VOICES:
            number += 1
            yield speak(text, voice, MANNERS[number % len(MANNERS)], number)


def others() -> Iterator[Spoken]:
    """Yield what is no command, each in three voices."""
    for at, text in enumerate((*NEAR, *CHAT, *ROBOT)):
        for turn in range(3):
            voice = VOICES[(at + 4 * turn) % len(VOICES)]
            yield speak(text, voice, MANNERS[(at + turn) % len(MANNERS)], 3 * at + turn)


def heard(ears: SphinxRecogniser, spoken: Spoken, took_s: list[float]) -> list[str]:
    """Return what each utterance in the sound was taken for."""
    found = []
    for said in Utterances(RATE_HZ).feed(spoken.sound.pcm):
        begun_s = time.perf_counter()
        words = ears.transcribe(said)
        took_s.append(time.perf_counter() - begun_s)
        found.append(parse_spoken(words) or "")
    return [each for each in found if each]


def main() -> int:
    """Print the measure; --all also every mistake."""
    ears, took_s = SphinxRecogniser(), list[float]()
    right, wrong, missed = Counter[int](), list[str](), Counter[int]()
    for spoken in commands():
        found = heard(ears, spoken, took_s)
        if found == [parse_spoken(spoken.text)]:
            right[spoken.noise_db] += 1
        elif found:
            wrong.append(f"{spoken.text} ({spoken.voice}, {spoken.noise_db} dB): {found}")
        else:
            missed[spoken.noise_db] += 1
    total = right.total() + len(wrong) + missed.total()
    print(f"commands heard rightly: {right.total()} of {total}, {right.total() / total:.0%}")
    for noise_db in sorted(right | missed, reverse=True):
        of = right[noise_db] + missed[noise_db]
        print(f"  {noise_db} dB above the noise: {right[noise_db] / of:.0%}, wrong ones aside")
    print(f"taken for another command: {len(wrong)}")
    false, count = list[str](), 0
    for spoken in others():
        count += 1
        false += [f"{spoken.text}: {each}" for each in heard(ears, spoken, took_s)]
    stops = sum(each.endswith(f": {STOP_WORDS['en']}") for each in false)
    print(f"no commands, taken for a motion: {len(false) - stops} of {count}; for a stop: {stops}")
    print(f"recognition of one utterance: {1000 * statistics.median(took_s):.0f} ms (median)")
    if "--all" in sys.argv:
        print("\n".join(wrong + false))
    return 0


if __name__ == "__main__":
    sys.exit(main())
