"""Hearing and speaking: what is cut out, recognised and said, here or by a server."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import numpy as np
import pytest

from brain.speech.espeak import EspeakVoice
from brain.speech.faults import SpeechError
from brain.speech.recognisers import recogniser
from brain.speech.server import wav_of
from brain.speech.sound import Sound
from brain.speech.sphinx import SphinxRecogniser
from brain.speech.utterances import CLOSING_S, Utterances
from robot.sound import RATE_HZ

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


KEY = "sk-test-77aa"
SAID = Sound(b"\x01\x02" * 4000, RATE_HZ)


class Requests(list[tuple[str, str, bytes]]):
    """Path, Authorization and body of each."""

    url = ""


@contextmanager
def server(status: int, kind: str, answer: bytes) -> Iterator[Requests]:
    seen = Requests()

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            body = self.rfile.read(int(self.headers["Content-Length"]))
            seen.append((self.path, self.headers["Authorization"], body))
            self.send_response(status)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(answer)))
            self.end_headers()
            self.wfile.write(answer)

        def log_message(self, *_: object) -> None:
            pass

    http = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=http.serve_forever, args=(0.02,))
    thread.start()
    seen.url = f"http://127.0.0.1:{http.server_port}/v1"
    try:
        yield seen
    finally:
        http.shutdown()
        http.server_close()
        thread.join()


@pytest.fixture(autouse=True)
def _settings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    monkeypatch.setenv("DECK_LLM_MODEL", "m-1")
    monkeypatch.setenv("DECK_LLM_KEY", KEY)


def test_an_utterance_is_transcribed(monkeypatch: pytest.MonkeyPatch) -> None:
    with server(200, "application/json", b'{"text": " robot forward "}') as seen:
        monkeypatch.setenv("DECK_LLM_BASE_URL", seen.url)
        ears = recogniser("server", "en", "")
        assert ears.transcribe(SAID) == "robot forward"
        assert ears.transcribe(SAID) == "robot forward"
    (path, key, body), _again = seen
    assert path == "/v1/audio/transcriptions"
    assert key == f"Bearer {KEY}"
    assert wav_of(SAID) in body
    assert b"whisper-1" in body


@pytest.mark.parametrize(
    ("status", "answer"),
    [
        (401, {"error": {"message": f"bad key {KEY}"}}),
        (404, {"error": {"message": "no such model"}}),
        (429, {"error": {"message": "slow down"}}),
        (500, {"error": {"message": "oh"}}),
        (200, [1, 2]),
    ],
)
def test_a_server_that_fails_is_told_without_the_key(
    status: int, answer: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    with server(status, "application/json", json.dumps(answer).encode()) as seen:
        monkeypatch.setenv("DECK_LLM_BASE_URL", seen.url)
        with pytest.raises(SpeechError) as caught:
            recogniser("server", "en", "").transcribe(SAID)
    assert str(caught.value.sentence)
    assert KEY not in caught.value.sentence
