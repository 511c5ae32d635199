"""The time from the space bar in `deck` to the emergency stop on the wire to the Pico.

`python -m bench.space_bar` prints a table: the screen runs all of lesson 9, plus the chassis
driver.
"""

from __future__ import annotations

import json
import os
import random
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

from bench.driving import ROOT, row, wait_for
from bench.emulated import Pico
from bench.screen import deck

if TYPE_CHECKING:
    from tests.e2e.terminal import Terminal

TRIALS = int(os.environ.get("BENCH_ROUNDS", "60"))
AGAIN_S = 1.0


def write_profile(folder: Path) -> Path:
    """Write a profile of lesson 9 plus the chassis."""
    chassis = {"run": "nodes.chassis", "params": {"port": str(folder / "pico")}}
    document = {
        "extends": str(ROOT / "profiles" / "09-brain.yaml"),
        "title": {"en": "Space"},
        "nodes": {"chassis": chassis},
    }
    path = folder / "space.yaml"
    path.write_text(json.dumps(document))
    return path


def release(terminal: Terminal, pico: Pico) -> None:
    """Release the emergency stop, trying until it works."""
    began_s = time.monotonic()
    while pico.released(began_s) is None:
        terminal.press("ctrl+r")
        until_s = time.monotonic() + AGAIN_S
        while pico.released(began_s) is None and time.monotonic() < until_s:
            time.sleep(0.01)


def trials(terminal: Terminal, pico: Pico, count: int) -> list[float]:
    """Return the seconds from the key to the line, for each trial."""
    dice, taken = random.Random(2), []
    for _ in range(count):
        time.sleep(dice.uniform(0.3, 0.6))
        pressed_s = time.monotonic()
        terminal.press("space")
        taken.append(wait_for(pico.halted, pressed_s) - pressed_s)
        time.sleep(dice.uniform(0.3, 0.6))
        release(terminal, pico)
    return taken


def main() -> None:
    """Measure, and print the results."""
    with tempfile.TemporaryDirectory() as name, Pico(Path(name) / "pico") as pico:
        folder = Path(name)
        with deck(folder, str(write_profile(folder))) as terminal:
            terminal.wait_for("10/10")
            wait_for(pico.stopped, time.monotonic())
            taken = trials(terminal, pico, TRIALS)
    print(f"{TRIALS} presses; load of the machine {os.getloadavg()[0]:.1f}\n")
    print("| | median, ms | 99th percentile, ms | longest, ms | goal, ms |")
    print("| --- | --- | --- | --- | --- |")
    print(row("space bar to emergency stop on the wire", taken, 30))


if __name__ == "__main__":
    main()
