"""A talk by voice with a model that hears and speaks itself: OpenAI's Realtime protocol.

Sound goes up and comes down over one WebSocket; the server hears when somebody begins and ends to
speak, and breaks its answer off when interrupted. What the model wants done comes as the call of a
function, is checked here, and is answered by what became of it.
Protocol: https://platform.openai.com/docs/guides/realtime-websocket.
"""

from __future__ import annotations

import asyncio
import base64
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import openai
import websockets.exceptions

from brain.bounds import bounded_client
from brain.budget import TokenUsage
from brain.client_faults import fault_of, of_status, words_of
from brain.faults import FaultKind, ModelError
from robot.commands.brain import asks_to_stop
from robot.commands.problems import CommandError
from robot.commands.schema import LlmResponse, parse_llm
from text.sentences import say

if TYPE_CHECKING:
    from brain.budget import Ledger
    from brain.key import ServerKey
    from brain.settings import ModelSettings

RATE_HZ = 24_000
"""Of the sound both ways: 16-bit little-endian samples, one channel."""
ACT, SENSE = "act", "sense"
"""The functions that the model can call."""
_WAITING = 50
"""Blocks of sound that may wait for the connection; beyond that the oldest is dropped."""
_LONGEST_EVENT = 4 << 20
"""Bytes of an event; of packed ones, which are not asked for, a few would make many."""
_MOST_EVENTS = 8
"""Events that may wait: sound comes in blocks of a few kilobytes."""
_STOPPED = "not done: wait until somebody speaks"


@dataclass(frozen=True)
class TalkHandlers:
    """What is called as things come, on the thread of the connection."""

    sound: Callable[[bytes], None]
    """The next PCM bytes of the model's voice."""
    interrupted: Callable[[], None]
    """Somebody speaks: what is still to be played is to be dropped."""
    heard: Callable[[str], None]
    """What somebody said, as the server understood it."""
    said: Callable[[str], None]
    """What the model says, in words."""
    act: Callable[[LlmResponse], None]
    """Commands that were checked."""
    refused: Callable[[str], None]
    """What was wrong with commands that were not."""
    sense: Callable[[], str]
    """Returns what the senses say now."""
    used: Callable[[TokenUsage], None]


