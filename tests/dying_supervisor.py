"""The supervisor's side of the control socket, by one that dies when a test says so."""

from __future__ import annotations

import asyncio
import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from launcher.control.socket import listen
from launcher.events import Hello
from launcher.status import NodeState, NodeStatus, SessionInfo
from launcher.wire import encode, pack

HELLO = encode(
    pack(Hello(SessionInfo("run-1", "/p/02.yaml", "02-sonar-safety"), (NodeStatus("sonar", "x", NodeState.READY),)))
)


@dataclass
class DyingSupervisor:
    """Does as much as it is told to, and dies."""

    folder: Path
    says: bytes = HELLO
    """Before it waits for a request."""
    last_words: bytes = b""
    """In answer to the request on which it dies."""
    dies_on: str | None = None
    """The request on which it dies; None: it dies as soon as it is greeted."""
    replies: dict[str, dict[str, Any]] = field(default_factory=lambda: {"history": {"result": []}})
    """To the requests before."""
    server: asyncio.AbstractServer | None = None

    async def serve(self) -> None:
        self.server = await asyncio.start_unix_server(self._welcome, sock=listen(self.folder))

    async def _welcome(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        writer.write(self.says)
        await reader.readline()
        while self.dies_on is not None:
            request = json.loads(await reader.readline())
            if request["op"] == self.dies_on:
                break
            reply = self.replies.get(request["op"], {"result": None})
            writer.write(encode({"reply": request["id"], **reply}))
        writer.write(self.last_words)
        writer.close()

    def stop(self) -> None:
        """Accept no more."""
        if self.server is not None:
            self.server.close()
