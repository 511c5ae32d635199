"""What 200 frames at 50 Hz cost: `python -m bench.frames.cost`.

The observer alone, and the program with the Frames screen open at 120x40, drawing included. The
rates show whether all transforms were read. Goal: 10 % of a core.
"""

from __future__ import annotations

import json
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

from bench.frames.load import FRAMES, HZ, PUBLISHERS
from bench.observer import program, rates
from bench.processes import cpu_s
from bench.screen import screen_processes
from bench.topics_live import open_topics
from graph.data import GraphUpdate
from graph.observer.observer import Observer

DOMAIN = os.environ.get("BENCH_DOMAIN", "86")
WARM_UP_S = 8.0
MEASURE_S = 10.0
ROUNDS = 3
PERIOD_S = 0.25
"""As the screen has it."""


def observe(domain: str, *, idle: bool) -> None:
    """Observe until stdin is closed; answer each line with the rates of the frames."""
    newest = [GraphUpdate(0.0)]

    def take(update: GraphUpdate) -> None:
        newest[0] = update

    observer = Observer(int(domain), "localhost", PERIOD_S)
    observer.start(take)
    observer.watch_frames(not idle)
    print("ready", flush=True)
    for _ in sys.stdin:
        shown = {row.newest.child: row.hz or 0.0 for row in newest[0].frames}
        print(json.dumps(shown), flush=True)
    observer.stop()


def measure(*args: str) -> tuple[float, float]:
    """Return CPU in percent of a core, and the worst error of the rates in percent."""
    with program("bench.frames.cost", DOMAIN, *args) as process:
        time.sleep(WARM_UP_S)
        cpu, begun = cpu_s([process.pid]), time.monotonic()
        time.sleep(MEASURE_S)
        used = 100 * (cpu_s([process.pid]) - cpu) / (time.monotonic() - begun)
        seen = rates(process)
    missing = FRAMES - len(seen)
    worst = max((100 * abs(hz / HZ - 1) for hz in seen.values()), default=100.0)
    return used, 100.0 if missing else worst


def measure_screen() -> tuple[float, float]:
    """Return CPU of the program with Frames open, in percent of a core, and kB/s drawn."""
    with tempfile.TemporaryDirectory() as name:
        terminal = open_topics(Path(name), "/tf", DOMAIN)
        try:
            terminal.press("8")
            terminal.wait_for("frame_000")
            time.sleep(WARM_UP_S)
            pids = screen_processes(terminal)
            cpu, sent, begun = cpu_s(pids), terminal.received, time.monotonic()
            time.sleep(MEASURE_S)
            passed = time.monotonic() - begun
            used = 100 * (cpu_s(pids) - cpu) / passed
            return used, (terminal.received - sent) / passed / 1000
        finally:
            terminal.close()


def main() -> None:
    """Measure and print, or observe for that."""
    if len(sys.argv) > 1:
        observe(sys.argv[1], idle="idle" in sys.argv)
        return
    print(f"{FRAMES} frames at {HZ:.0f} Hz; medians of {ROUNDS} turns")
    print("| | CPU, % of a core | goal | worst rate error, % |")
    print("| --- | --- | --- | --- |")
    for kind, publishers in PUBLISHERS.items():
        with program("bench.frames.load", DOMAIN, kind):
            looking = [measure() for _ in range(ROUNDS)]
            screens = [measure_screen() for _ in range(ROUNDS)]
            idle = statistics.median(measure("idle")[0] for _ in range(ROUNDS))
        used, worst = statistics.median(one[0] for one in looking), max(one[1] for one in looking)
        what = f"publishers: {publishers}"
        print(f"| {what}; the observer | {used:.1f} | 10 | {worst:.1f} |")
        drawn, sent = (statistics.median(one[place] for one in screens) for place in (0, 1))
        shown = f"screen and supervisor, Frames open, {sent:.1f} kB/s drawn"
        print(f"| {what}; {shown} | {drawn:.1f} | 10 | - |")
        print(f"| {what}; nobody looks at frames | {idle:.1f} | - | - |")


if __name__ == "__main__":
    main()
