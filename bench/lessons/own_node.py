"""From saving a learner's own file to the node being ready again.

`python -m bench.lessons.own_node` runs lesson 2 from the learner's folder, with the lesson's
solution in it, and saves the sonar's file again and again, as an editor does: into another file,
which takes its place. The time is from that moment until the supervisor says that the node is
ready, by another process; half a second of it is the wait for the last write.
"""

from __future__ import annotations

import asyncio
import os
import shutil
import statistics
import tempfile
import time
from pathlib import Path

from launcher.client.client import SupervisorClient, launch
from launcher.status import NodeState

DOMAIN = int(os.environ.get("BENCH_DOMAIN", "79"))
ROUNDS = int(os.environ.get("BENCH_ROUNDS", "11"))
LESSON = Path(__file__).parents[2] / "lessons" / "02-sonar-safety"
NODE, FILE = "sonar_front", "mock_sonar.py"
GOAL_S = 1.2
LOOK_S = 0.005


async def ready(client: SupervisorClient, other_than: int | None) -> int | None:
    """Wait until the node is ready by another process than this one, and return its number."""
    while True:
        status = client.nodes[NODE]
        if status.state is NodeState.READY and status.pid != other_than:
            return status.pid
        await asyncio.sleep(LOOK_S)


async def measure(folder: Path) -> list[float]:
    """Save the file so many times, and return how long each took."""
    took = []
    client = await launch(folder / "lesson.yaml", domain=DOMAIN)
    listening = asyncio.ensure_future(consume(client))
    try:
        pid = await ready(client, None)
        text = (folder / FILE).read_text("utf-8")
        for number in range(ROUNDS):
            await asyncio.sleep(1.0)
            fresh = folder / f"{FILE}~"
            fresh.write_text(f"{text}# {number}\n", "utf-8")
            began = time.monotonic()
            fresh.replace(folder / FILE)
            pid = await ready(client, pid)
            took.append(time.monotonic() - began)
    finally:
        listening.cancel()
        await client.shutdown(now=True)
    return took


async def consume(client: SupervisorClient) -> None:
    """Read the events, as a screen does."""
    async for _event in client.events():
        pass


def main() -> None:
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place, "02-sonar-safety")
        shutil.copytree(LESSON / "starter", folder)
        shutil.copytree(LESSON / "solution", folder, dirs_exist_ok=True)
        took = asyncio.run(measure(folder))
    print("| what | measured | goal |")
    print("| --- | --- | --- |")
    median = statistics.median(took)
    print(f"| saved to ready again, median of {len(took)} | {median:.2f} s | {GOAL_S} s |")
    print(f"| the longest | {max(took):.2f} s | - |")


if __name__ == "__main__":
    main()
