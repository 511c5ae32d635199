"""Moving pictures and key presses on a line of 64 kB/s: `python -m bench.slow_line`.

A camera pans over a landscape, 640x480 at 15 Hz, on the Topics screen at 160x45: nearly every cell
changes with every picture.
"""

from __future__ import annotations

import os
import re
import statistics
import sys
import tempfile
import time
from pathlib import Path

from bench.processes import ROOT
from tests.e2e.panning_camera import PROFILE, TOPIC
from tests.e2e.terminal import Terminal, own_folders

DOMAIN = os.environ.get("BENCH_DOMAIN", "79")
COLUMNS, ROWS = 160, 45
LINE = 64_000
WARM_UP_S = 15.0
"""Long enough for the queue to the line to reach its maximum."""
MEASURE_S = 10.0
PRESSES = 15
BETWEEN_KEYS_S = 1.3
SSH = {"SSH_CONNECTION": "192.0.2.1 50000 192.0.2.2 22"}
CASES: tuple[tuple[str, dict[str, str], int], ...] = (
    ("any speed, no limit", {}, 0),
    ("any speed, over SSH", SSH, 0),
    ("64 kB/s, no limit", {}, LINE),
    ("64 kB/s, over SSH", SSH, LINE),
)


def open_picture(folder: Path, env: dict[str, str]) -> Terminal:
    """Return the program, with the camera's picture on the screen."""
    profile = folder / "pan.yaml"
    profile.write_text(PROFILE.format(python=sys.executable, root=ROOT, topic=TOPIC))
    own = own_folders(folder, SSH_CONNECTION="")
    argv = [sys.executable, "-m", "tui", str(profile), "--domain", DOMAIN, "--lang", "en"]
    terminal = Terminal(argv, COLUMNS, ROWS, {**own, **env})
    terminal.wait_for("1/1")
    terminal.press("f3")
    terminal.wait_for(TOPIC)
    terminal.press("/")
    terminal.type("image_raw\r")
    terminal.wait_for("640×480")
    return terminal


def key_answers_s(terminal: Terminal) -> list[float]:
    """Return the times from F1 to the first line of the help."""
    answers = []
    for _press in range(PRESSES):
        time.sleep(BETWEEN_KEYS_S)
        pressed = time.monotonic()
        terminal.press("f1")
        terminal.wait_for("Keys of this screen", 60)
        answers.append(time.monotonic() - pressed)
        terminal.press("escape")
        terminal.wait_for(TOPIC, 60)
    return answers


def turn(env: dict[str, str], line: int) -> tuple[float, str, list[float]]:
    """Return bytes/s to the terminal, pictures/s if some are left out, and key delays."""
    with tempfile.TemporaryDirectory() as name:
        terminal = open_picture(Path(name), env)
        try:
            terminal.bytes_per_s = line
            time.sleep(WARM_UP_S)
            before, begun = terminal.received, time.monotonic()
            time.sleep(MEASURE_S)
            rate = (terminal.received - before) / (time.monotonic() - begun)
            shown = re.search(r"640×480 · ([\d.]+) of [\d.]+ Hz", terminal.text())
            return rate, shown[1] if shown else "as ever", key_answers_s(terminal)
        finally:
            terminal.close()


def main() -> None:
    """Measure all cases and print the results."""
    print(f"640x480 at 15 Hz at {COLUMNS}x{ROWS}; {PRESSES} presses of F1 each")
    print("| line to the terminal | kB/s | pictures a second | a key, median s | longest s |")
    print("| --- | --- | --- | --- | --- |")
    for name, env, line in CASES:
        rate, shown, answers = turn(env, line)
        median, longest = statistics.median(answers), max(answers)
        print(f"| {name} | {rate / 1000:.0f} | {shown} | {median:.2f} | {longest:.2f} |")


if __name__ == "__main__":
    main()
