"""What is measured, started: programs in a ROS domain, Deck in a terminal; and what processes take."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import psutil

from launcher.domain.discovery import set_discovery
from tests.e2e.terminal import Terminal, own_folders

ROOT = Path(__file__).resolve().parents[1]
OF_THE_SCREEN = ("observer.process", "launcher.supervisor")


def family(pid: int) -> list[psutil.Process]:
    """Return a process and all its descendants."""
    process = psutil.Process(pid)
    return [process, *process.children(recursive=True)]


def of_the_screen(terminal: Terminal) -> list[psutil.Process]:
    """Return the screen, its observer, guardian and supervisor, without server and nodes."""
    screen, *others = family(terminal.process.pid)
    return [screen, *(one for one in others if any(mark in " ".join(one.cmdline()) for mark in OF_THE_SCREEN))]


def cpu_s(processes: Iterable[psutil.Process]) -> float:
    """Return the CPU time that the processes have used so far, user and system, in seconds."""
    return sum(sum(process.cpu_times()[:2]) for process in processes)


def pss_mb(processes: Iterable[psutil.Process]) -> float:
    """Return the total proportional set size of the processes, in megabytes (10^6 bytes)."""
    return sum(process.memory_full_info().pss for process in processes) / 1e6


def environment(domain: int) -> dict[str, str]:
    env = {**os.environ, "ROS_DOMAIN_ID": str(domain)}
    set_discovery(env, "localhost")
    return env


@contextmanager
def running(*argv: str, domain: int) -> Iterator[subprocess.Popen[bytes]]:
    """Run a Python program in a domain, and end it by SIGTERM."""
    command, env, quiet = (sys.executable, *argv), environment(domain), subprocess.DEVNULL
    with subprocess.Popen(command, cwd=ROOT, env=env, stdin=quiet, stdout=quiet, stderr=quiet) as process:
        try:
            yield process
        finally:
            process.terminate()


@contextmanager
def deck(
    folder: Path, *args: str, domain: int, size: tuple[int, int] = (120, 40), lesson: str = "", **env: str
) -> Iterator[Terminal]:
    """Run the program in a terminal with its own directories; `lesson`: the one that was open last."""
    settings = folder / "config" / "deck" / "settings.json"
    settings.parent.mkdir(parents=True, exist_ok=True)
    settings.write_text(json.dumps({"tour": "seen", "lesson": lesson}))
    argv = [sys.executable, "-m", "tui", *args, "--domain", str(domain), "--lang", "en"]
    # Over SSH, pictures would be limited.
    own = own_folders(folder, DECK_COURSE=str(folder / "course"), **{"SSH_CONNECTION": "", **env})
    terminal = Terminal(argv, *size, own)
    try:
        yield terminal
    finally:
        terminal.close()


def table(*rows: Iterable[object]) -> None:
    """Print a table, its head first."""
    head, *others = rows
    for row in (head, ["---" for _ in head], *others):
        print("|", " | ".join(map(str, row)), "|")
