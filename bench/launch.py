"""Starting lesson 9 with Deck, compared with starting the same nodes by `&` in a shell, in turns.

`python -m bench.launch` prints the time until all nodes are in the ROS graph, as seen by an observer that has been
there for a second, and the CPU time used until then, all of Deck's own processes included. Every round has each
start once, in another order than the round before; what counts is the ratio within a round. `deck run` starts from
scratch; with the list of lessons open, Deck has had time to prepare.

The marks below the table say what waits for what: when the first and the last process of a node was there, and when
the first and the last node was seen.
"""

from __future__ import annotations

import json
import math
import os
import select
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

from bench.processes import TICKS_PER_S, command, cpu_s, descendants
from launcher.domain.discovery import set_discovery
from launcher.profile.load import load_profile
from tests.e2e.terminal import Terminal

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from launcher.profile.load import Profile

DOMAIN = int(os.environ.get("BENCH_DOMAIN", "79"))
ROUNDS = int(os.environ.get("BENCH_ROUNDS", "15"))
OBSERVED_S = 1.0
"""An observer that has just joined announces itself more often than later."""
READING_S = 4.0
"""The least time that a person needs to read the list of lessons."""
LOOK_S, WITHIN_S = 0.005, 60.0
SHELL, DECK, PICKER = "`&` in a shell", "deck run", "Enter in the list"


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
    """One start, in seconds."""

    seen: float
    cpu: float
    first_process: float
    last_process: float
    first_seen: float
    last: str
    """The node that was seen last."""


