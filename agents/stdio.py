"""MCP over standard input and output: one agent, which has started `deck mcp`.

Standard output is the protocol, so everything else that writes there, above all Fast DDS, is turned
to standard error first. Input is read on a thread of its own: a read that waits must not keep the
program from ending.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import queue
import threading
from typing import TYPE_CHECKING, Any, cast

from mcp.server.stdio import stdio_server

if TYPE_CHECKING:
    from agents.server import AgentServer

LONGEST_LINE = 4 << 20
_READ = 1 << 16


async def serve_stdio(server: AgentServer, source: int, sink: int) -> None:
    """Serve the agent at these descriptors until it closes its end."""
    lines, out = _Lines(source), _Out(sink)
    async with server.looking():
        # The SDK takes anything that reads and writes like a file of anyio.
        streams = stdio_server(cast("Any", lines), cast("Any", out))
        async with streams as (reading, writing):
            await server.mcp.run(reading, writing, server.mcp.create_initialization_options())


def take_standard_streams() -> tuple[int, int]:
    """Return private descriptors of standard input and output; the public ones lead elsewhere."""
    source, sink = os.dup(0), os.dup(1)
    nowhere = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nowhere, 0)
    os.close(nowhere)
    with contextlib.suppress(OSError):  # There may be no standard error.
        os.dup2(2, 1)
    return source, sink


class _Lines:
    """The lines of a descriptor, read by a thread."""

    def __init__(self, source: int) -> None:
        self._source = source
        self._loop = asyncio.get_running_loop()
        self._queue: asyncio.Queue[str | None] = asyncio.Queue()
        threading.Thread(target=self._read, name="mcp-input", daemon=True).start()

    def __aiter__(self) -> _Lines:
        return self

    async def __anext__(self) -> str:
        line = await self._queue.get()
        if line is None:
            raise StopAsyncIteration
        return line

    def _read(self) -> None:
        rest = b""
        # The loop may be closed while this waits for input.
        with contextlib.suppress(OSError, RuntimeError):
            while data := os.read(self._source, _READ):
                *whole, rest = (rest + data).split(b"\n")
                for line in whole:
                    self._put(line.decode(errors="replace"))
                if len(rest) > LONGEST_LINE:
                    break
        with contextlib.suppress(RuntimeError):
            self._put(None)

    def _put(self, line: str | None) -> None:
        self._loop.call_soon_threadsafe(self._queue.put_nowait, line)


class _Out:
    """Writes to a descriptor on a thread: whoever reads it may be slow, or not read at all."""

    def __init__(self, sink: int) -> None:
        self._sink = sink
        self._loop = asyncio.get_running_loop()
        self._queue: queue.SimpleQueue[tuple[bytes, asyncio.Event]] = queue.SimpleQueue()
        threading.Thread(target=self._write_all, name="mcp-output", daemon=True).start()

    async def write(self, text: str) -> None:
        written = asyncio.Event()
        self._queue.put((text.encode(errors="backslashreplace"), written))
        await written.wait()

    async def flush(self) -> None:
        """Do nothing: nothing is kept back."""

    def _write_all(self) -> None:
        # The loop may be closed while this waits for the reader.
        with contextlib.suppress(RuntimeError):
            while True:
                data, written = self._queue.get()
                with contextlib.suppress(OSError):
                    while data:
                        data = data[os.write(self._sink, data) :]
                self._loop.call_soon_threadsafe(written.set)
