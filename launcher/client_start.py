"""Starting a supervisor: a process in a session of its own, which gets its plan on stdin."""

from __future__ import annotations

import asyncio
import json
import os
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import launcher
from launcher.control_protocol import unpack_session
from launcher.errors import AlreadyRunningError, StartError
from launcher.words import say

if TYPE_CHECKING:
    from launcher.supervisor_plan import Plan

ANSWER_WITHIN_S = 30.0


class StartingSupervisor:
    """A supervisor that waits for its plan; it ends if this object lets go of it."""

    def __init__(self) -> None:
        """Start it."""
        self._words: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 - closed in `begin`
        self._process = subprocess.Popen(
            [sys.executable, "-m", "launcher.supervisor"],
            # There `launcher` is this package, whatever the user's folder has of that name.
            cwd=Path(launcher.__file__).parent.parent,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._words,
            start_new_session=True,
        )
        # It is collected when it ends, however long that takes.
        threading.Thread(target=self._process.wait, name="supervisor", daemon=True).start()

    def give_up(self) -> None:
        """Let it end without having started anything."""
        self._words.close()
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                stream.close()

    async def begin(self, plan: Plan) -> tuple[Path, int]:
        """Give it the plan.

        Returns:
            The folder of the run, and the descriptor that keeps a session in the foreground
            alive: its end is the session's.

        Raises:
            AlreadyRunningError: if the profile runs in that domain already.
            StartError: if it ended before it answered.
        """
        process = self._process
        assert process.stdin is not None
        try:
            try:
                await asyncio.to_thread(_write_plan, process.stdin, plan)
                answer = await asyncio.wait_for(self._answer(), ANSWER_WITHIN_S)
            except (OSError, ValueError, asyncio.TimeoutError) as problem:
                raise StartError(self._last_words()) from problem
            if "running" in answer:
                raise AlreadyRunningError(unpack_session(answer["running"]))
            return Path(answer["folder"]), os.dup(process.stdin.fileno())
        finally:
            self.give_up()

    async def _answer(self) -> dict[str, Any]:
        reader = asyncio.StreamReader()
        transport, _protocol = await asyncio.get_running_loop().connect_read_pipe(
            lambda: asyncio.StreamReaderProtocol(reader), self._process.stdout
        )
        try:
            answer: dict[str, Any] = json.loads(await reader.readline())
        finally:
            transport.close()
        return answer

    def _last_words(self) -> str:
        self._words.seek(0)
        lines = self._words.read().decode(errors="replace").strip().splitlines()
        if not lines:
            return say("the supervisor ended without a word")
        return say("the supervisor ended: {words}", words=lines[-1])


def _write_plan(stdin: IO[bytes], plan: Plan) -> None:
    stdin.write(plan.to_json().encode() + b"\n")
    stdin.flush()
