"""Hearing and speaking: what is cut out, recognised and said, here or by a server."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from brain.speech.espeak import EspeakVoice
from brain.speech.faults import SpeechError
from brain.speech.recognisers import recogniser
from brain.speech.sound import Sound, read_sound
from brain.speech.sphinx import SphinxRecogniser
from brain.speech.utterances import CLOSING_S, Utterances
from brain.speech.voices import voice
from robot.sound import RATE_HZ
from tests.wav import wav_of

SECOND = bytes(2 * RATE_HZ)


@pytest.fixture(scope="module")
def ears() -> SphinxRecogniser:
    return SphinxRecogniser()


def spoken(text: str, name: str = "en", **how: int) -> bytes:
    return EspeakVoice(**how).speak(text, name).at(RATE_HZ).pcm


@pytest.mark.parametrize("text", ["stop", "robot, turn left", "robot, have a look around"])
@pytest.mark.parametrize("piece", [320, 3200, 9999])
def test_an_utterance_is_cut_out_whole_however_its_sound_comes(text: str, piece: int) -> None:
    said, found = spoken(text), list[Sound]()
    utterances, sound = Utterances(RATE_HZ), SECOND + said + SECOND
    for at in range(0, len(sound), piece):
        found += utterances.feed(sound[at : at + piece])
    (only,) = found
    loud = np.flatnonzero(np.abs(np.frombuffer(said, "<i2")) > 300)
    length_s = (loud[-1] - loud[0]) / RATE_HZ
    assert length_s <= only.seconds < length_s + 2 * CLOSING_S + 0.2
    assert not utterances.speaking


def test_silence_and_clicks_are_no_utterance() -> None:
    click = b"\xff\x7f" * (RATE_HZ // 50)
    assert Utterances(RATE_HZ).feed(3 * SECOND + click + SECOND + click + 2 * SECOND) == []


def test_who_does_not_cease_to_speak_is_cut() -> None:
    utterances = Utterances(RATE_HZ, longest_s=2.0)
    endless = spoken("one two three four five six seven eight nine ten " * 6)
    lengths = [each.seconds for each in utterances.feed(endless + SECOND)]
    assert len(lengths) > 3
    assert max(lengths) == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize(
    "text", ["robot forward", "robot turn left", "robot turn right", "robot go back", "robot stop", "stop"]
)
@pytest.mark.parametrize("name", ["en", "en-us", "en-us-nyc"])
def test_a_command_is_recognised(ears: SphinxRecogniser, text: str, name: str) -> None:
    (said,) = Utterances(RATE_HZ).feed(SECOND + spoken(text, name) + SECOND)
    assert ears.transcribe(said) == text


@pytest.mark.parametrize(
    "text",
    [
        "good morning everybody", "there is nothing left in the fridge",
        "you are quite right about this", "I am looking forward to your letter",
        "turn on the light in the kitchen", "bright", "left",
    ],
)  # fmt: skip
def test_what_is_no_command_is_not_taken_for_one(ears: SphinxRecogniser, text: str) -> None:
    for said in Utterances(RATE_HZ).feed(SECOND + spoken(text) + SECOND):
        assert ears.transcribe(said) == ""


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: recogniser("sphinx", "ru", ""), "pocketsphinx knows only English: take backend:=vosk"),
        (lambda: recogniser("vosk", "ru", ""), "vosk is not installed: pip install vosk"),
        (lambda: voice("piper", ""), "piper-tts is not installed: pip install piper-tts"),
    ],
)
def test_what_cannot_hear_or_speak_says_what_it_lacks(make: Callable[[], object], words: str) -> None:
    with pytest.raises(SpeechError) as caught:
        make()
    assert str(caught.value.sentence).startswith(words)


def test_a_sound_file_is_read_at_the_rate_that_is_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "said.wav"
    path.write_bytes(wav_of(Sound(SECOND, RATE_HZ)))
    assert read_sound(str(path), 8000).seconds == pytest.approx(1.0, abs=0.01)
    path.write_bytes(b"no sound at all")
    with pytest.raises(SpeechError, match="is not a sound file"):
        read_sound(str(path), 8000)
