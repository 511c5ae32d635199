"""Speech by the server of models in llm.yaml: `/v1/audio/transcriptions` and `/v1/audio/speech`.

Protocol: https://platform.openai.com/docs/api-reference/audio. Each utterance leaves this machine;
nothing else of the microphone does.
"""

from __future__ import annotations

import asyncio
import io
import os
import time
import wave
from typing import TYPE_CHECKING, Any

import anyio

from brain.budget import Ledger, TokenUsage, estimated_tokens
from brain.faults import FaultKind, ModelError
from brain.key import key_of
from brain.settings import required
from brain.speech.espeak import LONGEST_TEXT
from brain.speech.faults import SpeechError
from brain.speech.sound import Sound
from text.run_path import run_folder
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    import openai

SPEECH_HZ = 24_000
"""Rate of the protocol's raw PCM."""
LONGEST_WORDS = 1000
"""Characters of a transcript that are read."""


class _Server:
    """Asks the server, one request at a time.

    Raises:
        SpeechError: there are no settings, or they cannot be used.
    """

    def __init__(self, who: str) -> None:
        try:
            settings = required()
            self._key = key_of(settings)
        except ModelError as error:
            raise SpeechError(error.words, error.fix) from None
        self.settings, self._who = settings, who
        self._ledger = Ledger(run_folder(os.environ))

    def ask(self, model: str, text: str, request: Callable[[openai.AsyncOpenAI], Awaitable[Any]]) -> Any:  # noqa: ANN401 - what the request returns
        """Send a request; raises SpeechError."""
        try:
            self._ledger.begin(self._who, self.settings.budget)
            begun_s = time.monotonic()
            answer = asyncio.run(self._send(request))
        except ModelError as error:
            raise SpeechError(error.words, error.fix) from None
        took_s = time.monotonic() - begun_s
        usage = TokenUsage(model, estimated_tokens(text), 0, took_s, took_s, counted=False)
        self._ledger.end(self._who, usage)
        return answer

    async def _send(self, request: Callable[[openai.AsyncOpenAI], Awaitable[Any]]) -> Any:  # noqa: ANN401
        import httpx2
        import openai

        from brain.bounds import bounded_client
        from brain.client_faults import fault_of

        client = bounded_client(self.settings, self._key)
        try:
            with anyio.fail_after(self.settings.timeout_s):
                return await request(client)
        except ModelError:
            raise
        except Exception as error:
            late = openai.APITimeoutError if isinstance(error, TimeoutError) else None
            fault = fault_of(
                late(request=httpx2.Request("POST", self.settings.base_url)) if late else error,
                self.settings,
                self._key,
            )
            if fault is None:
                raise
            # Not `from error`: its text and its request hold what must not be shown.
            raise fault from None
        finally:
            await client.close()


class ServerRecogniser:
    """Has utterances transcribed by the server; raises SpeechError without settings."""

    def __init__(self, language: str) -> None:
        self._server, self._language = _Server("hearing"), language

    def transcribe(self, said: Sound) -> str:
        """Return the words, empty if there are none."""
        model = self._server.settings.transcription_model

        async def request(client: openai.AsyncOpenAI) -> str:
            answer = await client.audio.transcriptions.create(
                file=("said.wav", wav_of(said), "audio/wav"),
                model=model,
                language=self._language,
                response_format="json",
            )
            text = getattr(answer, "text", None)
            if not isinstance(text, str):
                # Whatever else it is, the client takes it for an answer.
                raise ModelError(FaultKind.NOT_AN_API, say("what the server sent cannot be read"))
            return text

        return str(self._server.ask(model, "", request)).strip()[:LONGEST_WORDS]


class ServerVoice:
    """Has text spoken by the server; raises SpeechError without settings."""

    def __init__(self) -> None:
        self._server = _Server("speaking")

    def speak(self, text: str, _language: str) -> Sound:
        """Return the spoken text, cut to `LONGEST_TEXT`."""
        settings, text = self._server.settings, text[:LONGEST_TEXT]

        async def request(client: openai.AsyncOpenAI) -> bytes:
            answer = await client.audio.speech.create(
                input=text, model=settings.speech_model, voice=settings.speech_voice, response_format="pcm"
            )
            return answer.content

        pcm = bytes(self._server.ask(settings.speech_model, text, request))
        return Sound(pcm[: len(pcm) // 2 * 2], SPEECH_HZ)


def wav_of(sound: Sound) -> bytes:
    """Return the sound as a WAV file."""
    file = io.BytesIO()
    with wave.open(file, "wb") as to:
        to.setnchannels(1)
        to.setsampwidth(2)
        to.setframerate(sound.rate_hz)
        to.writeframes(sound.pcm)
    return file.getvalue()
