"""The observer compared with a bare rclpy script on the same topics, in turns in one run.

`python -m bench.observer` prints a table of CPU, the largest error of the eleven rates, and memory.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from bench.load import RATES_HZ
from bench.processes import cpu_s, pss_mb

DOMAIN = os.environ.get("BENCH_DOMAIN", "78")
WARM_UP_S = 6.0
MEASURE_S = 10.0
ROUNDS = 3
SUBJECTS = {
    "bare rclpy, SingleThreadedExecutor": ["bench.bare", DOMAIN],
    "observer, every 0.1 s": ["bench.observing", DOMAIN, "0.1"],
    "observer, every 0.25 s": ["bench.observing", DOMAIN, "0.25"],
    "observer, nobody looks": ["bench.observing", DOMAIN, "0.1", "idle"],
}
"""The first is the baseline for the others."""


@dataclass(frozen=True)
class Figures:
    """The figures of one turn of one subject."""

    cpu_percent: float
    rate_error_percent: float
    pss_mb: float


@contextmanager
def program(module: str, *args: str) -> Iterator[subprocess.Popen[str]]:
    """Run a module as a process until it has printed `ready`; closing its stdin ends it."""
    process = subprocess.Popen(
        [sys.executable, "-m", module, *args],
        env={**os.environ, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n", f"{module} did not start"
        yield process
    finally:
        process.communicate(timeout=30)


def rates(process: subprocess.Popen[str]) -> dict[str, float]:
    """Ask a subject for the rates it has measured."""
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write("\n")
    process.stdin.flush()
    return {str(topic): float(hz) for topic, hz in json.loads(process.stdout.readline()).items()}


def measure(subject: list[str]) -> Figures:
    with program(*subject) as process:
        time.sleep(WARM_UP_S)
        rates(process)
        cpu_before_s, before_s = cpu_s([process.pid]), time.monotonic()
        time.sleep(MEASURE_S)
        used = (cpu_s([process.pid]) - cpu_before_s) / (time.monotonic() - before_s)
        seen = rates(process)
        worst = max(abs(seen.get(topic, 0.0) / hz - 1) for topic, hz in RATES_HZ.items())
        return Figures(100 * used, 100 * worst, pss_mb([process.pid]))


def main() -> None:
    turns: dict[str, list[Figures]] = {name: [] for name in SUBJECTS}
    with program("bench.load", DOMAIN):
        for _ in range(ROUNDS):
            for name, subject in SUBJECTS.items():
                turns[name].append(measure(subject))
    print(f"10 Float32 at 50 Hz, one 640x480 bgr8 at 30 Hz; medians of {ROUNDS} turns")
    print("| | CPU, % of a core | of bare | worst rate error, % | PSS, MB |")
    print("| --- | --- | --- | --- | --- |")
    bare = statistics.median(f.cpu_percent for f in next(iter(turns.values())))
    for name, figures in turns.items():
        cpu = statistics.median(f.cpu_percent for f in figures)
        error = max(f.rate_error_percent for f in figures)
        memory = statistics.median(f.pss_mb for f in figures)
        shown = f"{error:.1f}" if "nobody" not in name else "-"
        print(f"| {name} | {cpu:.1f} | {cpu / bare:.2f} | {shown} | {memory:.0f} |")


if __name__ == "__main__":
    main()
