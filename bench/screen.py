"""The cost of the screen in lesson 9 at 120x40, measured from outside, in a real terminal.

`python -m bench.screen` prints a table; every figure is measured in this one run.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from bench.processes import command, cpu_s, descendants, pss_mb
from tests.e2e.terminal import Terminal, own_folders

DOMAIN = int(os.environ.get("BENCH_DOMAIN", "77"))
ROUNDS = 7
TITLE = "One screen instead of five terminals"
FRAME_BYTES = 2000
"""More bytes than switching the terminal takes, fewer than any frame."""
REST_S = 30.0
PRESSES = 30
FLOOD_S = 30.0
FILLING_S = 25.0
"""Long enough to fill the bounded buffers."""

FLOOD = """
import sys, time
start, sent = time.monotonic(), 0
while True:
    due = int((time.monotonic() - start) * 10_000)
    sys.stdout.write("".join(f"flood line {n}, as long as log lines are wont to be\\n"
                             for n in range(sent, due)))
    sys.stdout.flush()
    sent = due
    time.sleep(0.01)
"""
COUNT = """
import time
n = 0
while True:
    n += 1
    print(f"count {n}", flush=True)
    time.sleep(0.02)
"""


@contextmanager
def deck(folder: Path, *args: str) -> Iterator[Terminal]:
    """Run the program in a terminal of 120x40 with its own directories."""
    env = own_folders(folder, DECK_COURSE=str(folder / "course"))
    settings = folder / "config" / "deck" / "settings.json"
    settings.parent.mkdir(parents=True, exist_ok=True)
    settings.write_text(json.dumps({"tour": "seen"}))
    argv = [sys.executable, "-m", "tui", *args, "--domain", str(DOMAIN), "--lang", "en"]
    terminal = Terminal(argv, 120, 40, env)
    try:
        yield terminal
    finally:
        terminal.close()


def first_frame(folder: Path) -> tuple[float, float, float]:
    """Return median s until the first frame, until the lessons, and for `import textual.app`."""
    frames, lists, imports = [], [], []
    for _ in range(ROUNDS):
        started = time.monotonic()
        subprocess.run([sys.executable, "-c", "import textual.app"], check=True)
        imports.append(time.monotonic() - started)
        started = time.monotonic()
        with deck(folder) as terminal:
            # Reading the screen would take CPU from the program that draws it.
            while terminal.received < FRAME_BYTES:
                time.sleep(0.001)
            frames.append(time.monotonic() - started)
            terminal.wait_for(TITLE)
            lists.append(time.monotonic() - started)
    return statistics.median(frames), statistics.median(lists), statistics.median(imports)


def screen_processes(terminal: Terminal) -> list[int]:
    """Return the pids of the screen, its observer, guardian and supervisor, without server and nodes."""
    marks = ("observer.process", "launcher.supervisor")
    screen, *others = descendants(terminal.process.pid)
    return [screen, *(pid for pid in others if any(mark in command(pid) for mark in marks))]


def at_rest(terminal: Terminal, pids: list[int]) -> tuple[float, float, float]:
    """Return CPU in percent of a core, PSS in MB, and bytes per second to the terminal."""
    cpu, sent, started = cpu_s(pids), terminal.received, time.monotonic()
    time.sleep(REST_S)
    passed = time.monotonic() - started
    return (100 * (cpu_s(pids) - cpu) / passed, pss_mb(pids), (terminal.received - sent) / passed)


def key_delays_ms(terminal: Terminal, presses: int = PRESSES) -> list[float]:
    """Return the times from pressing an arrow key to the selection of the next row, told by its name."""
    delays = []
    for press in range(presses):
        before, started_s = marked(terminal), time.monotonic()
        terminal.press("up" if press % 2 else "down")
        while marked(terminal) in (before, ""):
            if time.monotonic() - started_s > 10:
                raise RuntimeError(f"no answer to a key:\n{terminal.text()}")
            time.sleep(0.001)
        delays.append(1000 * (time.monotonic() - started_s))
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
    profile = folder / "flood.yaml"
    (folder / "flood.py").write_text(FLOOD)
    (folder / "count.py").write_text(COUNT)
    profile.write_text(
        "title: {en: A flood of lines}\n"
        "nodes:\n"
        f"  flood: {{exec: [{sys.executable!r}, {str(folder / 'flood.py')!r}]}}\n"
        f"  count: {{exec: [{sys.executable!r}, {str(folder / 'count.py')!r}]}}\n"
    )
    with deck(folder, str(profile)) as terminal:
        terminal.wait_for("2/2")
        time.sleep(FILLING_S)
        before = pss_mb(screen_processes(terminal))
        until = time.monotonic() + FLOOD_S
        delays = []
        while time.monotonic() < until:
            delays += key_delays_ms(terminal)
        growth = pss_mb(screen_processes(terminal)) - before
    counted = [
        int(line.split("count ")[1])
        for log in sorted((folder / "logs").rglob("count*.log*"))
        for line in log.read_text().splitlines()
        if "count " in line and line.split("count ")[1].isdigit()
    ]
    return delays, growth, max(counted), len(set(counted))


def main() -> None:
    """Measure everything and print a table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        frame, listed, imported = first_frame(folder)
        with deck(folder, "09-brain") as terminal:
            terminal.wait_for("9/9")
            time.sleep(5)
            cpu, pss, sent = at_rest(terminal, screen_processes(terminal))
            keys = key_delays_ms(terminal)
        delays, growth, written, kept = flooded(folder)
    print("| what | measured | goal |")
    print("| --- | --- | --- |")
    print(f"| first frame / `import textual.app` | {frame / imported:.2f} | 1.5 |")
    print(f"| the list of lessons / `import textual.app` | {listed / imported:.2f} | - |")
    print(f"| screen and supervisor at rest, CPU of one core | {cpu:.1f} % | 12 % |")
    print(f"| screen and supervisor at rest, PSS | {pss:.0f} MB | 150 MB |")
    print(f"| to the terminal at rest | {sent / 1000:.1f} kB/s | 8 kB/s |")
    print(f"| a key to its effect, median | {statistics.median(keys):.0f} ms | 50 ms |")
    print(f"| a key under 10 000 lines/s, median | {statistics.median(delays):.0f} ms | 200 ms |")
    print(f"| a key under 10 000 lines/s, longest | {max(delays):.0f} ms | 500 ms |")
    print(f"| memory grown in {FLOOD_S:.0f} s of flood, buffers full | {growth:+.1f} MB | flat |")
    print(f"| lines of the other node lost in the flood | {written - kept} of {written} | 0 |")


if __name__ == "__main__":
    main()
