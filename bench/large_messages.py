"""A PointCloud2 of 5 MB at 10 Hz on the Topics screen: `python -m bench.large_messages`.

The cursor moves to the cloud, stays for a few messages, and leaves it again. The result is the
longest time from a key press to its effect. Goal: 200 ms.
"""

from __future__ import annotations

import os
import statistics
import tempfile
import time
from pathlib import Path

from bench.heavy_load import CLOUD, NUMBER
from bench.many_topics import marked
from bench.observer import program
from bench.processes import cpu_s, pss_mb
from bench.screen import screen_processes
from bench.topics_live import WARM_UP_S, open_topics
from tests.e2e.terminal import Terminal

DOMAIN = os.environ.get("BENCH_DOMAIN", "82")
VISITS = 15
STAY_S = 0.97
"""Not synchronous with the messages or the screen's updates."""


def answered_ms(terminal: Terminal, key: str, topic: str) -> float:
    """Return the time from a key press until the topic is selected."""
    started = time.monotonic()
    terminal.press(key)
    while marked(terminal) != topic:
        if time.monotonic() - started > 10:
            raise RuntimeError(f"no answer to a key:\n{terminal.text()}")
        time.sleep(0.002)
    return 1000 * (time.monotonic() - started)


def main() -> None:
    opened, left = [], []
    with program("bench.heavy_load", DOMAIN, "cloud"), tempfile.TemporaryDirectory() as name:
        terminal = open_topics(Path(name), NUMBER, DOMAIN)
        try:
            time.sleep(WARM_UP_S)
            for key in ("home", "down"):
                terminal.press(key)
                time.sleep(1.0)
            terminal.wait_until(lambda _: marked(terminal) == NUMBER, "the number is chosen")
            pids = screen_processes(terminal)
            cpu, begun = cpu_s(pids), time.monotonic()
            for _ in range(VISITS):
                opened.append(answered_ms(terminal, "up", CLOUD))
                time.sleep(STAY_S)
                left.append(answered_ms(terminal, "down", NUMBER))
                time.sleep(STAY_S / 3)
            used = 100 * (cpu_s(pids) - cpu) / (time.monotonic() - begun)
            memory = pss_mb(pids)
        finally:
            terminal.close()
    print(f"A PointCloud2 of 5 MB at 10 Hz, opened and left {VISITS} times")
    print("| a key that | median, ms | longest, ms | goal |")
    print("| --- | --- | --- | --- |")
    for what, delays in (("opens the cloud", opened), ("leaves it while it comes", left)):
        print(f"| {what} | {statistics.median(delays):.0f} | {max(delays):.0f} | 200 |")
    print(f"\nCPU {used:.0f} % of a core, PSS {memory:.0f} MB, screen and supervisor")


if __name__ == "__main__":
    main()
