"""Notice that whoever started this process is done with it: its stdin ends."""

from __future__ import annotations

import sys
import threading


def watch_stdin() -> threading.Event:
    """Return an event that is set once stdin has ended."""
    ended = threading.Event()

    def read() -> None:
        sys.stdin.read()
        ended.set()

    threading.Thread(target=read, daemon=True).start()
    return ended
