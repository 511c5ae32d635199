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
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import TypeAlias

from course.grade.examination import ExamRequest
from course.grade.limits import limit_this_process
from course.results import MOST_BYTES, StepResult
from launcher.errors import AlreadyRunningError, LauncherError
from launcher.supervisor.guardian import fork_under_guardian
from launcher.wire import encode, pack
from text.nested import read_json
from text.packing import pack_text
from text.sentences import reason_of, say

Tell: TypeAlias = Callable[..., None]


async def _examine(channel: socket.socket) -> None:
    """Do what is asked, and tell of it; end early when the grader has gone, or wants no more."""
    reader, writer = await asyncio.open_connection(sock=channel, limit=MOST_BYTES)
    line = await reader.readline()
    if not line:
        return
    request = ExamRequest(**read_json(line))
    limit_this_process(request.within_s)
    work = asyncio.ensure_future(_judge(request, lambda **message: writer.write(encode(message))))
    gone = asyncio.ensure_future(reader.read(1))
    await asyncio.wait({work, gone}, return_when=asyncio.FIRST_COMPLETED)
    gone.cancel()
    work.cancel()
    with contextlib.suppress(asyncio.CancelledError):
        await work
    writer.close()
    with contextlib.suppress(OSError):
        await writer.wait_closed()


async def _judge(request: ExamRequest, tell: Tell) -> None:
    reason, taken = "", False
    try:
        await asyncio.wait_for(_once(request, tell), request.within_s)
    except asyncio.TimeoutError:
        reason = say("it took longer than {n:g} s", n=request.within_s)
    except AlreadyRunningError as error:
        reason, taken = reason_of(error), True
    except (LauncherError, OSError) as error:
        reason = reason_of(error)
    tell(event="end", reason=pack_text(reason), taken=taken)


async def _once(request: ExamRequest, tell: Tell) -> None:
    from course.judge.functions import preloaded
    from course.lessons.lesson import LessonFolder
    from course.proof.trial import Places, trial
    from launcher.client.start import StartingSupervisor

    # It has more to import than this process, so it is started at once.
    with StartingSupervisor() as supervisor:
        lesson = LessonFolder(Path(request.lesson))
        run = trial(
            lesson,
            Places(Path(request.place), lesson.name),
            seed=request.seed,
            domain=request.domain,
            within=request.cell,
            language=request.language,
            # Read before anything of the learner's runs, which might change it.
            functions=await preloaded(lesson),
            supervisor=supervisor,
        )
        async with _recording(request, tell), run as judge:
            tell(event="values", values=dict(judge.evidence.values))
            began_s = time.monotonic()

            def tell_step(step: StepResult) -> None:
                nonlocal began_s
                took_s, began_s = time.monotonic() - began_s, time.monotonic()
                tell(event="step", step=pack(step), seconds=took_s)

            await judge.once(tell_step)


@contextlib.asynccontextmanager
async def _recording(request: ExamRequest, tell: Tell) -> AsyncIterator[None]:
    if not request.bag:
        yield
        return
    from graph.recording.recorder import Recorder

    recorder: Recorder = Recorder(request.domain, "localhost", Path(request.bag))
    await asyncio.to_thread(recorder.start)
    try:
        yield
    finally:
        status = await asyncio.to_thread(recorder.stop)
        if status.error:
            tell(event="note", words=pack_text(status.error))


def main() -> None:
    """Examine, and end at once, whatever a thread of a lesson's function still does."""
    channel = socket.socket(fileno=int(sys.argv[1]))
    channel.set_inheritable(False)
    fork_under_guardian()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)
    try:
        asyncio.run(_examine(channel))
    finally:
        sys.stderr.flush()
        os._exit(0)


if __name__ == "__main__":
    main()
