"""A judge in a process of its own, from the side of whoever shows what it says.

judge = await RemoteJudge.start(lesson.path, client.session.run_id, passed={"topic"})
judge.judge("rate")
async for event in judge.events(): ...
await judge.close()

Lines of JSON go between the processes. To the judge: `start`, once; then `judge`, as often as wished, and `quit`.
From it: `values`, once it is at work, `step` for whatever changes, and `end`, the last one.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
from collections.abc import AsyncGenerator, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

import course
from course.results import MOST_BYTES, StepResult
from launcher.wire import Sentence, encode, pack, unpack
from text.nested import read_json
from text.sentences import say

CLOSED_WITHIN_S = 3.0


@dataclass(frozen=True)
class ValuesDrawn:
    """The judge is at work, with these values."""

    seed: int
    values: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class JudgeEnded:
    """The judge has ended; nothing more comes."""

    reason: Sentence = ""
    """Why, in a sentence; empty if it was asked to."""


JudgeEvent: TypeAlias = ValuesDrawn | StepResult | JudgeEnded
_KINDS: dict[str, type[JudgeEvent]] = {"values": ValuesDrawn, "step": StepResult, "end": JudgeEnded}


def packed(event: JudgeEvent) -> bytes:
    kind = next(kind for kind, made in _KINDS.items() if isinstance(event, made))
    return encode({"event": kind, **pack(event)})


class RemoteJudge:
    """A judge's process; made by `start`."""

    def __init__(self, process: asyncio.subprocess.Process) -> None:
        self._process = process
        assert process.stdin is not None
        assert process.stdout is not None
        self._requests, self._said = process.stdin, process.stdout

    @classmethod
    async def start(cls, lesson: Path, run: str, *, seed: int = 0, passed: Iterable[str] = ()) -> RemoteJudge:
        """Start one for a running profile.

        Args:
            lesson: the folder of the lesson whose steps count
            run: the id of the run, `SessionInfo.run_id`
            seed: what the values are drawn from; 0: it draws one
            passed: steps that have passed earlier, for those that need them
        """
        process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "course.judge"),
            # In that folder `course` is this package, whatever else the user's folder may contain.
            cwd=Path(course.__file__).parent.parent,
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.DEVNULL,
            env={**os.environ, "OPENBLAS_THREAD_TIMEOUT": "4"},
            limit=MOST_BYTES,
            # Ctrl-C in the terminal is meant for its client.
            start_new_session=True,
        )
        judge = cls(process)
        judge._ask(lesson=str(lesson), run=run, seed=seed, passed=sorted(passed), op="start")
        return judge

    def judge(self, step: str) -> None:
        """Judge this step from now on, again and again until it has passed, and no other one."""
        self._ask(op="judge", step=step)

    async def events(self) -> AsyncGenerator[JudgeEvent, None]:
        """Yield what the judge says, `JudgeEnded` last; for a single consumer."""
        async for line in self._said:
            try:
                message = read_json(line)
                event = unpack(_KINDS[message.pop("event")], message)
            except (ValueError, KeyError, TypeError):
                break
            yield event
            if isinstance(event, JudgeEnded):
                return
        yield JudgeEnded(say("the judge has ended unexpectedly"))

    async def close(self) -> None:
        """End it; return when it has ended."""
        self._ask(op="quit")
        self._requests.close()
        try:
            await asyncio.wait_for(self._process.wait(), CLOSED_WITHIN_S)
        except asyncio.TimeoutError:
            with contextlib.suppress(ProcessLookupError):
                self._process.kill()
            await self._process.wait()

    def _ask(self, **request: object) -> None:
        if not self._requests.is_closing():
            self._requests.write(encode(request))
