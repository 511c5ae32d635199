"""A server that speaks the published Realtime protocol, on a real WebSocket, as a test wants."""

from __future__ import annotations

import asyncio
import base64
import json
import threading
from typing import TYPE_CHECKING, Any

from websockets.asyncio.server import serve
from websockets.exceptions import ConnectionClosed

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable
    from http import HTTPStatus

    from typing_extensions import Self
    from websockets.asyncio.server import ServerConnection
    from websockets.http11 import Request, Response


class Talk:
    """One connection, as the server sees it."""

    def __init__(self, connection: ServerConnection) -> None:
        self._connection = connection
        self.received: list[dict[str, Any]] = []
        """The client's events."""
        request = connection.request
        assert request is not None
        self.path = request.path
        self.headers = {name.lower(): value for name, value in request.headers.items()}

    async def send(self, kind: str, **fields: Any) -> None:
        event = {"type": kind, "event_id": "e", **fields}
        await self.text(json.dumps(event))

    async def text(self, text: str) -> None:
        await self._connection.send(text)

    async def says(self, *sounds: bytes, words: str = "") -> None:
        await self.begins()
        for sound in sounds:
            delta = base64.b64encode(sound).decode()
            await self.send("response.output_audio.delta", delta=delta, **_PART)
        if words:
            await self.send("response.output_audio_transcript.done", transcript=words, **_PART)
        await self.ends()

    async def calls(self, name: str, arguments: str, call: str = "call-1") -> None:
        await self.begins()
        kind = "response.function_call_arguments.done"
        await self.send(kind, name=name, arguments=arguments, call_id=call, **_PART)
        await self.ends()

    async def begins(self) -> None:
        await self.send("response.created", response={"id": "r", "object": "realtime.response"})

    async def ends(self, **fields: Any) -> None:
        usage = {"input_tokens": 200, "output_tokens": 30, "total_tokens": 230}
        response = {"id": "r", "object": "realtime.response", "status": "completed"}
        await self.send("response.done", response={**response, "usage": usage, **fields})

    async def hears(self, words: str) -> None:
        """Notice that somebody spoke, and understand it."""
        await self.send("input_audio_buffer.speech_started", audio_start_ms=0, item_id="i")
        await self.send("input_audio_buffer.speech_stopped", audio_end_ms=9, item_id="i")
        kind = "conversation.item.input_audio_transcription.completed"
        await self.send(kind, transcript=words, item_id="i", content_index=0, usage={})

    async def got(self, kind: str, count: int = 1) -> list[dict[str, Any]]:
        """Receive until so many events of this kind have come; return these."""
        while len(found := self.those(kind)) < count:
            self.received.append(json.loads(await self._connection.recv()))
        return found

    def those(self, kind: str) -> list[dict[str, Any]]:
        """Return the events of this kind that have come."""
        return [event for event in self.received if event["type"] == kind]

    async def hang_up(self) -> None:
        """End the connection in the middle of everything."""
        await self._connection.close(1011, "down for maintenance")


_PART = {"response_id": "r", "item_id": "i", "output_index": 0, "content_index": 0}


class RealtimeServer:
    """The server, on a thread with a loop of its own; use it in a `with`."""

    def __init__(self, script: Callable[[Talk], Awaitable[None]]) -> None:
        self.script = script
        """Leads each connection; it stays open after its end."""
        self.talks: list[Talk] = []
        self.refuse: HTTPStatus | None = None
        """Answer the handshake with this status."""
        self.port = 0
        self._loop = asyncio.new_event_loop()
        self._ready, self._end = threading.Event(), asyncio.Event()
        self._thread = threading.Thread(target=self._live)

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}/v1"

    def run(self, step: Awaitable[Any]) -> Any:
        """Carry out a step on the server's loop, from the test's thread."""

        async def awaited() -> Any:
            return await step

        return asyncio.run_coroutine_threadsafe(awaited(), self._loop).result(20)

    def __enter__(self) -> Self:
        self._thread.start()
        assert self._ready.wait(20)
        return self

    def __exit__(self, *_: object) -> None:
        self._loop.call_soon_threadsafe(self._end.set)
        self._thread.join()

    def _live(self) -> None:
        self._loop.run_until_complete(self._serve())
        self._loop.close()

    async def _serve(self) -> None:
        async with serve(self._lead, "127.0.0.1", 0, process_request=self._greet, close_timeout=1) as server:
            self.port = next(iter(server.sockets)).getsockname()[1]
            self._ready.set()
            await self._end.wait()

    def _greet(self, connection: ServerConnection, request: Request) -> Response | None:
        del request
        return None if self.refuse is None else connection.respond(self.refuse, "no\n")

    async def _lead(self, connection: ServerConnection) -> None:
        talk = Talk(connection)
        self.talks.append(talk)
        try:
            await self.script(talk)
            await connection.wait_closed()
        except ConnectionClosed:
            pass
