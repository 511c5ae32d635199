"""The judge as a process of its own: `python -m course.judge`, started by `course.judging`.

What it hears and says is in `course.judging`. It ends with its standard input, with the session
that it judges, or by `quit`. A learner's node that floods its topics, or a function of a lesson
that never returns, holds up this process and no screen.
"""

from __future__ import annotations

import asyncio
import os
import sys
from contextlib import aclosing, suppress
from pathlib import Path
from typing import Any

from course.judge.judge import Judge, judging
from course.judging import JudgeEnded, JudgeEvent, ValuesDrawn, packed
from course.lessons.lesson import LessonFolder
from course.results import MOST_BYTES, State, StepResult
from launcher.client.client import attach
from launcher.errors import LauncherError
from launcher.profile.steps.draw import new_seed
from text.nested import read_json
from text.sentences import reason_of


class JudgeServer:
    """Serves one client: one lesson, and one step of it at a time."""

    def __init__(self, requests: asyncio.StreamReader, out: int) -> None:
        """Hear there, and say everything on the descriptor `out`."""
        self._requests = requests
        self._out = out
        self._passed: list[StepResult] = []

    async def serve(self) -> None:
        """Serve until the client has gone or the session has ended."""
        start = await self._heard()
        if start is None:
            return
        try:
            client = await attach(start["run"])
            async with aclosing(client):
                seed = start["seed"] or new_seed()
                async with judging(LessonFolder(Path(start["lesson"])), client, seed) as judge:
                    self._passed = [
                        StepResult(step.id, State.PASSED, step.points)
                        for step in judge.steps.values()
                        if step.id in start["passed"]
                    ]
                    self._tell(ValuesDrawn(seed, dict(judge.evidence.values)))
                    await self._judge(judge)
                self._tell(JudgeEnded(judge.evidence.ended))
        except LauncherError as error:
            self._tell(JudgeEnded(reason_of(error)))

    async def _judge(self, judge: Judge) -> None:
        """Judge the step that was last asked for, until there is nobody left to ask or judge."""
        heard = asyncio.ensure_future(self._heard())
        watching: asyncio.Task[None] | None = None
        try:
            while True:
                await asyncio.wait({heard, judge.over}, return_when=asyncio.FIRST_COMPLETED)
                if not heard.done():
                    return
                request = heard.result()
                await _end(watching)
                if request is None or request["op"] == "quit":
                    return
                watching = asyncio.create_task(self._watch(judge, request["step"]))
                heard = asyncio.ensure_future(self._heard())
        finally:
            heard.cancel()
            await _end(watching)

    async def _watch(self, judge: Judge, id_: str) -> None:
        """Tell what becomes of a step until it has passed."""
        step = judge.steps.get(id_)
        if step is None:
            return
        waits = judge.waits(step, self._passed)
        if waits is not None:
            self._tell(waits)
            return
        async for result in judge.watch(id_):
            self._tell(result)
            if result.state is State.PASSED:
                self._passed.append(result)

    async def _heard(self) -> dict[str, Any] | None:
        """Return the next request; None once there will be none."""
        try:
            line = await self._requests.readline()
            request: dict[str, Any] | None = read_json(line) if line else None
        except ValueError:
            return None
        return request

    def _tell(self, event: JudgeEvent) -> None:
        """Say something; whoever has gone need not hear it."""
        with suppress(OSError):
            data = packed(event)
            while data:
                data = data[os.write(self._out, data) :]


async def _end(task: asyncio.Task[None] | None) -> None:
    if task is None:
        return
    task.cancel()
    with suppress(asyncio.CancelledError):
        await task


async def _run() -> None:
    requests = asyncio.StreamReader(limit=MOST_BYTES)
    await asyncio.get_running_loop().connect_read_pipe(lambda: asyncio.StreamReaderProtocol(requests), sys.stdin)
    # What rcl or a lesson's function prints must not get between the messages.
    out = os.dup(1)
    os.dup2(2, 1)
    await JudgeServer(requests, out).serve()


def main() -> None:
    """Judge, and end at once, whatever a thread of a lesson's function still does."""
    try:
        asyncio.run(_run())
    finally:
        sys.stderr.flush()
        os._exit(0)


if __name__ == "__main__":
    main()
