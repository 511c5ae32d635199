"""The Space screen at work, at 120x40: `python -m bench.space.screen`.

A cloud of 300 000 points at 10 Hz, from above and in perspective, on any line and over SSH; then
the simulated robot, which stands. Goals: 10 pictures a second within 40 % of a core and 40 kB/s;
the robot's screen within 20 % of a core.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from bench.observer import program
from bench.processes import cpu_s, pss_mb
from bench.screen import screen_processes
from bench.space.load import TOPIC
from tests.e2e.terminal import Terminal, own_folders

DOMAIN = os.environ.get("BENCH_DOMAIN", "83")
WARM_UP_S = 8.0
MEASURE_S = 12.0
LOOK_S = 0.01
TURNED = ("from the side", "perspective")
"""What the screen says after each press of Alt+V."""
SSH = {"SSH_CONNECTION": "192.0.2.1 50000 192.0.2.2 22"}


class Cost(NamedTuple):
    """What one case costs."""

    pictures_hz: float
    cpu_percent: float
    kb_per_s: float
    pss_mb: float


def open_space(folder: Path, profile: str, ready: str, shown: str, env: Mapping[str, str]) -> Terminal:
    """Return the program with the Space screen open, once it is ready and these words are on it."""
    own = own_folders(folder, SSH_CONNECTION="")
    argv = [sys.executable, "-m", "tui", profile, "--domain", DOMAIN, "--lang", "en"]
    terminal = Terminal(argv, 120, 40, {**own, **env})
    terminal.wait_for(ready, 60)
    terminal.press("9")
    terminal.wait_for(shown, 60)
    return terminal


def cost(terminal: Terminal) -> Cost:
    """Measure for some seconds; a picture is a burst of bytes to the terminal.

    The rates in the list, once a second, are drawn with a picture.
    """
    pids = screen_processes(terminal)
    cpu, sent, begun = cpu_s(pids), terminal.received, time.monotonic()
    before, changes, quiet = sent, 0, True
    while time.monotonic() - begun < MEASURE_S:
        time.sleep(LOOK_S)
        now = terminal.received
        changes += quiet and now != before
        before, quiet = now, now == before
    passed = time.monotonic() - begun
    return Cost(
        changes / passed, 100 * (cpu_s(pids) - cpu) / passed, (terminal.received - sent) / passed / 1000, pss_mb(pids)
    )


def measured(profile: str, ready: str, shown: str, angles: tuple[str, ...], env: Mapping[str, str]) -> Cost:
    """Open the screen, go through these angles, and measure at the last."""
    with tempfile.TemporaryDirectory() as name:
        terminal = open_space(Path(name), profile, ready, shown, env)
        try:
            for angle in angles:
                terminal.press("alt+v")
                terminal.wait_for(angle)
            time.sleep(WARM_UP_S)
            return cost(terminal)
        finally:
            terminal.close()


def main() -> None:
    """Measure all cases and print a table."""
    rows: list[tuple[str, Cost, str]] = []
    with tempfile.TemporaryDirectory() as name:
        nothing = Path(name) / "nothing.yaml"
        nothing.write_text("title: {en: Nothing}\nnodes:\n  sleep: {exec: [sleep, infinity]}\n")
        for what, angles, env in (
            ("from above", (), {}),
            ("from above, over SSH", (), SSH),
            ("in perspective", TURNED, {}),
            ("in perspective, over SSH", TURNED, SSH),
        ):
            # A publisher of its own: it would wait for the screen of the case before.
            with program("bench.space.load", DOMAIN):
                found = measured(str(nothing), "1/1", TOPIC, angles, env)
            rows.append((f"cloud {what}", found, "10 | 40 % | 40"))
    robot = measured("robot", "16/16", "/odom", (), {})
    rows.append(("the robot's profile", robot, "- | 20 % | -"))
    print("| what | pictures/s | CPU of a core | kB/s | PSS, MB | goals: pictures, CPU, kB/s |")
    print("| --- | --- | --- | --- | --- | --- |")
    for what, found, goals in rows:
        print(
            f"| {what} | {found.pictures_hz:.1f} | {found.cpu_percent:.0f} %"
            f" | {found.kb_per_s:.0f} | {found.pss_mb:.0f} | {goals.replace(' | ', ', ')} |"
        )


if __name__ == "__main__":
    main()
