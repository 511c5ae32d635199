"""Deck with the Topics screen open, compared with a bare rclpy script on the same load.

`python -m bench.topics_live` prints CPU (screen and supervisor, drawing included) and the largest
error of the eleven rates on the screen, first while one number is echoed, then while the image is
shown.
"""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

from bench.load import RATES_HZ
from bench.observer import measure, program
from bench.processes import cpu_s, pss_mb
from bench.screen import screen_processes
from tests.e2e.terminal import Terminal, own_folders

DOMAIN = os.environ.get("BENCH_DOMAIN", "79")
WARM_UP_S = 8.0
MEASURE_S = 10.0
ROUNDS = 3


def open_topics(folder: Path, topic: str = "/load/image", domain: str = DOMAIN) -> Terminal:
    """Return the program with the Topics screen open, once this topic is on it."""
    profile = folder / "nothing.yaml"
    profile.write_text("title: {en: Nothing}\nnodes:\n  sleep: {exec: [sleep, infinity]}\n")
    argv = [sys.executable, "-m", "tui", str(profile), "--domain", domain, "--lang", "en"]
    terminal = Terminal(argv, 120, 40, own_folders(folder))
    terminal.wait_for("1/1")
    terminal.press("f3")
    terminal.wait_for(topic)
    return terminal


def worst_error_percent(text: str) -> float:
    """Return the largest error of the rates on the screen; 100 for a missing rate."""
    shown: dict[str, float] = {}
    for line in text.splitlines():
        words = line.replace("▶", " ").split()
        if len(words) > 4 and words[0] in RATES_HZ and words[4].replace(".", "").isdigit():
            shown.setdefault(words[0], float(words[4]))
    return max(100 * abs(shown.get(topic, 0.0) / hz - 1) for topic, hz in RATES_HZ.items())


def turn(terminal: Terminal) -> tuple[float, float, float]:
    """Return CPU in percent of a core, largest rate error in percent, and kB/s to the terminal."""
    pids = screen_processes(terminal)
    cpu, sent, begun = cpu_s(pids), terminal.received, time.monotonic()
    worst = 0.0
    while time.monotonic() - begun < MEASURE_S:
        time.sleep(1.0)
        worst = max(worst, worst_error_percent(terminal.text()))
    passed = time.monotonic() - begun
    rate = (terminal.received - sent) / passed / 1000
    return 100 * (cpu_s(pids) - cpu) / passed, worst, rate


def main() -> None:
    """Measure several turns and print the results."""
    bare, number, image = [], [], []
    memory = 0.0
    with program("bench.load", DOMAIN), tempfile.TemporaryDirectory() as name:
        for _round in range(ROUNDS):
            bare.append(measure(["bench.bare", DOMAIN]).cpu_percent)
            terminal = open_topics(Path(name))
            try:
                time.sleep(WARM_UP_S)
                number.append(turn(terminal))
                terminal.press("end")
                time.sleep(2)
                image.append(turn(terminal))
                memory = pss_mb(screen_processes(terminal))
            finally:
                terminal.close()
    least = statistics.median(bare)
    print(f"10 Float32 at 50 Hz, one 640x480 image at 30 Hz; medians of {ROUNDS} turns")
    print("| | CPU, % of a core | of bare | worst rate error, % | to the terminal, kB/s |")
    print("| --- | --- | --- | --- | --- |")
    print(f"| bare rclpy, SingleThreadedExecutor | {least:.1f} | 1.00 | | |")
    for what, turns in (("a number echoed", number), ("the image shown", image)):
        cpu = statistics.median(figures[0] for figures in turns)
        worst = max(figures[1] for figures in turns)
        rate = statistics.median(figures[2] for figures in turns)
        print(f"| Topics, {what} | {cpu:.1f} | {cpu / least:.2f} | {worst:.1f} | {rate:.1f} |")
    print(f"PSS of screen and supervisor: {memory:.0f} MB")


if __name__ == "__main__":
    main()
