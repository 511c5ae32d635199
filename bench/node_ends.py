"""The time that each lesson node takes from a signal to its end; 1 s is promised.

`python -m bench.node_ends` sends SIGINT and SIGTERM to each, then to the head in the middle of a
movement, and prints the median and the longest time of `BENCH_ROUNDS` rounds.
"""

from __future__ import annotations

import os
import signal
import statistics
import subprocess
import sys
import time
from pathlib import Path

DOMAIN = os.environ.get("BENCH_DOMAIN", "79")
ROUNDS = int(os.environ.get("BENCH_ROUNDS", "3"))
ROOT = Path(__file__).parents[1]
SETTLED_S = 1.0
"""After its first output a node discovers the others, and its timers start."""


def modules() -> list[str]:
    """Return all lesson nodes."""
    files = sorted((ROOT / "nodes").glob("[!_]*.py"))
    return [f"nodes.{file.stem}" for file in files]


def measure(module: str, number: signal.Signals, *arguments: str, moving: bool = False) -> float:
    """Start a node, wait until it works, send the signal; return the seconds until its end."""
    environment = {**os.environ, "ROS_DOMAIN_ID": DOMAIN, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    process = subprocess.Popen(
        [sys.executable, "-m", module, *arguments], cwd=ROOT, env=environment, stderr=subprocess.PIPE
    )
    assert process.stderr is not None
    process.stderr.readline()
    if moving:
        turn_head(environment)
    time.sleep(SETTLED_S)
    began = time.monotonic()
    process.send_signal(number)
    process.stderr.read()
    if process.wait() != 0:
        sys.exit(f"{module} ended with {process.returncode} on {number.name}")
    return time.monotonic() - began


def turn_head(environment: dict[str, str]) -> None:
    """Request a movement of the head, without waiting for its end."""
    program = (
        "import rclpy, time; from example_interfaces.srv import AddTwoInts as S; rclpy.init();"
        "n = rclpy.create_node('asker'); c = n.create_client(S, 'set_head_position');"
        "c.wait_for_service(); c.call_async(S.Request(a=45, b=0)); time.sleep(0.5)"
    )
    subprocess.run([sys.executable, "-c", program], env=environment, check=True)


def report(name: str, times_s: list[float]) -> None:
    """Print one line of the table."""
    median, longest = statistics.median(times_s), max(times_s)
    print(f"{name:32} median {median:5.2f} s   longest {longest:5.2f} s")


def main() -> None:
    """Measure all of them."""
    signals = (signal.SIGINT, signal.SIGTERM)
    for module in modules():
        report(module, [measure(module, number) for number in signals for _ in range(ROUNDS)])
    slow = ("--ros-args", "-p", "move_time:=20.0")
    head = [measure("nodes.head_controller", number, *slow, moving=True) for number in signals for _ in range(ROUNDS)]
    report("head in mid-movement", head)


if __name__ == "__main__":
    main()
