"""Topics open under a hundred Float32 topics at 100 Hz: `python -m bench.many_topics`.

The results are the time from an arrow key to its effect, the largest error of the rates on the
screen, and the CPU load. Goals: a median of 100 ms, 2 %.
"""

from __future__ import annotations

import os
import statistics
import tempfile
import time
from pathlib import Path

from bench.heavy_load import MANY, MANY_HZ
from bench.observer import program
from bench.processes import cpu_s
from bench.screen import screen_processes
from bench.topics_live import WARM_UP_S, open_topics
from tests.e2e.terminal import Terminal

DOMAIN = os.environ.get("BENCH_DOMAIN", "81")
PRESSES = 40
LOOKS = 10
ROUNDS = 2


def key_delays_ms(terminal: Terminal) -> list[float]:
    """Return the times from pressing an arrow key to the selection of the next topic."""
    delays = []
    for press in range(PRESSES):
        before = marked(terminal)
        started = time.monotonic()
        terminal.press("up" if press % 2 else "down")
        while marked(terminal) in (before, ""):
            if time.monotonic() - started > 10:
                raise RuntimeError(f"no answer to a key:\n{terminal.text()}")
            time.sleep(0.002)
        delays.append(1000 * (time.monotonic() - started))
        time.sleep(0.23)
    return delays


def marked(terminal: Terminal) -> str:
    """Return the name of the topic under the cursor; empty while it is being drawn."""
    rows = (row.split() for row in terminal.text().splitlines() if row.startswith("▶"))
    return next((row[1] for row in rows if len(row) > 1), "")


def worst_error_percent(text: str) -> float:
    """Return the largest error of the rates on the screen; 100 for a missing rate."""
    errors = []
    for line in text.splitlines():
        words = line.replace("▶", " ").split()
        # The heading of the selected topic also begins with its name, and has two words.
        if len(words) > 4 and words[0] in MANY:
            hz = float(words[4]) if words[4].replace(".", "").isdigit() else 0.0
            errors.append(100 * abs(hz / MANY_HZ - 1))
    return max(errors, default=100.0)


def turn(folder: Path) -> tuple[list[float], float, float]:
    """Return key delays in ms, the largest error in percent, and CPU in percent of a core."""
    terminal = open_topics(folder, MANY[3], DOMAIN)
    try:
        time.sleep(WARM_UP_S)
        pids = screen_processes(terminal)
        cpu, begun, worst = cpu_s(pids), time.monotonic(), 0.0
        for _ in range(LOOKS):
            time.sleep(1.0)
            worst = max(worst, worst_error_percent(terminal.text()))
        used = 100 * (cpu_s(pids) - cpu) / (time.monotonic() - begun)
        return key_delays_ms(terminal), worst, used
    finally:
        terminal.close()


def main() -> None:
    delays: list[float] = []
    errors, used = [], []
    with program("bench.heavy_load", DOMAIN, "many"), tempfile.TemporaryDirectory() as name:
        for _ in range(ROUNDS):
            keys, worst, cpu = turn(Path(name))
            delays += keys
            errors.append(worst)
            used.append(cpu)
    print(f"{len(MANY)} Float32 at {MANY_HZ:.0f} Hz, Topics open at 120x40; {ROUNDS} turns")
    print("| | | goal |")
    print("| --- | --- | --- |")
    print(f"| a key is answered, median | {statistics.median(delays):.0f} ms | 100 ms |")
    print(f"| the slowest of {len(delays)} keys | {max(delays):.0f} ms | |")
    print(f"| worst error of a rate | {max(errors):.1f} % | 2 % |")
    print(f"| CPU of screen and supervisor | {statistics.median(used):.0f} % of a core | |")


if __name__ == "__main__":
    main()
