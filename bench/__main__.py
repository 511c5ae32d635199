"""Run every measurement, one after the other, and write bench/RESULTS.md: `python -m bench`.

On a machine that does nothing else. Where two things are compared they take turns in one run.
"""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from pathlib import Path

RESULTS = Path(__file__).with_name("RESULTS.md")

MEASUREMENTS = {
    "launch": "Starting lesson 9: Deck against `&` in a shell",
    "screen": "The screen on lesson 9, at 120x40",
    "topics_live": "Topics open, under ten Float32 at 50 Hz and one image at 30 Hz",
    "observer": "The observer alone, under the same load",
    "log_view": "The log view alone, under 10 000 lines/s",
    "node_ends": "From a signal to the end of a node",
}
"""Module to the title of its section."""


def main() -> int:
    """Measure, tell, and write; return 1 if a measurement broke off."""
    sections, broken = [], 0
    for module, title in MEASUREMENTS.items():
        print(f"{module}: {title} ...", file=sys.stderr, flush=True)
        ended = subprocess.run(
            [sys.executable, "-m", f"bench.{module}"],
            stdout=subprocess.PIPE,
            text=True,
            check=False,
        )
        broken += ended.returncode != 0
        text = ended.stdout.strip()
        if not text.startswith("|") and "\n| --- |" not in text:
            text = f"```\n{text}\n```"
        sections.append(f"## {title}\n\n`python -m bench.{module}`\n\n{text}\n")
    machine = f"{os.cpu_count()} cores, Python {platform.python_version()}, {platform.system()}"
    head = (
        "# What Deck costs\n\nWritten by `python -m bench`, in one run on a machine with "
        f"{machine}, on mocks; nothing here was measured on a Raspberry Pi or with real hardware.\n"
    )
    RESULTS.write_text("\n".join([head, *sections]))
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
