"""CPU and memory of processes, and CPU of the machine, read from /proc; programs for a measurement."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from launcher.domain.discovery import set_discovery
from launcher.processes.table import processes

ROOT = Path(__file__).resolve().parents[1]
TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def cpu_s(pids: Iterable[int]) -> float:
    """Return the CPU time that the processes have used so far, user and system, in seconds."""
    ticks = 0
    for pid in pids:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        ticks += int(fields[11]) + int(fields[12])
    return ticks / TICKS_PER_S


def pss_mb(pids: Iterable[int]) -> float:
    """Return the total proportional set size of the processes, in megabytes (10^6 bytes)."""
    return sum(_pss_bytes(pid) for pid in pids) / 1e6


def stolen_s() -> float:
    """Return the CPU time that the host has withheld from this virtual machine, in seconds."""
    fields = Path("/proc/stat").read_text().split(maxsplit=10)
    return int(fields[8]) / TICKS_PER_S


def descendants(pid: int) -> list[int]:
    """Return a process and all its descendants."""
    table = list(processes())
    found = [pid]
    for parent in found:
        found += [process.pid for process in table if process.parent == parent]
    return found


def command(pid: int) -> str:
    """Return the command line of a process, with blanks between the arguments."""
    return Path(f"/proc/{pid}/cmdline").read_bytes().replace(b"\0", b" ").decode().strip()


def _pss_bytes(pid: int) -> int:
    try:
        text = Path(f"/proc/{pid}/smaps_rollup").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return 0  # it has just ended
    match = re.search(r"^Pss:\s+(\d+) kB", text, re.MULTILINE)
    return int(match[1]) * 1024 if match else 0


@contextmanager
def running(*argv: str, domain: int) -> Iterator[None]:
    """Run a Python program in a domain, and end it by SIGTERM."""
    env = {**os.environ, "ROS_DOMAIN_ID": str(domain)}
    set_discovery(env, "localhost")
    nowhere = subprocess.DEVNULL
    process = subprocess.Popen(
        [sys.executable, *argv], cwd=ROOT, env=env, stdin=nowhere, stdout=nowhere, stderr=nowhere
    )
    try:
        yield
    finally:
        process.terminate()
        process.wait(30)


def stdin_closed() -> threading.Event:
    """Return an event that is set once stdin is closed, by the end of whoever has started this."""
    ended = threading.Event()

    def read() -> None:
        sys.stdin.read()
        ended.set()

    threading.Thread(target=read, daemon=True).start()
    return ended
