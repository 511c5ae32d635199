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

import psutil

RESULTS = Path(__file__).with_name("RESULTS.md")
MEASUREMENTS = {
    "launch": "Starting lesson 9: Deck against `&` in a shell",
    "screen": "The screen on lesson 9, at 120x40",
    "topics": "Topics open, under a hundred Float32 at 100 Hz and one picture at 30 Hz",
    "slow_line": "A moving picture on a line of 64 kB/s, and keys beside it",
    "stop": "From a near sonar frame, and from the space bar, to the stop at the Pico",
}
"""Module to the title of its section."""
HEAD = (
    f"# What Deck costs\n\nWritten by `python -m bench` on a machine with {os.cpu_count()} cores, Python"
    f" {platform.python_version()}, {platform.system()}, on mocks; nothing here was measured on a Raspberry Pi or"
    " with real hardware.\n"
)


def main() -> int:
    """Measure, and write; return 1 if a measurement failed, 2 for an unknown name."""
    wanted = sys.argv[1:] or list(MEASUREMENTS)
    if unknown := set(wanted) - set(MEASUREMENTS):
        print(f"no such measurement: {', '.join(unknown)}", file=sys.stderr)
        return 2
    before = RESULTS.read_text().split("\n## ")[1:] if RESULTS.exists() else []
    known = {title: text for title, _, text in (section.partition("\n\n") for section in before)}
    sections = {title: known.get(title, "not measured yet\n") for title in MEASUREMENTS.values()}
    broken = False
    for module in wanted:
        print(f"{module} ...", file=sys.stderr, flush=True)
        stolen, began_s = psutil.cpu_times().steal, time.monotonic()
        ended = subprocess.run([sys.executable, "-m", f"bench.{module}"], stdout=-1, text=True, check=False)
        broken |= ended.returncode != 0
        if not ended.returncode:
            share = 100 * (psutil.cpu_times().steal - stolen) / (time.monotonic() - began_s)
            told = f"`python -m bench.{module}`; the host kept {share:.1f} % of a core to itself"
            sections[MEASUREMENTS[module]] = f"{told}\n\n{ended.stdout.strip()}\n"
    RESULTS.write_text(HEAD + "".join(f"\n## {title}\n\n{text}" for title, text in sections.items()))
    return int(broken)


if __name__ == "__main__":
    sys.exit(main())
