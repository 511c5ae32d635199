"""Deck's recorder compared with a bare raw subscriber that writes the same bytes to a file.

`python -m bench.recording` prints a table of CPU and lost messages, measured in turns in one run.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from bench.observer import program
from bench.processes import cpu_s, pss_mb
from bench.recorders.load import HZ, SECONDS, SIZES

DOMAIN = os.environ.get("BENCH_DOMAIN", "79")
ROUNDS = 3
SUBJECTS = {"bare raw subscriber, bytes to a file": "bench.recorders.bare", "deck record": "bench.recorders.deck"}
"""The first is the baseline for the other."""
ALL_CAME_WITHIN_S = 10.0


@dataclass(frozen=True)
class Figures:
    """The figures of one turn of one subject."""

    cpu_percent: float
    lost: int
    pss_mb: float


def asked(process: subprocess.Popen[str]) -> int:
    """Ask a program for its number of messages."""
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write("\n")
    process.stdin.flush()
    return int(process.stdout.readline())


def measure(module: str, folder: Path) -> Figures:
    with program(module, DOMAIN, str(folder)) as subject, program("bench.recorders.load", DOMAIN) as load:
        # Importing rclpy and discovery are not part of the recording.
        time.sleep(4.0)
        before_s, begun_s = cpu_s([subject.pid]), time.monotonic()
        sent = asked(load)
        used = (cpu_s([subject.pid]) - before_s) / (time.monotonic() - begun_s)
        deadline_s = time.monotonic() + ALL_CAME_WITHIN_S
        while (came := asked(subject)) < sent and time.monotonic() < deadline_s:
            time.sleep(0.2)
        return Figures(100 * used, sent - came, pss_mb([subject.pid]))


def main() -> None:
    turns: dict[str, list[Figures]] = {name: [] for name in SUBJECTS}
    with tempfile.TemporaryDirectory() as folder:
        for turn in range(ROUNDS):
            for name, module in SUBJECTS.items():
                turns[name].append(measure(module, Path(folder, f"{module}-{turn}")))
    mb_per_s = sum(SIZES.values()) * HZ / 1e6
    count = HZ * SECONDS * len(SIZES)
    print(f"{mb_per_s:g} MB/s on {len(SIZES)} topics, {count} messages; medians of {ROUNDS} turns")
    print("| | CPU, % of a core | of bare | lost, most | PSS, MB |")
    print("| --- | --- | --- | --- | --- |")
    bare = statistics.median(f.cpu_percent for f in next(iter(turns.values())))
    for name, figures in turns.items():
        cpu = statistics.median(f.cpu_percent for f in figures)
        memory = statistics.median(f.pss_mb for f in figures)
        lost = max(f.lost for f in figures)
        print(f"| {name} | {cpu:.1f} | {cpu / bare:.2f} | {lost} | {memory:.0f} |")


if __name__ == "__main__":
    main()
