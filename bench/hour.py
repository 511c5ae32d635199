"""What an hour of the screen costs in memory: the profile `robot` on mocks, tabs changing.

`python -m bench.hour` prints a table. BENCH_MINUTES shortens the run. Growth is that from a sixth
of the time on, ten minutes of an hour, as the slope of a line through all samples after it.
"""

from __future__ import annotations

import os
import re
import sys
import tempfile
import time
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bench.processes import pss_mb
from bench.screen import deck, screen_processes

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from tests.e2e.terminal import Terminal

MINUTES = float(os.environ.get("BENCH_MINUTES", "60"))
PACE_S = float(os.environ.get("BENCH_PACE_S", "2"))
SAMPLE_S = 10.0
TABS = ("f2", "f3", "f4", "f5", "5", "6", "7", "8", "9")
"""Function keys where a text field may have the focus."""
SETTLED = 1 / 6
"""Until then buffers fill and screens are made."""


class Sample(NamedTuple):
    """Memory at one moment."""

    hours: float
    screen_mb: float
    observer_mb: float
    supervisor_mb: float
    tabs: int


def all_ready(screen: str) -> bool:
    """Return whether the title says so."""
    return re.search(r"● (\d+)/\1\b", screen) is not None


def samples(terminal: Terminal) -> Iterator[Sample]:
    """Change tabs at a steady pace, and yield the memory now and then."""
    began_s, sampled_s = time.monotonic(), -SAMPLE_S
    for number, tab in enumerate(cycle(TABS)):
        passed_s = time.monotonic() - began_s
        if passed_s - sampled_s >= SAMPLE_S:
            sampled_s = passed_s
            # The observer may have been made anew.
            screen, observer, supervisor = (pss_mb([pid]) for pid in screen_processes(terminal))
            yield Sample(passed_s / 3600, screen, observer, supervisor, number)
        if passed_s > 60 * MINUTES:
            return
        terminal.press(tab)
        time.sleep(PACE_S)


def growth_mb_h(hours: Sequence[float], megabytes: Sequence[float]) -> float:
    """Return the slope of the line that fits best."""
    return float(np.polyfit(hours, megabytes, 1)[0])


def main() -> None:
    """Measure, and print a table."""
    taken = []
    with tempfile.TemporaryDirectory() as name, deck(Path(name), "robot") as terminal:
        terminal.wait_until(all_ready, "all nodes ready", within_s=120)
        for sample in samples(terminal):
            taken.append(sample)
            print(*(f"{figure:.3f}" for figure in sample), file=sys.stderr, flush=True)
    settled = [each for each in taken if each.hours >= SETTLED * taken[-1].hours]
    hours = [each.hours for each in settled]
    figures = {
        "screen": [each.screen_mb for each in settled],
        "observer": [each.observer_mb for each in settled],
        "supervisor": [each.supervisor_mb for each in settled],
    }
    changes = taken[-1].tabs
    print(f"{MINUTES:.0f} minutes, {changes} changes of tab; load {os.getloadavg()[0]:.1f}\n")
    print("| | begins with | ends with | growth in an hour | goal |")
    print("| --- | --- | --- | --- | --- |")
    for what, megabytes in figures.items():
        ends = f"{megabytes[0]:.1f} MB | {megabytes[-1]:.1f} MB"
        print(f"| {what} | {ends} | {growth_mb_h(hours, megabytes):+.1f} MB | 1 MB |")


if __name__ == "__main__":
    main()
