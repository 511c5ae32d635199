"""The robot's nodes as started by profiles/robot.yaml, on emulated devices, and a commander."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.domain.discovery import set_discovery
from launcher.profile.load import load_profile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

DOMAIN = int(os.environ.get("BENCH_DOMAIN", "76"))
ROOT = Path(__file__).parents[1]
CHAIN = ("sonar_front", "sonar_rear", "safety_stop", "electronic_differential", "chassis")
PORTS = {"sonar_front": "tof_front", "sonar_rear": "tof_rear", "chassis": "pico"}
LONGEST_S = 60.0


def environment(domain: int = DOMAIN) -> dict[str, str]:
    """Return the environment for all processes here."""
    env = {**os.environ, "ROS_DOMAIN_ID": str(domain)}
    set_discovery(env, "localhost")
    return {**env, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


@contextmanager
def running(argv: Sequence[str], domain: int = DOMAIN) -> Iterator[subprocess.Popen[bytes]]:
    """Run a process and end it by SIGTERM: background processes of a shell ignore SIGINT."""
    process = subprocess.Popen(
        list(argv),
        cwd=ROOT,
        env=environment(domain),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=sys.stderr if os.environ.get("BENCH_LOUD") else subprocess.DEVNULL,
    )
    try:
        yield process
    finally:
        process.terminate()
        process.wait(30)


@contextmanager
def nodes(folder: Path, names: Sequence[str] = CHAIN, **params: int) -> Iterator[dict[str, subprocess.Popen[bytes]]]:
    """Run nodes of the robot on the devices in `folder`; each gets the `params` it knows."""
    specs = load_profile(ROOT / "profiles" / "robot.yaml").nodes
    with ExitStack() as stack:
        started = {}
        for name in names:
            own = dict(specs[name].params)
            if name in PORTS:
                own["port"] = str(folder / PORTS[name])
            if name.startswith("sonar"):
                own.update(params)
            argv = replace(specs[name], params=own).argv()
            started[name] = stack.enter_context(running(argv))
        yield started


@contextmanager
def commander() -> Iterator[None]:
    """Run a commander that drives ahead."""
    with running([sys.executable, "-m", "bench.commander"]):
        yield


@contextmanager
def lesson_9() -> Iterator[None]:
    """Run all of lesson 9 alongside, in its own domain."""
    domain = DOMAIN + 1
    with running([sys.executable, "-m", "tui", "run", "09-brain", "--domain", str(domain)], domain):
        time.sleep(5.0)
        yield


def wait_for(found: Callable[[float], float | None], since_s: float, longest_s: float = LONGEST_S) -> float:
    """Wait for a line that arrives after `since_s`; return the time of its arrival."""
    while (at_s := found(since_s)) is None:
        if time.monotonic() - since_s > longest_s:
            raise RuntimeError(f"nothing within {longest_s:g} s")
        time.sleep(0.002)
    return at_s


def percentile(values: Sequence[float], share: float) -> float:
    """Return the value that this share of the values, 0 to 1, does not exceed."""
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def row(name: str, seconds: Sequence[float], *goals_ms: float) -> str:
    """Return a line of a table: median, 99th percentile and maximum in ms, and the goals."""
    median, late = statistics.median(seconds), percentile(seconds, 0.99)
    figures = " | ".join(f"{1000 * value:.1f}" for value in (median, late, max(seconds)))
    return f"| {name} | {figures} | {' / '.join(f'{goal:g}' for goal in goals_ms) or '-'} |"
