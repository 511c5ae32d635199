"""Finding every process that descends from a test's `deck`, whoever its parent is by now."""

from __future__ import annotations

import os
import re
import uuid
from pathlib import Path

VARIABLE = "E2E_MARK"

NODE_TITLE = re.compile(r"deck: \w+ \(nodes\.\w+\)")


def new_mark() -> str:
    """A value for the environment variable `E2E_MARK` that no other test has."""
    return uuid.uuid4().hex


def alive(mark: str) -> dict[int, str]:
    """Pid to command line of all live processes that inherited the mark, zombies left out."""
    wanted = f"{VARIABLE}={mark}".encode()
    found = {}
    for folder in Path("/proc").iterdir():
        if not folder.name.isdigit() or int(folder.name) == os.getpid():
            continue
        try:
            if wanted not in (folder / "environ").read_bytes().split(b"\0"):
                continue
            command = (folder / "cmdline").read_bytes().replace(b"\0", b" ").decode().strip()
        except OSError:  # it has just ended
            continue
        if command:
            found[int(folder.name)] = command
    return found


def nodes(mark: str) -> dict[int, str]:
    """Like `alive`, the nodes only."""
    return {pid: line for pid, line in alive(mark).items() if NODE_TITLE.match(line)}


def observer(mark: str) -> int:
    """The process that watches the graph for a screen."""
    program = "graph.observer.process"
    (pid,) = (pid for pid, line in alive(mark).items() if program in line)
    return pid
