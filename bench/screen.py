"""The cost of the screen in lesson 9 at 120x40, measured from outside, in a real terminal.

`python -m bench.screen` prints a table; every figure is measured in this one run.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

from bench.processes import cpu_s, of_the_screen, pss_mb, table
from bench.processes import deck as deck_in

if TYPE_CHECKING:
    import psutil

    from tests.e2e.terminal import Terminal

deck = partial(deck_in, domain=int(os.environ.get("BENCH_DOMAIN", "77")))
ROUNDS, PRESSES = 7, 30
TITLE = "One screen instead of five terminals"
FRAME_BYTES = 2000
"""More bytes than switching the terminal takes, fewer than any frame."""
REST_S = FLOOD_S = 30.0
FILLING_S = 25.0
"""Long enough to fill the bounded buffers."""
FLOOD = """
import sys, time
start, sent = time.monotonic(), 0
while True:
    due = int((time.monotonic() - start) * 10_000)
    sys.stdout.write("".join(f"flood line {n}, as long as log lines are wont to be\\n" for n in range(sent, due)))
    sys.stdout.flush()
    sent = due
    time.sleep(0.01)
"""
COUNT = """
import itertools, time
for n in itertools.count(1):
    print(f"count {n}", flush=True)
    time.sleep(0.02)
"""
PROFILE = """
title: {en: A flood of lines}
nodes:
  flood: {exec: [python3, ./flood.py]}
  count: {exec: [python3, ./count.py]}
"""


def first_frame(folder: Path) -> tuple[float, float, float]:
    """Return median s until the first frame, until the lessons, and for `import textual.app`."""
    taken = []
    for _ in range(ROUNDS):
        began_s = time.monotonic()
        subprocess.run([sys.executable, "-c", "import textual.app"], check=True)
        imported_s = time.monotonic()
        with deck(folder) as terminal:
            # Reading the screen would take CPU from the program that draws it.
            while terminal.received < FRAME_BYTES:
                time.sleep(0.001)
            frame_s = time.monotonic()
            terminal.wait_for(TITLE)
            taken.append((frame_s - imported_s, time.monotonic() - imported_s, imported_s - began_s))
    frame, listed, imported = (median(column) for column in zip(*taken, strict=True))
    return frame, listed, imported


def at_rest(terminal: Terminal, processes: list[psutil.Process]) -> tuple[float, float, float]:
    """Return CPU in percent of a core, PSS in MB, and bytes per second to the terminal."""
    cpu, sent, began_s = cpu_s(processes), terminal.received, time.monotonic()
    time.sleep(REST_S)
    passed_s = time.monotonic() - began_s
    return 100 * (cpu_s(processes) - cpu) / passed_s, pss_mb(processes), (terminal.received - sent) / passed_s


def key_delays_ms(terminal: Terminal, presses: int = PRESSES) -> list[float]:
    """Return the times from pressing an arrow key to the selection of the next row, told by its name."""
    delays = []
    for press in range(presses):
        before, began_s = marked(terminal), time.monotonic()
        terminal.press("up" if press % 2 else "down")
        while marked(terminal) in (before, ""):
            if time.monotonic() - began_s > 10:
                raise RuntimeError(f"no answer to a key:\n{terminal.text()}")
            time.sleep(0.001)
        delays.append(1000 * (time.monotonic() - began_s))
        # No multiple of the quarter of a second in which the graph is redrawn.
        time.sleep(0.23)
    return delays


def marked(terminal: Terminal) -> str:
    """Return the first word of the selected row, empty while there is none."""
    rows = (row.split() for row in terminal.text().splitlines() if row.startswith("▶"))
    return next((row[1] for row in rows if len(row) > 1), "")


def flooded(folder: Path) -> tuple[list[float], float, int, int]:
    """Return key delays in ms under a flood, growth of PSS in MB, lines written and kept.

    The lines are those of a second node, which writes 50 lines/s beside a flood of 10 000 lines/s.
    """
    for name, text in (("flood.py", FLOOD), ("count.py", COUNT), ("flood.yaml", PROFILE)):
        (folder / name).write_text(text)
    with deck(folder, str(folder / "flood.yaml")) as terminal:
        terminal.wait_for("2/2")
        time.sleep(FILLING_S)
        before, until_s, delays = pss_mb(of_the_screen(terminal)), time.monotonic() + FLOOD_S, []
        while time.monotonic() < until_s:
            delays += key_delays_ms(terminal)
        growth = pss_mb(of_the_screen(terminal)) - before
    lines = (line for log in (folder / "logs").rglob("count*.log*") for line in log.read_text().splitlines())
    counted = [int(number) for line in lines if (number := line.partition("count ")[2]).isdigit()]
    return delays, growth, max(counted), len(set(counted))


def main() -> None:
    """Measure everything and print a table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        frame, listed, imported = first_frame(folder)
        with deck(folder, "09-brain") as terminal:
            terminal.wait_for("9/9")
            time.sleep(5)
            cpu, pss, sent = at_rest(terminal, of_the_screen(terminal))
            keys = key_delays_ms(terminal)
        delays, growth, written, kept = flooded(folder)
    table(
        ("what", "measured", "goal"),
        ("first frame / `import textual.app`", f"{frame / imported:.2f}", "1.5"),
        ("the list of lessons / `import textual.app`", f"{listed / imported:.2f}", "-"),
        ("screen and supervisor at rest, CPU of one core", f"{cpu:.1f} %", "12 %"),
        ("screen and supervisor at rest, PSS", f"{pss:.0f} MB", "150 MB"),
        ("to the terminal at rest", f"{sent / 1000:.1f} kB/s", "8 kB/s"),
        ("a key to its effect, median", f"{median(keys):.0f} ms", "50 ms"),
        ("a key under 10 000 lines/s, median", f"{median(delays):.0f} ms", "200 ms"),
        ("a key under 10 000 lines/s, longest", f"{max(delays):.0f} ms", "500 ms"),
        (f"memory grown in {FLOOD_S:.0f} s of flood, buffers full", f"{growth:+.1f} MB", "flat"),
        ("lines of the other node lost in the flood", f"{written - kept} of {written}", "0"),
    )


if __name__ == "__main__":
    main()
