"""Starting the process that serves a model, hearing what it does, and ending it."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import json
import os
import re
import signal
import socket
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import brain
from brain.serving.model_file import ServingError
from text.os_words import os_reason
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable

    from typing_extensions import Self

    from brain.serving.server import Order

_PLACE = str(Path(brain.__file__).parent.parent)
_PROGRAM = """
import sys
sys.path[:] = [sys.argv[1], *filter(None, sys.path)]
from brain.serving.server import main
main(sys.argv[2])
"""
_LONGEST_LINE = 1 << 20
_END_WITHIN_S = 5.0
_ERROR = re.compile(r"[\d.]+ E\s+(?:\w+\s+)?\w+: (?:error loading model: )?(.+)")
"""`0.00.005.096 E llama_model_load: error loading model: unknown model architecture: 'x'`."""
_TIMING = re.compile(r"\| +(prompt eval|eval|total) time = +([\d.]+) ms / +(\d+) tokens")


@dataclass(frozen=True)
class ServedAnswer:
    """A request that was answered, or broken off."""

    read: int
    """Tokens of the question that it had not seen before."""
    written: int
    took_s: float
    writing_s: float

    @property
    def rate(self) -> float:
        """Return the tokens written a second, without the time it took to read."""
        return self.written / self.writing_s if self.writing_s > 0 else 0.0


def installed() -> bool:
    """Whether llama.cpp is there."""
    from importlib.util import find_spec

    return find_spec("xllamacpp") is not None


def require_port(host: str, port: int) -> None:
    """Raise a ServingError if nobody can listen there."""
    where = {"host": host, "port": port}
    try:
        family, kind, _protocol, _name, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        with socket.socket(family, kind) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(address)
            # Two sockets may be bound to a port, but only one can listen.
            probe.listen()
    except PermissionError:
        words = say("you may not use port {port}: choose one from 1024 up by --port", **where)
        raise ServingError(words) from None
    except (OSError, UnicodeError) as error:
        if isinstance(error, OSError) and error.errno == errno.EADDRINUSE:
            words = say("port {port} is in use: choose another by --port", **where)
        else:
            reason = os_reason(error)
            words = say("{host} is not an address of this machine: {reason}", reason=reason, **where)
        raise ServingError(words) from None


class Service:
    """A model being served; used in an `async with`, which ends it."""

    def __init__(
        self,
        order: Order,
        on_answer: Callable[[ServedAnswer], None] = lambda _: None,
        on_line: Callable[[str], None] = lambda _: None,
    ) -> None:
        """`on_line` gets each line of llama.cpp's log."""
        self._order, self._on_answer, self._on_line = order, on_answer, on_line
        self._process: asyncio.subprocess.Process | None = None
        self._log: asyncio.Task[None] | None = None
        self._timing: dict[str, tuple[float, int]] = {}
        self._reason = ""

    async def __aenter__(self) -> Self:
        self._process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-c", _PROGRAM, _PLACE, json.dumps(asdict(self._order))),
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.PIPE,
            limit=_LONGEST_LINE,
            # When it aborts, it would have a debugger look at it.
            env={**os.environ, "GGML_NO_BACKTRACE": "1"},
        )
        self._log = asyncio.create_task(self._listen())
        return self

    async def __aexit__(self, *_: object) -> None:
        assert self._process is not None
        assert self._log is not None
        with contextlib.suppress(ProcessLookupError):
            self._process.terminate()
        try:
            await asyncio.wait_for(self._process.wait(), _END_WITHIN_S)
        except asyncio.TimeoutError:
            with contextlib.suppress(ProcessLookupError):
                self._process.kill()
            await self._process.wait()
        await self._log

    async def ready(self) -> str:
        """Return its address, once it can be asked.

        Raises:
            ServingError: if llama.cpp does not want the file, or ends by it.
        """
        assert self._process is not None
        assert self._process.stdout is not None
        address = (await self._process.stdout.readline()).decode().strip()
        if not address:
            raise await self.end()
        return address

    async def end(self) -> ServingError:
        """Wait until it ends by itself; return why it did."""
        assert self._process is not None
        assert self._log is not None
        code = await self._process.wait()
        await self._log
        path = self._order.path
        if code == -signal.SIGKILL:
            words = say(
                "llama.cpp was killed, most likely for want of memory: take a smaller model, or a smaller --context"
            )
        elif self._reason:
            words = say(
                "llama.cpp cannot use {path} ({reason}): download it again, or take another model",
                path=path,
                reason=self._reason,
            )
        elif code < 0:
            how = signal.Signals(-code).name
            words = say("llama.cpp has broken off with {path}: {reason}", path=path, reason=how)
        else:
            words = say("llama.cpp cannot use {path}: --verbose shows its log", path=path)
        return ServingError(words)

    async def _listen(self) -> None:
        assert self._process is not None
        assert self._process.stderr is not None
        while True:
            try:
                line = await self._process.stderr.readline()
            except ValueError:
                # Longer than anybody reads: what follows are its other pieces.
                continue
            if not line:
                return
            self._hear(line.decode("utf-8", "replace").rstrip("\n"))

    def _hear(self, line: str) -> None:
        self._on_line(line)
        if (error := _ERROR.match(line)) and not self._reason:
            self._reason = error[1]
        if timing := _TIMING.search(line):
            self._timing[timing[1]] = float(timing[2]) / 1000, int(timing[3])
            if timing[1] == "total":
                self._tell()

    def _tell(self) -> None:
        (_reading_s, read) = self._timing.get("prompt eval", (0.0, 0))
        (writing_s, written) = self._timing.get("eval", (0.0, 0))
        took_s = self._timing["total"][0]
        self._timing.clear()
        self._on_answer(ServedAnswer(read, written, took_s, writing_s))
