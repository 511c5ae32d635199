"""Run measurements one after the other and write bench/RESULTS.md: `python -m bench [NAME...]`.

Use a machine that does nothing else. On a virtual machine the results include the CPU time that the host withheld
(steal time), since a stalled core slows everything down. Things that are compared take turns in the same run. Only
the named measurements are repeated; the results of the others stay.
"""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import time
from pathlib import Path

from bench.processes import stolen_s

RESULTS = Path(__file__).with_name("RESULTS.md")
MEASUREMENTS = {
    "launch": "Starting lesson 9: Deck against `&` in a shell",
    "screen": "The screen on lesson 9, at 120x40",
    "topics": "Topics open, under a hundred Float32 at 100 Hz and one picture at 30 Hz",
    "slow_line": "A moving picture on a line of 64 kB/s, and keys beside it",
    "stop": "From a near sonar frame, and from the space bar, to the stop at the Pico",
}
"""Module to the title of its section."""


def main() -> int:
    """Measure, print, and write; return 1 if a measurement failed, 2 for an unknown name."""
    wanted = sys.argv[1:] or list(MEASUREMENTS)
    if unknown := set(wanted) - set(MEASUREMENTS):
        print(f"no such measurement: {', '.join(unknown)}", file=sys.stderr)
        return 2
    sections = known_sections()
    broken = False
    for module in wanted:
        title = MEASUREMENTS[module]
        print(f"{module}: {title} ...", file=sys.stderr, flush=True)
        stolen, started = stolen_s(), time.monotonic()
        argv = [sys.executable, "-m", f"bench.{module}"]
        ended = subprocess.run(argv, stdout=subprocess.PIPE, text=True, check=False)
        if ended.returncode:
            broken = True
            continue
        share = 100 * (stolen_s() - stolen) / (time.monotonic() - started)
        told = f"`python -m bench.{module}`; the host kept {share:.1f} % of a core to itself"
        sections[title] = f"{told}\n\n{ended.stdout.strip()}\n"
    RESULTS.write_text(head() + "".join(f"\n## {t}\n\n{sections[t]}" for t in sections))
    return int(broken)


def head() -> str:
    """Return the head of the page: what was measured, and what was not."""
    machine = f"{os.cpu_count()} cores, Python {platform.python_version()}, {platform.system()}"
    return (
        f"# What Deck costs\n\nWritten by `python -m bench` on a machine with {machine}, on mocks; "
        "nothing here was measured on a Raspberry Pi or with real hardware.\n"
    )


def known_sections() -> dict[str, str]:
    """Return title to text of the previous results, in the order of `MEASUREMENTS`."""
    known = {}
    if RESULTS.exists():
        for section in RESULTS.read_text().split("\n## ")[1:]:
            title, _, text = section.partition("\n\n")
            known[title] = text
    return {title: known.get(title, "not measured yet\n") for title in MEASUREMENTS.values()}


if __name__ == "__main__":
    sys.exit(main())
