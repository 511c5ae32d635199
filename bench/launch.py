"""Starting lesson 9 with Deck, compared with starting the same nodes by `&` in a shell, in turns.

`python -m bench.launch` prints the time until all nodes are in the ROS graph, as seen by an observer that has been
there for a second, and the CPU time used until then, all of Deck's own processes included. Every round has each
start once, in another order than the round before; what counts is the ratio within a round. `deck run` starts from
scratch; with the list of lessons open, Deck has had time to prepare.
"""

from __future__ import annotations

import math
import os
import shlex
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from bench.processes import cpu_s, deck, environment, family, running, table
from launcher.profile.load import load_profile

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rclpy.node import Node

DOMAIN = int(os.environ.get("BENCH_DOMAIN", "79"))
ROUNDS = int(os.environ.get("BENCH_ROUNDS", "15"))
PROFILE = load_profile("profiles/09-brain.yaml", domain=DOMAIN)
OBSERVED_S = 1.0
"""An observer that has just joined announces itself more often than later."""
READING_S = 4.0
"""The least time that a person needs to read the list of lessons."""
LOOK_S, WITHIN_S = 0.005, 60.0
SHELL = "`&` in a shell"


class Started(NamedTuple):
    """A start in progress."""

    pid: int
    at_s: float
    """When, on the monotonic clock."""
    cpu_s: float = 0.0
    """CPU time used before."""


@contextmanager
def observer() -> Iterator[Node]:
    """Join anew: who has been there for longer may still see nodes of the turn before."""
    import rclpy
    from rclpy.context import Context

    context = Context()
    context.init(args=[], domain_id=DOMAIN)
    node = rclpy.create_node("_watch", context=context, enable_rosout=False, start_parameter_services=False)
    try:
        time.sleep(OBSERVED_S)
        yield node
    finally:
        node.destroy_node()
        context.try_shutdown()


@contextmanager
def by_shell() -> Iterator[Started]:
    """Start the nodes as a user would by hand, all at once."""
    lines = [f"{shlex.join(node.argv())} &" for node in PROFILE.nodes.values()]
    command, quiet = ["bash", "-c", "\n".join([*lines, "wait"])], subprocess.DEVNULL
    began_s = time.monotonic()
    with subprocess.Popen(command, env=environment(DOMAIN), stdout=quiet, stderr=quiet) as process:
        yield Started(process.pid, began_s)
        for each in family(process.pid):
            each.terminate()


@contextmanager
def by_deck() -> Iterator[Started]:
    """Start the profile with `deck run`."""
    began_s = time.monotonic()
    with running("-m", "tui", "run", str(PROFILE.path), "--domain", str(DOMAIN), domain=DOMAIN) as process:
        yield Started(process.pid, began_s)
        process.send_signal(signal.SIGINT)
        process.wait(30)


@contextmanager
def by_list() -> Iterator[Started]:
    """Press Enter in the list of lessons, in which this lesson is preselected as the last one."""
    with (
        tempfile.TemporaryDirectory() as folder,
        deck(Path(folder), domain=DOMAIN, lesson=PROFILE.path.stem) as terminal,
    ):
        terminal.wait_for(PROFILE.title["en"])
        time.sleep(READING_S)
        pid = terminal.process.pid
        started = Started(pid, time.monotonic(), cpu_s(family(pid)))
        terminal.press("enter")
        yield started
        terminal.press("ctrl+q")
        terminal.process.wait(30)


STARTERS = {SHELL: by_shell, "deck run": by_deck, "Enter in the list": by_list}


def measure(kind: str) -> tuple[float, float]:
    """Return the seconds until all nodes are seen, and the CPU seconds used until then."""
    with observer() as node, STARTERS[kind]() as started:
        while set(PROFILE.nodes) - {name for name, _ in node.get_node_names_and_namespaces()}:
            if time.monotonic() - started.at_s > WITHIN_S:
                sys.exit(f"{kind}: not all nodes came within {WITHIN_S:g} s")
            time.sleep(LOOK_S)
        return time.monotonic() - started.at_s, cpu_s(family(started.pid)) - started.cpu_s


def interval(values: Sequence[float]) -> tuple[float, float]:
    """Return where the median lies with 95 %, by counting signs: nothing is assumed of how the values spread."""
    ordered, count = sorted(values), len(values)
    tails = [sum(math.comb(count, k) for k in range(rank + 1)) / 2**count for rank in range(count // 2)]
    rank = sum(tail <= 0.025 for tail in tails)
    return ordered[max(0, rank - 1)], ordered[min(count - 1, count - rank)]


def compared(values: Sequence[float], others: Sequence[float]) -> tuple[str, str, str]:
    """Return the median, that of the ratios to others, and where it lies."""
    ratios = [one / other for one, other in zip(values, others, strict=True)]
    low, high = interval(ratios)
    return f"{statistics.median(values):.2f}", f"{statistics.median(ratios):.2f}", f"{low:.2f} to {high:.2f}"


def main() -> None:
    """Take turns, and print medians and ratios."""
    taken: dict[str, list[tuple[float, float]]] = {kind: [] for kind in STARTERS}
    kinds = list(STARTERS)
    for number in range(ROUNDS):
        for kind in kinds[number % 3 :] + kinds[: number % 3]:
            taken[kind].append(measure(kind))
            print(kind, taken[kind][-1], file=sys.stderr, flush=True)
    print(f"{ROUNDS} rounds; load of the machine {os.getloadavg()[0]:.1f}; goal: 0.5 of `&`, below 0.6\n")
    seen, cpu = ({kind: [one[at] for one in figures] for kind, figures in taken.items()} for at in (0, 1))
    table(
        ("", "all nodes seen, s", "of `&`, within a round", "95 %", "CPU, s", "of `&`", "95 %"),
        *((kind, *compared(seen[kind], seen[SHELL]), *compared(cpu[kind], cpu[SHELL])) for kind in kinds),
    )


if __name__ == "__main__":
    main()