class RealtimeTalk:
    """One connection; `run` it until it ends."""

    def __init__(
        self,
        settings: ModelSettings,
        key: ServerKey,
        ledger: Ledger,
        who: str,
        instructions: str,
        handlers: TalkHandlers,
    ) -> None:
        """`instructions` is the system prompt; `who` stands in the ledger."""
        self._settings, self._key = settings, key
        self._ledger, self._who = ledger, who
        self._instructions, self._handlers = instructions, handlers
        self._sound: asyncio.Queue[bytes] = asyncio.Queue(_WAITING)
        self._connection: Any = None
        self._stopped = True
        """Whether nobody has spoken since the beginning, or since a stop."""
        self._done: set[str] = set()
        """Calls that were carried out: none is twice."""
        self._asked_s = self._first_s = 0.0

    def hear(self, pcm: bytes) -> None:
        """Send sound of the microphone, at `RATE_HZ`; on the connection's thread."""
        if self._sound.full():
            self._sound.get_nowait()
        self._sound.put_nowait(pcm)

    async def tell(self, words: str) -> None:
        """Say something in writing, as if it had been spoken."""
        self._stopped = False
        if self._connection is None:
            return
        content = [{"type": "input_text", "text": words}]
        item = {"type": "message", "role": "user", "content": content}
        await self._send({"type": "conversation.item.create", "item": item})
        await self._send({"type": "response.create"})

    async def stop(self) -> None:
        """Break the model's answer off; until somebody speaks, it can do nothing.

        The words for stop do so, as soon as the server has understood them.
        """
        self._stopped = True
        self._handlers.interrupted()
        if self._connection is not None:
            await self._send({"type": "response.cancel"})

    async def run(self) -> None:
        """Talk until the connection ends.

        Raises:
            ModelError: it always ends with one, unless it is cancelled.
        """
        client = bounded_client(self._settings, self._key)
        try:
            await self._talk(client)
        except ModelError:
            raise
        except Exception as error:  # noqa: BLE001 - told in words, or raised again
            raise self._fault(error) from None
        finally:
            self._connection = None
            await client.close()
        raise ModelError(FaultKind.CUT, say("the server ended the talk"))

    async def _talk(self, client: openai.AsyncOpenAI) -> None:
        async with client.realtime.connect(
            model=self._settings.realtime_model,
            websocket_connection_options={"max_size": _LONGEST_EVENT, "max_queue": _MOST_EVENTS, "compression": None},
        ) as self._connection:
            await self._send({"type": "session.update", "session": self._session()})
            sending = asyncio.create_task(self._send_sound())
            try:
                async for event in self._connection:
                    await self._take(event)
            finally:
                sending.cancel()

    def _fault(self, error: Exception) -> ModelError:
        if isinstance(error, websockets.exceptions.InvalidStatus):
            response = error.response
            said = words_of(response.body.decode("utf-8", "replace"), self._key)
            retry_after = response.headers.get("retry-after", "")
            return of_status(response.status_code, said, retry_after, self._settings)
        if isinstance(error, websockets.exceptions.ConnectionClosed):
            return ModelError(FaultKind.CUT, say("the connection of the talk was lost"))
        known = fault_of(error, self._settings, self._key)
        if known is not None:
            return known
        if isinstance(error, OSError | websockets.exceptions.WebSocketException):
            words = say("nobody answers at {url}", url=self._settings.base_url)
            fix = say("start the server, or correct base_url in llm.yaml")
            return ModelError(FaultKind.UNREACHABLE, words, fix)
        raise error

    def _session(self) -> dict[str, Any]:
        form = {"type": "audio/pcm", "rate": RATE_HZ}
        turns = {"type": "server_vad", "create_response": True, "interrupt_response": True}
        heard = {"model": self._settings.transcription_model}
        return {
            "type": "realtime",
            "instructions": self._instructions,
            "output_modalities": ["audio"],
            "audio": {
                "input": {"format": form, "turn_detection": turns, "transcription": heard},
                "output": {"format": form, "voice": self._settings.speech_voice},
            },
            "tools": [
                _function(ACT, "Has the robot do something.", LlmResponse.model_json_schema()),
                _function(SENSE, "Tells what the robot's sensors say now.", _NOTHING),
            ],
            "tool_choice": "auto",
        }

    async def _send_sound(self) -> None:
        while True:
            pcm = await self._sound.get()
            audio = base64.b64encode(pcm).decode()
            await self._send({"type": "input_audio_buffer.append", "audio": audio})

    async def _send(self, event: dict[str, Any]) -> None:
        await self._connection.send(event)

    # ---------------------------------------------------------------- what the server sends

    async def _take(self, event: Any) -> None:  # noqa: ANN401 - a server may send anything
        kind = _part(event, "type")
        if kind == "response.output_audio.delta":
            self._first_s = self._first_s or time.monotonic()
            self._play(_part(event, "delta"))
        elif kind == "input_audio_buffer.speech_started":
            self._stopped = False
            self._handlers.interrupted()
        elif kind == "conversation.item.input_audio_transcription.completed":
            self._handlers.heard(str(_part(event, "transcript")))
            if asks_to_stop(str(_part(event, "transcript"))):
                await self.stop()
        elif kind == "response.output_audio_transcript.done":
            self._handlers.said(str(_part(event, "transcript")))
        elif kind == "response.function_call_arguments.done":
            await self._call(str(_part(event, "name")), str(_part(event, "call_id")), str(_part(event, "arguments")))
        elif kind == "response.created":
            self._asked_s, self._first_s = time.monotonic(), 0.0
            self._ledger.begin(self._who, self._settings.budget)
        elif kind == "response.done":
            self._count(_part(event, "response"))
        elif kind == "error":
            words = words_of(str(_part(_part(event, "error"), "message")), self._key)
            raise ModelError(FaultKind.SERVER, say("the server broke off: {words}", words=words))

    def _play(self, delta: str) -> None:
        try:
            sound = base64.b64decode(delta, validate=True)
        except (TypeError, ValueError):
            raise _unreadable() from None
        self._handlers.sound(sound)

    async def _call(self, name: str, call: str, arguments: str) -> None:
        if call in self._done:
            return
        self._done.add(call)
        output = self._handlers.sense() if name == SENSE else self._acted(name, arguments)
        item = {"type": "function_call_output", "call_id": call, "output": output}
        await self._send({"type": "conversation.item.create", "item": item})
        await self._send({"type": "response.create"})

    def _acted(self, name: str, arguments: str) -> str:
        """Do what was asked, or not; return what to tell the model."""
        if name != ACT:
            return f"there is no function {name[:40]}"
        if self._stopped:
            return _STOPPED
        try:
            response = parse_llm(arguments)
        except CommandError as error:
            self._handlers.refused(str(error))
            return f"refused, nothing was done: {error}"
        self._handlers.act(response)
        return "accepted"

    def _count(self, response: Any) -> None:  # noqa: ANN401 - a server may send anything
        usage, now_s = _part(response, "usage"), time.monotonic()
        taken = (_count_in(usage, "input_tokens"), _count_in(usage, "output_tokens"))
        first_s = (self._first_s or now_s) - self._asked_s
        used = TokenUsage(self._settings.realtime_model, *taken, first_s, now_s - self._asked_s, bool(usage))
        self._ledger.end(self._who, used)
        self._handlers.used(used)
        if getattr(response, "status", "") == "failed":
            details = getattr(response, "status_details", None)
            message = getattr(getattr(details, "error", None), "message", "") or "-"
            words = words_of(str(message), self._key)
            raise ModelError(FaultKind.SERVER, say("the server broke off: {words}", words=words))


_NOTHING = {"type": "object", "properties": {}, "required": [], "additionalProperties": False}


def _part(event: Any, name: str) -> Any:  # noqa: ANN401 - a server may send anything
    """Return a part of an event, which the client has not checked."""
    try:
        return getattr(event, name)
    except AttributeError:
        raise _unreadable() from None


def _count_in(usage: object, name: str) -> int:
    found = getattr(usage, name, None)
    return found if isinstance(found, int) else 0


def _unreadable() -> ModelError:
    return ModelError(FaultKind.NOT_AN_API, say("what the server sent cannot be read"))


def _function(name: str, about: str, schema: dict[str, Any]) -> dict[str, Any]:
    return {"type": "function", "name": name, "description": about, "parameters": schema}
