"""Run measurements one after the other and write bench/RESULTS.md: `python -m bench [NAME...]`.

Use a machine that does nothing else. On a virtual machine the results include the CPU time that the
host withheld (steal time), since a stalled core slows everything down. Things that are compared
take turns in the same run. Only the named measurements are repeated; the results of the others
stay.
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
    "lessons.own_node": "From saving a file of one's own to the node ready again",
    "lessons.first_tick": "From a learner's node being ready to the tick of its check",
    "lessons.screen": "The Lesson screen at rest, at 120x40",
    "lessons.grading": "From `deck grade` on lesson 2's solution to its grade",
    "screen": "The screen on lesson 9, at 120x40",
    "topics_live": "Topics open, under ten Float32 at 50 Hz and one image at 30 Hz",
    "many_topics": "Topics open, under a hundred Float32 at 100 Hz",
    "large_messages": "Topics open on a PointCloud2 of 5 MB at 10 Hz",
    "pictures": "Topics open on a 1280x720 camera at 30 Hz",
    "slow_line": "A moving picture on a line of 64 kB/s, and keys beside it",
    "space.screen": "Space open on a cloud of 300 000 points, and on the robot",
    "observer": "The observer alone, under the same load",
    "frames.cost": "200 frames of /tf at 50 Hz",
    "viewers.cost": "The viewer in 3D and Foxglove's server beside the profile robot",
    "recording": "Recording 10 MB/s",
    "log_view": "The log view alone, under 10 000 lines/s",
    "node_ends": "From a signal to the end of a node",
    "stop_latency": "From a sonar's frame under the threshold to the stop at the Pico",
    "space_bar": "From the space bar to the emergency stop at the Pico",
    "brain.latency": "From the last byte of a model's answer to the command on /drive",
    "cable": "A cable pulled and put back",
    "serial_cpu": "What the serial drivers cost",
    "voice.words": "Spoken commands, heard offline",
    "voice.latency": "From the end of a spoken command to /drive, offline",
    "simulated.hour": "An hour of simulated driving among boxes",
    "hour": "An hour of the screen on the profile robot, tabs changing",
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
        argv = [sys.executable, "-m", f"bench.{module}"]
        stolen, started = stolen_s(), time.monotonic()
        ended = subprocess.run(argv, stdout=subprocess.PIPE, text=True, check=False)
        if ended.returncode:
            broken = True
            continue
        text = ended.stdout.strip()
        if "| --- |" not in text:
            text = f"```\n{text}\n```"
        share = 100 * (stolen_s() - stolen) / (time.monotonic() - started)
        told = f"`python -m bench.{module}`; the host kept {share:.1f} % of a core to itself"
        sections[title] = f"{told}\n\n{text}\n"
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
