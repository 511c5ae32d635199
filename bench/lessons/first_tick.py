"""From a learner's node being ready to the tick of its check.

`python -m bench.lessons.first_tick` runs lesson 2 from the learner's folder, judged as the Lesson
screen has it judged. A file with a mistake is there until its step has failed, then the solution is
saved. The time is from when the supervisor says that the node is ready again until the judge says
that the step has passed. A check that has to watch for a while, as that of a rate, needs this long
besides: 2.5 s from the node's first message, which its timer sends a second after the start. The
goal is for what is left.
"""

from __future__ import annotations

import asyncio
import os
import shutil
import statistics
import tempfile
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

from bench.lessons.own_node import FILE, LESSON, consume, ready
from course.judging import RemoteJudge
from course.results import State, StepResult
from launcher.client.client import SupervisorClient, launch

DOMAIN = int(os.environ.get("BENCH_DOMAIN", "79"))
ROUNDS = int(os.environ.get("BENCH_ROUNDS", "7"))
STEPS = {"topic": ("letters-swapped", 0.0), "rate": ("twice-as-fast", 1.0 + 2.5)}
"""Step to a mistake in it, and the seconds that its check has to watch."""
GOAL_S = 0.3


class Listener:
    """The newest result of the step that is judged."""

    def __init__(self, judge: RemoteJudge) -> None:
        self.judge = judge
        self.result: StepResult | None = None
        self._news = asyncio.Event()

    async def listen(self) -> None:
        """Take what the judge says."""
        async for event in self.judge.events():
            if isinstance(event, StepResult):
                self.result = event
                self._news.set()

    async def until_failed(self, step: str) -> None:
        """Have a step judged until it fails: at first the old node may still be in the graph."""
        state = State.PASSED
        while state is State.PASSED:
            self.result = None
            self.judge.judge(step)
            state = await self.until(State.PASSED, State.FAILED)

    async def until(self, *states: State) -> State:
        """Wait for a result, and return which."""
        while self.result is None or self.result.state not in states:
            self._news.clear()
            await self._news.wait()
        return self.result.state


@asynccontextmanager
async def judged(folder: Path) -> AsyncIterator[tuple[SupervisorClient, Listener]]:
    """Run the learner's folder, and a judge of it."""
    client = await launch(folder / "lesson.yaml", domain=DOMAIN)
    consuming = asyncio.ensure_future(consume(client))
    judge = await RemoteJudge.start(LESSON, client.session.run_id, passed=STEPS)
    listener = Listener(judge)
    listening = asyncio.ensure_future(listener.listen())
    try:
        yield client, listener
    finally:
        await judge.close()
        listening.cancel()
        consuming.cancel()
        await client.shutdown(now=True)


def save(folder: Path, text: str) -> None:
    """Save the file as an editor does: into another file, which takes its place."""
    fresh = folder / f"{FILE}~"
    fresh.write_text(text, "utf-8")
    fresh.replace(folder / FILE)


async def measure(folder: Path, step: str) -> list[float]:
    """Have the step fail and pass so many times; return how long each tick took, in seconds."""
    mistake, _window_s = STEPS[step]
    solution = (folder / FILE).read_text("utf-8")
    wrong = (LESSON / "wrong" / step / mistake / FILE).read_text("utf-8")
    took = []
    async with judged(folder) as (client, listener):
        pid = await ready(client, None)
        for number in range(ROUNDS):
            save(folder, f"{wrong}# {number}\n")
            pid = await ready(client, pid)
            await listener.until_failed(step)
            save(folder, f"{solution}# {number}\n")
            pid = await ready(client, pid)
            began = time.monotonic()
            await listener.until(State.PASSED)
            took.append(time.monotonic() - began)
    save(folder, solution)
    return took


def main() -> None:
    print(f"load of the machine {os.getloadavg()[0]:.1f}\n")
    print("| what | measured | goal |")
    print("| --- | --- | --- |")
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place, "02-sonar-safety")
        shutil.copytree(LESSON / "starter", folder)
        shutil.copytree(LESSON / "solution", folder, dirs_exist_ok=True)
        for step, (_mistake, window_s) in STEPS.items():
            took = asyncio.run(measure(folder, step))
            what = f"ready to the tick of `{step}`, median of {len(took)}"
            goal = f"{window_s} + {GOAL_S} s" if window_s else f"{GOAL_S} s"
            print(f"| {what} | {statistics.median(took):.2f} s | {goal} |")
            print(f"| the longest | {max(took):.2f} s | - |")


if __name__ == "__main__":
    main()
