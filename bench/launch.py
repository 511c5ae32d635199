"""Starting lesson 9 with Deck, compared with starting the same nodes by `&` in a shell, in turns.

`python -m bench.launch` prints the time until all nodes are in the ROS graph, as seen by an
observer that was there before, the CPU time used until then, and the memory 5 s later. All of
Deck's own processes are counted, including the client or screen; memory is also given for the nodes
alone. `deck run` starts from scratch; with the list of lessons open, Deck has had time to prepare.
"""

from __future__ import annotations

import json
import os
import shlex
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from bench.processes import cpu_s, pss_mb
from launcher.domain.discovery import set_discovery
from launcher.processes.table import processes
from launcher.profile.load import load_profile
from tests.e2e.terminal import Terminal

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from launcher.profile.load import Profile

DOMAIN = int(os.environ.get("BENCH_DOMAIN", "79"))
ROUNDS = int(os.environ.get("BENCH_ROUNDS", "7"))
SETTLE_S = 5.0
READING_S = 4.0
"""The least time that a person needs to read the list of lessons."""
SHELL, DECK, PICKER = "`&` in a shell", "deck run", "Enter in the picker"


@dataclass(frozen=True)
class Started:
    """A start in progress."""

    pid: int
    began_s: float
    """Monotonic."""
    used_s: float = 0.0
    """CPU time used before the start."""


@dataclass(frozen=True)
class Figures:
    """The figures of one start."""

    ready_s: float
    cpu_s: float
    pss_mb: float
    nodes_pss_mb: float


def environment() -> dict[str, str]:
    """Return the environment for all processes here."""
    return {**os.environ, "ROS_DOMAIN_ID": str(DOMAIN), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


@contextmanager
def watch(names: Sequence[str]) -> Iterator[subprocess.Popen[str]]:
    """Run the observer, which announces itself often, so that it discovers nodes quickly.

    Each start has a new one: an old observer may still see nodes of the previous turn.
    """
    quick = environment()
    set_discovery(quick, "localhost")
    process = subprocess.Popen(
        [sys.executable, "-m", "bench.graph_watch", *names],
        env=quick,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout is not None
        process.stdout.readline()
        yield process
    finally:
        process.communicate(timeout=30)


@contextmanager
def by_shell(profile: Profile) -> Iterator[Started]:
    """Start the nodes as a user would by hand, all at once."""
    lines = [f"{shlex.join(node.argv())} &" for node in profile.nodes.values()]
    began = time.monotonic()
    process = subprocess.Popen(
        ["bash", "-c", "\n".join([*lines, "wait"])],
        env=environment(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        yield Started(process.pid, began)
    finally:
        for pid in descendants(process.pid):
            os.kill(pid, signal.SIGTERM)
        process.wait(30)


@contextmanager
def by_deck(profile: Profile) -> Iterator[Started]:
    """Start the profile with `deck run`."""
    began = time.monotonic()
    process = subprocess.Popen(
        [sys.executable, "-m", "tui", "run", str(profile.path), "--domain", str(DOMAIN)],
        env=environment(),
        stdout=subprocess.DEVNULL,
    )
    try:
        yield Started(process.pid, began)
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(30)


@contextmanager
def by_picker(profile: Profile) -> Iterator[Started]:
    """Press Enter in the list of lessons, in which this lesson is preselected as the last one."""
    argv = [sys.executable, "-m", "tui", "--domain", str(profile.domain), "--lang", "en"]
    config = tempfile.TemporaryDirectory()
    settings = Path(config.name) / "deck" / "settings.json"
    settings.parent.mkdir()
    settings.write_text(json.dumps({"lesson": profile.path.stem, "tour": "seen"}))
    terminal = Terminal(argv, 120, 40, {**environment(), "XDG_CONFIG_HOME": config.name})
    try:
        terminal.wait_for(profile.document.title["en"])
        time.sleep(READING_S)
        pid = terminal.process.pid
        started = Started(pid, time.monotonic(), cpu_s(descendants(pid)))
        terminal.press("enter")
        yield started
    finally:
        terminal.press("ctrl+q")
        terminal.process.wait(30)
        terminal.close()
        config.cleanup()


STARTERS = {SHELL: by_shell, DECK: by_deck, PICKER: by_picker}


def descendants(pid: int) -> list[int]:
    """Return a process and all its descendants."""
    table = list(processes())
    found = [pid]
    for parent in found:
        found += [process.pid for process in table if process.parent == parent]
    return found


def is_node(pid: int) -> bool:
    """Whether a process is a node, and not the shell or a process of Deck."""
    words = Path(f"/proc/{pid}/cmdline").read_bytes()
    return b"nodes." in words and not words.startswith(b"bash")


def measure(kind: str, profile: Profile) -> Figures:
    with watch(list(profile.nodes)) as watcher:
        assert watcher.stdout is not None
        with STARTERS[kind](profile) as started:
            seen = watcher.stdout.readline()
            if not seen:
                sys.exit(f"{kind}: not all nodes came")
            ready_s = float(seen) - started.began_s
            used_s = cpu_s(descendants(started.pid)) - started.used_s
            time.sleep(SETTLE_S)
            everything = descendants(started.pid)
            nodes = [pid for pid in everything if is_node(pid)]
            return Figures(ready_s, used_s, pss_mb(everything), pss_mb(nodes))


def main() -> None:
    """Take turns, and print medians and their ratios."""
    profile = load_profile("profiles/09-brain.yaml", domain=DOMAIN)
    taken: dict[str, list[Figures]] = {kind: [] for kind in STARTERS}
    for _round in range(ROUNDS):
        for kind, figures in taken.items():
            figures.append(measure(kind, profile))
            print(kind, figures[-1], file=sys.stderr, flush=True)
    print(f"{'':26}{'ready s':>10}{'CPU s':>10}{'PSS MB':>10}{'nodes MB':>10}")
    rows = {kind: medians(figures) for kind, figures in taken.items()}
    for kind, row in rows.items():
        print_row(kind, row)
    for kind in (DECK, PICKER):
        print_row(f"ratio, {kind}", [deck / shell for deck, shell in zip(rows[kind], rows[SHELL], strict=True)])


def print_row(name: str, values: Iterable[float]) -> None:
    """Print one line of the table."""
    print(f"{name:26}" + "".join(f"{value:10.2f}" for value in values))


def medians(figures: list[Figures]) -> list[float]:
    """Return the median of each column."""
    columns = zip(*(vars(one).values() for one in figures), strict=True)
    return [statistics.median(column) for column in columns]


if __name__ == "__main__":
    main()
