"""An examiner: `python -m course.grade FD` judges one folder, and ends with everything it started.

FD is a socket for its orders and its findings, see `course.grade.examination`;
no process that it starts has it. It limits itself and its descendants, and confines the nodes. Its
first process is a guardian: whatever the nodes do to the supervisor or to the judge, the guardian
ends all that descends from it, and then itself.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import socket
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from course.grade.examination import ExamRequest
from course.grade.limits import limit_this_process
from course.results import MOST_BYTES, pack_step
from launcher.errors import AlreadyRunningError, LauncherError
from launcher.supervisor.guardian import fork_under_guardian
from launcher.wire import encode
from text.packing import pack_text
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from course.results import StepResult
    from graph.recording.recorder import Recorder


class Examiner:
    """Judges one folder."""

    def __init__(self, request: ExamRequest, channel: socket.socket) -> None:
        self._request = request
        self._channel = channel
        self._step_began_s = 0.0

    async def examine(self) -> None:
        """Judge it, and tell of it; end early when nobody listens any more."""
        work = asyncio.ensure_future(self._judge())
        gone = asyncio.ensure_future(self._grader_gone())
        await asyncio.wait({work, gone}, return_when=asyncio.FIRST_COMPLETED)
        gone.cancel()
        if not work.done():
            work.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await work

    async def _grader_gone(self) -> None:
        """Return when the grader is gone, or wants no more."""
        loop = asyncio.get_running_loop()
        self._channel.setblocking(False)
        with contextlib.suppress(OSError):
            await loop.sock_recv(self._channel, 1)

    async def _judge(self) -> None:
        request = self._request
        reason, taken = "", False
        try:
            await asyncio.wait_for(self._once(), request.within_s)
        except asyncio.TimeoutError:
            reason = say("it took longer than {n:g} s", n=request.within_s)
        except AlreadyRunningError as error:
            reason, taken = reason_of(error), True
        except (LauncherError, OSError) as error:
            reason = reason_of(error)
        self._tell(event="end", reason=pack_text(reason), taken=taken)

    async def _once(self) -> None:
        from course.judge.functions import preloaded
        from course.lessons.lesson import LessonFolder
        from course.proof.trial import Places, trial
        from launcher.client.start import StartingSupervisor

        request = self._request
        # It has more to import than this process, so it is started at once.
        with StartingSupervisor() as supervisor:
            lesson = LessonFolder(Path(request.lesson))
            # Read before anything of the learner's runs, which might change it.
            functions = await preloaded(lesson)
            run = trial(
                lesson,
                Places(Path(request.place), lesson.name),
                seed=request.seed,
                domain=request.domain,
                within=request.cell,
                language=request.language,
                functions=functions,
                supervisor=supervisor,
            )
            async with self._recording(request.domain), run as judge:
                self._tell(event="values", values=dict(judge.evidence.values))
                self._step_began_s = time.monotonic()
                await judge.once(on_step=self._tell_step)

    @contextlib.asynccontextmanager
    async def _recording(self, domain: int) -> AsyncIterator[None]:
        if not self._request.bag:
            yield
            return
        from graph.recording.recorder import Recorder

        recorder: Recorder = Recorder(domain, "localhost", Path(self._request.bag))
        await asyncio.to_thread(recorder.start)
        try:
            yield
        finally:
            status = await asyncio.to_thread(recorder.stop)
            if status.error:
                self._tell(event="note", words=pack_text(status.error))

    def _tell_step(self, step: StepResult) -> None:
        now_s = time.monotonic()
        took_s, self._step_began_s = now_s - self._step_began_s, now_s
        self._tell(event="step", step=pack_step(step), seconds=took_s)

    def _tell(self, **message: object) -> None:
        """Say something; a grader that has gone need not hear it."""
        data = encode(message)
        with contextlib.suppress(OSError):
            self._channel.setblocking(True)
            self._channel.sendall(data)
            self._channel.setblocking(False)


def _request(channel: socket.socket) -> ExamRequest | None:
    """Return what is to be done; None if the grader has gone."""
    line = bytearray()
    while not line.endswith(b"\n") and len(line) < MOST_BYTES:
        data = channel.recv(1 << 16)
        if not data:
            return None
        line += data
    return ExamRequest.from_json(bytes(line))


def main() -> None:
    """Examine, and end at once, whatever a thread of a lesson's function still does."""
    channel = socket.socket(fileno=int(sys.argv[1]))
    channel.set_inheritable(False)
    fork_under_guardian()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)
    request = _request(channel)
    if request is not None:
        limit_this_process(request.within_s)
        try:
            asyncio.run(Examiner(request, channel).examine())
        finally:
            sys.stderr.flush()
            os._exit(0)


if __name__ == "__main__":
    main()
