"""What `deck view` costs beside the profile `robot`: CPU of what feeds it, and of Rerun's server.

A page nobody looks at costs as much: the server keeps what comes. The profile publishes 640x480
pictures at 10 Hz, a map, frames, the robot's model and its numbers.
"""

from __future__ import annotations

import subprocess
import sys
import time

from bench.processes import children, cpu_s, pss_mb

DOMAIN = "93"
SETTLE_S = 15.0
MEASURE_S = 30.0


def main() -> int:
    """Start both, measure, print a table."""
    deck = [sys.executable, "-m", "tui"]
    run = subprocess.Popen(
        [*deck, "run", "robot", "--domain", DOMAIN], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        rows = [
            ("`deck view --web`", *measured([*deck, "view", "--web", "--no-open"])),
            ("`deck foxglove`, nobody connected", *measured([*deck, "foxglove"])),
        ]
    finally:
        run.terminate()
        run.wait()
    print("| what | feeding, % of a core | Rerun's server, % | memory, MB |")
    print("| --- | --- | --- | --- |")
    for what, own, server, memory_mb in rows:
        print(f"| {what} | {own:.1f} | {server:.1f} | {memory_mb:.0f} |")
    return 0


def measured(command: list[str]) -> tuple[float, float, float]:
    """Return percent of a core of the process, of its children, and the memory of both in MB."""
    process = subprocess.Popen([*command, "--domain", DOMAIN], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        time.sleep(SETTLE_S)
        servers = children(process.pid)
        before, started = [cpu_s([process.pid]), cpu_s(servers)], time.monotonic()
        time.sleep(MEASURE_S)
        took_s = time.monotonic() - started
        after = [cpu_s([process.pid]), cpu_s(servers)]
        own, server = (100 * (now - was) / took_s for now, was in zip(after, before, strict=True))
        return own, server, pss_mb([process.pid, *servers])
    finally:
        process.terminate()
        process.wait()


if __name__ == "__main__":
    sys.exit(main())