def environment() -> dict[str, str]:
    """Return the environment for all processes here."""
    return {**os.environ, "ROS_DOMAIN_ID": str(DOMAIN), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


@contextmanager
def observer(names: Sequence[str]) -> Iterator[subprocess.Popen[str]]:
    """Run a new observer: an old one may still see nodes of the turn before."""
    quick = environment()
    set_discovery(quick, "localhost")
    argv = [sys.executable, "-m", "bench.launch", *names]
    process = subprocess.Popen(argv, env=quick, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        process.stdout.readline()
        yield process
    finally:
        process.communicate(timeout=30)


def observe(names: Sequence[str]) -> None:
    """Print `ready`, then a JSON object of name to monotonic time, once all nodes are seen; end with stdin."""
    # Fast DDS prints its errors to stdout.
    told = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)

    import rclpy

    rclpy.init()
    node = rclpy.create_node(f"_watch_{os.getpid()}", enable_rosout=False)
    seen: dict[str, float] = {}
    time.sleep(OBSERVED_S)
    told.write("ready\n")
    deadline_s = time.monotonic() + WITHIN_S
    while missing := set(names) - set(seen):
        there = missing & {name for name, _ in node.get_node_names_and_namespaces()}
        seen |= dict.fromkeys(there, time.monotonic())
        if select.select([sys.stdin], [], [], LOOK_S)[0]:
            return  # nobody waits for the result any more
        if time.monotonic() > deadline_s:
            sys.exit(f"not in the graph within {WITHIN_S:g} s: {', '.join(sorted(missing))}")
    told.write(f"{json.dumps(seen)}\n")
    sys.stdin.read()
    node.destroy_node()
    rclpy.shutdown()


@contextmanager
def by_shell(profile: Profile) -> Iterator[Started]:
    """Start the nodes as a user would by hand, all at once."""
    lines = [f"{shlex.join(node.argv())} &" for node in profile.nodes.values()]
    began_s = time.monotonic()
    process = subprocess.Popen(
        ["bash", "-c", "\n".join([*lines, "wait"])],
        env=environment(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        yield Started(process.pid, began_s)
    finally:
        for pid in descendants(process.pid):
            os.kill(pid, signal.SIGTERM)
        process.wait(30)


@contextmanager
def by_deck(profile: Profile) -> Iterator[Started]:
    """Start the profile with `deck run`."""
    argv = [sys.executable, "-m", "tui", "run", str(profile.path), "--domain", str(DOMAIN)]
    began_s = time.monotonic()
    process = subprocess.Popen(argv, env=environment(), stdout=subprocess.DEVNULL)
    try:
        yield Started(process.pid, began_s)
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(30)


@contextmanager
def by_list(profile: Profile) -> Iterator[Started]:
    """Press Enter in the list of lessons, in which this lesson is preselected as the last one."""
    argv = [sys.executable, "-m", "tui", "--domain", str(DOMAIN), "--lang", "en"]
    with tempfile.TemporaryDirectory() as config:
        settings = Path(config, "deck", "settings.json")
        settings.parent.mkdir()
        settings.write_text(json.dumps({"lesson": profile.path.stem, "tour": "seen"}))
        terminal = Terminal(argv, 120, 40, {**environment(), "XDG_CONFIG_HOME": config})
        try:
            terminal.wait_for(profile.title["en"])
            time.sleep(READING_S)
            pid = terminal.process.pid
            started = Started(pid, time.monotonic(), cpu_s(descendants(pid)))
            terminal.press("enter")
            yield started
        finally:
            terminal.press("ctrl+q")
            terminal.process.wait(30)
            terminal.close()


STARTERS = {SHELL: by_shell, DECK: by_deck, PICKER: by_list}


def begun_s(pid: int) -> float:
    """Return when a process was started, on the monotonic clock and to 10 ms."""
    ticks = int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[19])
    return ticks / TICKS_PER_S + time.monotonic() - time.clock_gettime(time.CLOCK_BOOTTIME)


def measure(kind: str, profile: Profile) -> Figures:
    with observer(list(profile.nodes)) as watching, STARTERS[kind](profile) as started:
        assert watching.stdout is not None
        line = watching.stdout.readline()
        if not line:
            sys.exit(f"{kind}: not all nodes came")
        everything = descendants(started.pid)
        used_s = cpu_s(everything) - started.used_s
        seen: dict[str, float] = json.loads(line)
        nodes = [begun_s(pid) for pid in everything if "nodes." in command(pid) and "bash" not in command(pid)]
    last = max(seen, key=seen.__getitem__)
    times = (seen[last], min(nodes), max(nodes), min(seen.values()))
    ready, first_process, last_process, first_seen = (at_s - started.began_s for at_s in times)
    return Figures(ready, used_s, first_process, last_process, first_seen, last)


def interval(values: Sequence[float]) -> tuple[float, float]:
    """Return where the median lies with 95 %, by counting signs: nothing is assumed of how the values spread."""
    ordered, count = sorted(values), len(values)
    tails = [sum(math.comb(count, k) for k in range(rank + 1)) / 2**count for rank in range(count // 2)]
    rank = sum(tail <= 0.025 for tail in tails)
    return ordered[max(0, rank - 1)], ordered[min(count - 1, count - rank)]


def main() -> None:
    """Take turns, and print medians, ratios and marks."""
    profile = load_profile("profiles/09-brain.yaml", domain=DOMAIN)
    taken: dict[str, list[Figures]] = {kind: [] for kind in STARTERS}
    kinds = list(STARTERS)
    for number in range(ROUNDS):
        for kind in kinds[number % 3 :] + kinds[: number % 3]:
            taken[kind].append(measure(kind, profile))
            print(kind, taken[kind][-1], file=sys.stderr, flush=True)
    print(f"{ROUNDS} rounds; load of the machine {os.getloadavg()[0]:.1f}\n")
    print("| | all nodes seen, s | of `&`, within a round | 95 % | goal | CPU, s | of `&` | 95 % |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for kind, figures in taken.items():
        cells = []
        for column, goal in (("seen", "0.5, below 0.6"), ("cpu", "")):
            ratios = [getattr(a, column) / getattr(b, column) for a, b in zip(figures, taken[SHELL], strict=True)]
            low, high = interval(ratios)
            cells.append(f"{statistics.median(getattr(one, column) for one in figures):.2f}")
            compared = (f"{statistics.median(ratios):.2f}", f"{low:.2f} to {high:.2f}", goal)
            cells += ("1.00", "", "") if kind == SHELL else compared
        print(f"| {kind} | {' | '.join(cells[:-1])} |")
    print("\n| medians, s | first process of a node | last | first node seen | last | most often the last |")
    print("| --- | --- | --- | --- | --- | --- |")
    for kind, figures in taken.items():
        marks = ("first_process", "last_process", "first_seen", "seen")
        cells = [f"{statistics.median(getattr(one, mark) for one in figures):.2f}" for mark in marks]
        print(f"| {kind} | {' | '.join(cells)} | {statistics.mode(one.last for one in figures)} |")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        observe(sys.argv[1:])
    else:
        main()
