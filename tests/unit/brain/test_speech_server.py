"""Speech by a server of models: what is sent to it, what comes back, and what goes wrong."""

from __future__ import annotations

import json
import threading
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING

import pytest

from brain.speech.faults import SpeechError
from brain.speech.recognisers import recogniser
from brain.speech.server import SPEECH_HZ, wav_of
from brain.speech.sound import Sound
from brain.speech.voices import voice
from robot.sound import RATE_HZ

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

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


def test_an_answer_is_spoken(monkeypatch: pytest.MonkeyPatch) -> None:
    with server(200, "audio/pcm", b"\x05\x06" * 2400 + b"\x07") as seen:
        monkeypatch.setenv("DECK_LLM_BASE_URL", seen.url)
        assert voice("server", "").speak("hello", "en") == Sound(b"\x05\x06" * 2400, SPEECH_HZ)
    ((path, _key, body),) = seen
    assert path == "/v1/audio/speech"
    assert json.loads(body)["input"] == "hello"


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


def test_nobody_there_and_no_settings(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DECK_LLM_BASE_URL", "http://127.0.0.1:9/v1")
    with pytest.raises(SpeechError):
        voice("server", "").speak("hello", "en")
    for name in ("BASE_URL", "MODEL", "KEY"):
        monkeypatch.delenv(f"DECK_LLM_{name}")
    with pytest.raises(SpeechError, match="no language model is set up"):
        voice("server", "")
