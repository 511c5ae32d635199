"""Starting a supervisor: a process in its own session, which reads its plan from stdin.

It begins importing the modules that nodes need before it has a plan, so it pays to start one as
soon as it is clear that something will be run, and to read the profile in the meantime. That is why
this module itself imports little.
"""

from __future__ import annotations

import contextlib
import os
import select
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any

import launcher
from launcher.processes.prctl import ROOM_ARGUMENT, room_for_marks
from launcher.processes.signal import send
from launcher.processes.table import processes
from text.nested import read_json

if TYPE_CHECKING:
    from typing_extensions import Self

    from launcher.supervisor.plan import Plan

ANSWER_WITHIN_S = 30.0
END_WITHIN_S = 4.0
"""How long a supervisor that is no longer wanted may take to stop what it has started."""
_LOOK_EVERY_S = 0.05


class StartingSupervisor:
    """A supervisor waiting for its plan; used as a context manager, it is released on exit."""

    def __init__(self) -> None:
        self._begun = False
        self._words = os.memfd_create("supervisor")
        self._process = subprocess.Popen(
            [sys.executable, "-m", "launcher.supervisor", ROOM_ARGUMENT],
            # In that folder `launcher` is this package, whatever else the user's folder may
            # contain.
            cwd=Path(launcher.__file__).parent.parent,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._words,
            env={**os.environ, **_without_current_folder(), **room_for_marks()},
            start_new_session=True,
        )
        # It is reaped when it ends, however long that takes.
        threading.Thread(target=self._process.wait, name="supervisor", daemon=True).start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.give_up()

    @property
    def waits(self) -> bool:
        """Whether it is running and can be given a plan."""
        return self._words >= 0 and self._process.poll() is None and not self._hung_up()

    def give_up(self) -> None:
        """Release it: it ends if it has not started anything."""
        if not self._begun:
            self._kill()
        if self._words >= 0:
            os.close(self._words)
            self._words = -1
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                stream.close()

    async def begin(self, plan: Plan) -> tuple[Path, int]:
        """Give it the plan; may be called once.

        Returns:
            The folder of the run, and the descriptor that keeps a foreground session alive: when it
            is closed, the session ends.

        Raises:
            AlreadyRunningError: if one of the nodes is already running in that domain.
            RunDirError: if the run or log directory cannot be written.
            StartError: if it ended before it answered.
        """
        import asyncio

        from launcher.errors import AlreadyRunningError, RunDirError, StartError
        from launcher.status import SessionInfo
        from launcher.wire import unpack
        from text.packing import unpack_text
        from text.sentences import say

        stdin = self._process.stdin
        assert stdin is not None
        self._begun = True
        try:
            try:
                answer = await asyncio.wait_for(self._answer(plan), ANSWER_WITHIN_S)
            except asyncio.TimeoutError:
                await self._end()
                words = say("the supervisor did not answer within {s:g} s", s=ANSWER_WITHIN_S)
                raise StartError(words) from None
            except asyncio.CancelledError:
                await self._end()
                raise
            except (OSError, ValueError) as problem:
                raise StartError(self._last_words()) from problem
            if "no_room" in answer:
                raise RunDirError(unpack_text(answer["no_room"]))
            if "running" in answer:
                session = unpack(SessionInfo, answer["running"])
                raise AlreadyRunningError(session, answer["run_dir"], answer["down"], answer["free"])
            return Path(answer["folder"]), os.dup(stdin.fileno())
        finally:
            self.give_up()

    async def _end(self) -> None:
        """End it, by force if necessary: nobody wants the plan it was given any more."""
        import asyncio

        self.give_up()
        try:
            for _look in range(round(END_WITHIN_S / _LOOK_EVERY_S)):
                if self._process.poll() is not None:
                    return
                await asyncio.sleep(_LOOK_EVERY_S)
        finally:
            self._kill()

    def _hung_up(self) -> bool:
        """Whether nobody will answer: its guardian, which outlives it, has closed its stdout."""
        assert self._process.stdout is not None
        looking = select.poll()
        looking.register(self._process.stdout, 0)
        return bool(looking.poll(0))

    def _kill(self) -> None:
        """Kill the supervisor; its guardian, the process started here, ends the rest."""
        supervisors = [each for each in processes() if each.parent == self._process.pid]
        for supervisor in supervisors:
            send(supervisor, signal.SIGKILL)
        if supervisors:
            self._process.send_signal(signal.SIGCONT)
        else:
            self._process.kill()

    async def _answer(self, plan: Plan) -> dict[str, Any]:
        """Return what it says to a plan."""
        import asyncio

        assert self._process.stdin is not None
        await _write(self._process.stdin.fileno(), plan.to_json().encode() + b"\n")
        reader = asyncio.StreamReader()
        transport, _protocol = await asyncio.get_running_loop().connect_read_pipe(
            lambda: asyncio.StreamReaderProtocol(reader), self._process.stdout
        )
        try:
            answer: dict[str, Any] = read_json(await reader.readline())
        finally:
            transport.close()
        return answer

    def _last_words(self) -> str:
        from text.sentences import say

        words = os.pread(self._words, 1 << 16, 0).decode(errors="replace").strip()
        if not words:
            return say("the supervisor ended without saying why")
        return say("the supervisor ended: {words}", words=words.splitlines()[-1])


def _without_current_folder() -> dict[str, str]:
    """Return PYTHONPATH with the paths made absolute, for processes in other folders.

    An empty entry, as `export PYTHONPATH=$PYTHONPATH:/more` leaves behind, would mean the current
    folder of each process; nobody intends that.
    """
    written = os.environ.get("PYTHONPATH")
    parts = [os.path.abspath(part) for part in (written or "").split(os.pathsep) if part]  # noqa: PTH100
    return {} if written is None else {"PYTHONPATH": os.pathsep.join(parts)}


async def _write(fd: int, data: bytes) -> None:
    """Write to a pipe whose reader may hang, without a thread, which would then hang as well."""
    import asyncio

    loop, room = asyncio.get_running_loop(), asyncio.Event()
    os.set_blocking(fd, False)
    loop.add_writer(fd, room.set)
    try:
        while data:
            room.clear()
            with contextlib.suppress(BlockingIOError):
                data = data[os.write(fd, data) :]
            if data:
                await room.wait()
    finally:
        loop.remove_writer(fd)
