"""The CPU load of the serial drivers: two sonars with 100 frames/s, and the chassis at 50 Hz.

`python -m bench.serial_cpu` prints a table of CPU in percent of one core, medians of several turns.
The other nodes of the chain, a commander and drive_to_point, which subscribes to /odom, run as
well.
"""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
import time
from contextlib import ExitStack, nullcontext
from pathlib import Path

from bench.driving import CHAIN, commander, nodes, running, wait_for
from bench.emulated import Pico, Sonar
from bench.processes import cpu_s

TURNS = int(os.environ.get("BENCH_ROUNDS", "3"))
TURN_S, SETTLE_S = 20.0, 4.0
DRIVERS = ("sonar_front", "sonar_rear", "chassis")
WAYS = {
    "as in robot.yaml: every second reading published": (2, False),
    "every reading published": (1, False),
    "every reading published, all topics listened to": (1, True),
}


def measure(folder: Path, pico: Pico, every: int, listen: bool) -> list[float]:
    """Return the CPU load of each driver, in percent of a core."""
    listener = running([sys.executable, "-m", "bench.listener"]) if listen else nullcontext()
    beside = (*CHAIN, "drive_to_point")
    with nodes(folder, beside, every=every) as started, commander(), listener:
        wait_for(pico.driven, time.monotonic())
        time.sleep(SETTLE_S)
        pids = [started[name].pid for name in DRIVERS]
        before, began_s = [cpu_s([pid]) for pid in pids], time.monotonic()
        time.sleep(TURN_S)
        passed_s = time.monotonic() - began_s
        after = [cpu_s([pid]) for pid in pids]
    return [100 * (b - a) / passed_s for a, b in zip(before, after, strict=True)]


def measure_bare(folder: Path) -> float:
    """Return the CPU load of a plain pyserial loop on one sonar and the Pico, in the same unit."""
    argv = [sys.executable, "-m", "bench.bare_reflex"]
    with running([*argv, str(folder / "tof_front"), str(folder / "pico")]) as process:
        time.sleep(SETTLE_S)
        before, began_s = cpu_s([process.pid]), time.monotonic()
        time.sleep(TURN_S)
        return 100 * (cpu_s([process.pid]) - before) / (time.monotonic() - began_s)


def main() -> None:
    """Measure in turns, and print the medians."""
    taken: dict[str, list[list[float]]] = {name: [] for name in WAYS}
    bare = []
    with tempfile.TemporaryDirectory() as name, ExitStack() as stack:
        folder = Path(name)
        pico = stack.enter_context(Pico(folder / "pico"))
        for sonar in ("tof_front", "tof_rear"):
            stack.enter_context(Sonar(folder / sonar))
        for _ in range(TURNS):
            for way, figures in taken.items():
                figures.append(measure(folder, pico, *WAYS[way]))
            bare.append(measure_bare(folder))
    print(f"{TURNS} turns of {TURN_S:g} s; load of the machine {os.getloadavg()[0]:.1f}\n")
    print("| CPU, % of a core | front sonar | rear sonar | chassis | together | goal |")
    print("| --- | --- | --- | --- | --- | --- |")
    for way, figures in taken.items():
        medians = [statistics.median(column) for column in zip(*figures, strict=True)]
        each = " | ".join(f"{value:.1f}" for value in medians)
        together = statistics.median(map(sum, figures))
        print(f"| {way} | {each} | {together:.1f} | {'-' if WAYS[way][1] else 15} |")
    alone = statistics.median(bare)
    print(f"| one process with pyserial, one sonar and the Pico, no ROS | | | | {alone:.1f} | - |")


if __name__ == "__main__":
    main()
