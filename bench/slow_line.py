"""Moving pictures and key presses on a line of 64 kB/s: `python -m bench.slow_line`.

A camera pans over a landscape, 640x480 at 15 Hz, on the Topics screen at 160x45: nearly every cell
changes with every picture.
"""

from __future__ import annotations

import os
import re
import sys
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

from bench.processes import ROOT, deck, table
from tests.e2e.panning_camera import PROFILE, TOPIC

if TYPE_CHECKING:
    from tests.e2e.terminal import Terminal

DOMAIN = int(os.environ.get("BENCH_DOMAIN", "79"))
SIZE = (160, 45)
WARM_UP_S = 15.0
"""Long enough for the queue to the line to reach its maximum."""
MEASURE_S = 10.0
PRESSES = 15
BETWEEN_KEYS_S = 1.3
SSH = "192.0.2.1 50000 192.0.2.2 22"


def key_answers_s(terminal: Terminal) -> list[float]:
    """Return the times from F1 to the first line of the help."""
    answers = []
    for _press in range(PRESSES):
        time.sleep(BETWEEN_KEYS_S)
        pressed_s = time.monotonic()
        terminal.press("f1")
        terminal.wait_for("Keys of this screen", 60)
        answers.append(time.monotonic() - pressed_s)
        terminal.press("escape")
        terminal.wait_for(TOPIC, 60)
    return answers


def turn(ssh: str, line: int) -> tuple[str, ...]:
    """Return kB/s to the terminal, pictures/s if some are left out, and the median and the longest key delay."""
    with tempfile.TemporaryDirectory() as name:
        profile = Path(name, "pan.yaml")
        profile.write_text(PROFILE.format(python=sys.executable, root=ROOT, topic=TOPIC))
        with deck(Path(name), str(profile), domain=DOMAIN, size=SIZE, SSH_CONNECTION=ssh) as terminal:
            terminal.wait_for("1/1")
            terminal.press("f3")
            terminal.wait_for(TOPIC)
            terminal.type("/image_raw\r")
            terminal.wait_for("640×480")
            terminal.bytes_per_s = line
            time.sleep(WARM_UP_S)
            before, began_s = terminal.received, time.monotonic()
            time.sleep(MEASURE_S)
            rate = (terminal.received - before) / (time.monotonic() - began_s)
            shown = re.search(r"640×480 · ([\d.]+) of [\d.]+ Hz", terminal.text())
            answers = key_answers_s(terminal)
    pictures = shown[1] if shown else "as ever"
    return f"{rate / 1000:.0f}", pictures, f"{median(answers):.2f}", f"{max(answers):.2f}"


def main() -> None:
    """Measure all cases and print the results."""
    print(f"640x480 at 15 Hz at {SIZE[0]}x{SIZE[1]}; {PRESSES} presses of F1 each\n")
    cases = {(speed, way): turn(ssh, line)
             for speed, line in (("any speed", 0), ("64 kB/s", 64_000))
             for way, ssh in (("no limit", ""), ("over SSH", SSH))}  # fmt: skip
    table(
        ("line to the terminal", "kB/s", "pictures a second", "a key, median s", "longest s"),
        *((", ".join(case), *figures) for case, figures in cases.items()),
    )


if __name__ == "__main__":
    main()
