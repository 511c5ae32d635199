"""An examination: the process in which one folder is judged, and the end of all that it starts."""

from __future__ import annotations

import asyncio
import contextlib
import os
import socket
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import course
from course.grade.environment import environment_of
from course.grade.leftovers import end_adopted, end_marked, kill_descendants
from course.grade.limits import taken
from course.grade.protocol import MOST_BYTES
from course.proof.places import Places
from text.nested import read_json
from text.packing import unpack_text
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, AsyncIterator, Mapping, Sequence

    from course.grade.protocol import ExamRequest

EXAMINER = (sys.executable, "-m", "course.grade")
GRACE_S = 15.0
"""How much longer an examiner may take than its nodes."""
ENDED_WITHIN_S = 15.0
"""The guardian's own time for ending what is left, and a little more."""
LOOK_EVERY_S = 0.25


class Examiners:
    """The examiners at work, all of them children of this process."""

    def __init__(self) -> None:
        self._pids: set[int] = set()
        self._starting = asyncio.Lock()
        """Held while there is a child that is not yet known to be an examiner."""

    async def start(
        self, command: Sequence[str], channel: socket.socket, log: Path, environ: Mapping[str, str]
    ) -> asyncio.subprocess.Process:
        """Start one by this command; it talks on this channel."""
        async with self._starting:
            with log.open("wb") as words:
                process = await asyncio.create_subprocess_exec(
                    *(*command, str(channel.fileno())),
                    # In that folder `course` is this package, whatever the user's contains.
                    cwd=Path(course.__file__).parent.parent,
                    stdin=asyncio.subprocess.DEVNULL,
                    stdout=words,
                    stderr=words,
                    env=environ,
                    pass_fds=(channel.fileno(),),
                    # Ctrl-C in the terminal is meant for its grader.
                    start_new_session=True,
                )
            self._pids.add(process.pid)
        return process

    def ended(self, pid: int) -> None:
        self._pids.discard(pid)

    async def end_adopted(self) -> None:
        """End all other children of this process."""
        async with self._starting:
            await asyncio.to_thread(end_adopted, frozenset(self._pids))


class Examination:
    """One examiner, from start to end, with all that it leaves behind."""

    def __init__(self, place: Path, request: ExamRequest, examiners: Examiners, command: Sequence[str]) -> None:
        """`command`: EXAMINER, or what runs it behind walls."""
        self.reason = ""
        """Why it did not come to its end; empty if it did."""
        self.taken = False
        """Whether somebody else was in the domain."""
        self._place = place
        self._request = request
        self._examiners = examiners
        self._command = command
        self._ended = False

    async def events(self) -> AsyncGenerator[dict[str, Any], None]:
        """Yield what it tells; afterwards nothing of it is left."""
        ours, theirs = socket.socketpair()
        words = self._place / "examiner.log"
        environ = environment_of(self._place, os.environ)
        process = await self._examiners.start(self._command, theirs, words, environ)
        theirs.close()
        reader, writer = await asyncio.open_connection(sock=ours, limit=MOST_BYTES)
        watching = asyncio.ensure_future(self._watch(process))
        try:
            writer.write(self._request.to_json().encode() + b"\n")
            async for event in self._heard(reader):
                yield event
        finally:
            watching.cancel()
            writer.close()
            await asyncio.shield(asyncio.ensure_future(self._end(process)))
        if not self._ended and not self.reason:
            self.reason = say("the judge was ended before it was done; killed by what it judged, perhaps")

    async def _heard(self, reader: asyncio.StreamReader) -> AsyncIterator[dict[str, Any]]:
        while not self._ended:
            try:
                line = await reader.readline()
                event = read_json(line)
            except (OSError, ValueError):
                return
            if event["event"] == "end":
                self._ended = True
                self.reason = self.reason or unpack_text(event["reason"])
                self.taken = event["taken"]
            else:
                yield event

    async def _watch(self, process: asyncio.subprocess.Process) -> None:
        """End it when it takes too much of anything."""
        deadline_s = time.monotonic() + self._request.within_s + GRACE_S
        places = Places(self._place, Path(self._request.lesson).name).writable
        while process.returncode is None:
            await asyncio.sleep(LOOK_EVERY_S)
            excess = (await asyncio.to_thread(taken, process.pid, places)).excess()
            if time.monotonic() > deadline_s:
                excess = say("it took longer than {n:g} s", n=self._request.within_s)
            if excess:
                self.reason = excess
                await asyncio.to_thread(kill_descendants, process.pid)
                return

    async def _end(self, process: asyncio.subprocess.Process) -> None:
        """Return when it and all that it started is gone."""
        with contextlib.suppress(asyncio.TimeoutError):
            await asyncio.wait_for(process.wait(), ENDED_WITHIN_S)
        if process.returncode is None:
            await asyncio.to_thread(kill_descendants, process.pid)
            process.kill()
            await process.wait()
        self._examiners.ended(process.pid)
        await asyncio.to_thread(end_marked, str(self._place / "run"))
