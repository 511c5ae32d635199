"""Speech without ROS: utterances, the robot's commands in English, and a voice."""

from __future__ import annotations

import wave
from typing import TYPE_CHECKING

import numpy as np
import pytest

from brain.speech.espeak import LONGEST_S, EspeakVoice
from brain.speech.faults import SpeechError
from brain.speech.folders import one_file
from brain.speech.recognisers import recogniser
from brain.speech.server import wav_of
from brain.speech.sound import Sound
from brain.speech.sound_file import read_sound
from brain.speech.sphinx import SphinxRecogniser
from brain.speech.utterances import CLOSING_S, Utterances
from brain.speech.voices import language_of, voice
from robot.sound import RATE_HZ, level_dbfs

if TYPE_CHECKING:
    from pathlib import Path

SECOND = bytes(2 * RATE_HZ)


@pytest.fixture(scope="module")
def ears() -> SphinxRecogniser:
    return SphinxRecogniser()


def spoken(text: str, name: str = "en", **how: int) -> bytes:
    return EspeakVoice(**how).speak(text, name).at(RATE_HZ).pcm


def noise(seconds: float, amplitude: float) -> bytes:
    samples = np.random.default_rng(3).normal(0.0, amplitude, int(seconds * RATE_HZ))
    return samples.astype("<i2").tobytes()


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


def test_what_was_heard_before_a_reset_is_forgotten() -> None:
    utterances = Utterances(RATE_HZ)
    utterances.feed(SECOND + spoken("robot turn left"))
    utterances.reset()
    assert utterances.feed(2 * SECOND) == []


@pytest.mark.parametrize(
    "text",
    ["robot forward", "robot turn left", "robot turn right", "robot go back", "robot stop", "stop"],
)
@pytest.mark.parametrize("name", ["en", "en-us", "en-us-nyc"])
def test_a_command_is_recognised(ears: SphinxRecogniser, text: str, name: str) -> None:
    (said,) = Utterances(RATE_HZ).feed(SECOND + spoken(text, name) + SECOND)
    assert ears.transcribe(said) == text


@pytest.mark.parametrize(
    "text",
    [
        "good morning everybody",
        "there is nothing left in the fridge",
        "you are quite right about this",
        "I am looking forward to your letter",
        "turn on the light in the kitchen",
        "bright",
        "left",
    ],
)
def test_what_is_no_command_is_not_taken_for_one(ears: SphinxRecogniser, text: str) -> None:
    for said in Utterances(RATE_HZ).feed(SECOND + spoken(text) + SECOND):
        assert ears.transcribe(said) == ""


def test_a_voice_speaks_both_languages_plainly_and_not_for_ever() -> None:
    plain, marked = (voice("espeak", "").speak(text, "en") for text in ("hi", "<b>hi</b>"))
    assert level_dbfs(plain.pcm) > -30.0
    assert marked.seconds > plain.seconds, "markup is read out"
    assert voice("espeak", "").speak("Вижу стену", "ru").seconds > 0.5
    assert EspeakVoice().speak("word " * 9999, "en").seconds <= LONGEST_S
    with pytest.raises(SpeechError, match="no voice xx-none"):
        EspeakVoice().speak("hi", "xx-none")


def test_the_language_of_words() -> None:
    assert [language_of(text) for text in ("Стой", "stop", "", "ёж", "5 m")] == [
        *("ru", "en", "en", "ru", "en")
    ]


def test_another_rate_keeps_length_and_loudness() -> None:
    said = EspeakVoice().speak("robot forward", "en")
    for rate_hz in (8000, 16_000, 48_000):
        made = said.at(rate_hz)
        assert made.seconds == pytest.approx(said.seconds, abs=0.01)
        assert level_dbfs(made.pcm) == pytest.approx(level_dbfs(said.pcm), abs=1.0)


def test_a_sound_file_is_read_at_the_rate_that_is_wanted(tmp_path: Path) -> None:
    path, tone = tmp_path / "said.wav", noise(0.5, 3000.0)
    with wave.open(str(path), "wb") as file:
        file.setnchannels(2)
        file.setsampwidth(2)
        file.setframerate(48_000)
        file.writeframes(tone)
    assert read_sound(str(path), RATE_HZ).seconds == pytest.approx(len(tone) / 4 / 48_000, abs=0.01)
    path.write_bytes(wav_of(Sound(tone, RATE_HZ)))
    assert read_sound(str(path), RATE_HZ) == Sound(tone, RATE_HZ)
    path.write_bytes(b"RIFF")
    with pytest.raises(SpeechError, match="is not a sound file"):
        read_sound(str(path), RATE_HZ)


def test_the_smaller_of_a_models_files_is_taken(tmp_path: Path) -> None:
    for name in ("encoder.onnx", "encoder.int8.onnx", "tokens.txt"):
        (tmp_path / name).touch()
    assert one_file(tmp_path, "*encoder*.onnx") == str(tmp_path / "encoder.int8.onnx")
    assert one_file(tmp_path, "*joiner*.onnx") is None


def test_russian_needs_a_model_of_the_users_own() -> None:
    with pytest.raises(SpeechError, match="knows only English") as caught:
        recogniser("sphinx", "ru", "")
    assert "backend:=vosk" in caught.value.sentence
