"""A signal ends a command whatever its main thread is about in that moment."""

from __future__ import annotations

import subprocess
import sys

WAITS = """
import os, signal, threading
from launcher.processes.ending import ENDING, stop_by_signals

def send(number):
    os.kill(os.getpid(), number)

for round in range(300):
    stop = stop_by_signals()
    threading.Timer(0.0001 * (round % 7), send, (ENDING[round % 3],)).start()
    while not stop.wait(0):
        pass
print("ended each time")
"""
"""It looks without a pause: most signals come while it holds a lock of the event."""


def test_it_ends_while_it_looks_whether_it_is_to_end() -> None:
    ran = subprocess.run(
        [sys.executable, "-c", WAITS], capture_output=True, text=True, timeout=60, check=False
    )
    assert (ran.returncode, ran.stdout) == (0, "ended each time\n"), ran.stderr
