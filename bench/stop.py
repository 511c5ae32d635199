"""The time from a sonar frame below the threshold, and from the space bar, to the stop at the Pico.

`python -m bench.stop` prints a table. This process emulates the devices, on pseudo-terminals. For the reflex, the
nodes of profiles/robot.yaml are between them, and all of lesson 9 runs as well. For the key, the screen runs lesson 9
and the chassis.
"""

from __future__ import annotations

import contextlib
import json
import os
import random
import statistics
import sys
import tempfile
import threading
import time
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from bench.processes import ROOT, deck, running, table
from launcher.profile.load import load_profile
from nodes.simulated.devices import PseudoSerial
from robot.wire.pico import Drive, Halt, PicoDecoder, Release
from robot.wire.tfluna import TofFrame
from robot.wire.tfluna import encode as encode_tof
from robot.world.boards import SimulatedPico
from robot.world.world import STEP_S, World

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from robot.wire.pico import Message
    from tests.e2e.terminal import Terminal

DOMAIN = int(os.environ.get("BENCH_DOMAIN", "76"))
STOPS = int(os.environ.get("BENCH_ROUNDS", "200"))
PRESSES = int(os.environ.get("BENCH_ROUNDS", "60"))
PORTS = {"sonar_front": "tof_front", "sonar_rear": "tof_rear", "chassis": "pico"}
CHAIN = (*PORTS, "safety_stop", "electronic_differential")
FAR_M, NEAR_M = 3.0, 0.3
LONGEST_S, AGAIN_S, LOOK_S = 60.0, 1.0, 0.0005


class Pico:
    """The simulated Pico on a serial line; records every line that it receives, with its time."""

    def __init__(self, port: PseudoSerial) -> None:
        self.heard: list[tuple[float, Message]] = []
        self._port = port
        self._pico = SimulatedPico(World())
        self._decoder = PicoDecoder()

    def first(self, since_s: float, fits: Callable[[Message], bool]) -> float | None:
        """Return the time of the first such line after this; None if none came."""
        return next((at_s for at_s, line in tuple(self.heard) if at_s >= since_s and fits(line)), None)

    def wait(self, since_s: float, fits: Callable[[Message], bool]) -> float:
        """Wait for such a line; return the time of its arrival."""
        while (at_s := self.first(since_s, fits)) is None:
            if time.monotonic() - since_s > LONGEST_S:
                raise RuntimeError(f"nothing within {LONGEST_S:g} s")
            time.sleep(0.002)
        return at_s

    def live(self, ended: threading.Event) -> None:
        """Read nearly at once, and take a step of the simulation whenever one is due."""
        due_s = time.monotonic()
        while not ended.is_set():
            due_s += STEP_S
            while time.monotonic() < due_s:
                data, now_s = self._port.read(), time.monotonic()
                self.heard += [(now_s, line) for line in self._decoder.feed(data)]
                self._pico.feed(data)
                time.sleep(LOOK_S)
            self._port.write(self._pico.step())
            self._pico.world.step()


class Sonar:
    """A TF-Luna that measures `metres`, 100 times a second."""

    def __init__(self, port: PseudoSerial) -> None:
        self.metres = FAR_M
        self.told_s: dict[float, float] = {}
        """When each distance was first sent since this was cleared."""
        self._port = port

    def live(self, ended: threading.Event) -> None:
        while not ended.wait(0.01):
            metres = self.metres
            self.told_s.setdefault(metres, time.monotonic())
            self._port.write(encode_tof(TofFrame(round(100 * metres), 1000, 25.0)))


@contextmanager
def devices(folder: Path) -> Iterator[tuple[Pico, Sonar]]:
    """Emulate the Pico and both sonars, each on a thread and under its name in the folder."""
    ended = threading.Event()
    ports = [PseudoSerial(folder / name) for name in ("pico", "tof_front", "tof_rear")]
    pico, front, rear = Pico(ports[0]), Sonar(ports[1]), Sonar(ports[2])
    threads = [threading.Thread(target=device.live, args=(ended,)) for device in (pico, front, rear)]
    for thread in threads:
        thread.start()
    try:
        yield pico, front
    finally:
        ended.set()
        for thread, port in zip(threads, ports, strict=True):
            thread.join()
            port.unplug()


def drives(line: Message) -> bool:
    """Whether a command turns the wheels."""
    return isinstance(line, Drive) and line.left_rad_s != 0


def stands(line: Message) -> bool:
    """Whether a command stops the wheels."""
    return isinstance(line, Drive) and line.left_rad_s == 0


@contextmanager
def nodes(folder: Path) -> Iterator[None]:
    """Run the robot's nodes that lie between sonar and Pico, and a commander that drives ahead."""
    specs = load_profile(ROOT / "profiles" / "robot.yaml").nodes
    with ExitStack() as stack:
        for name in CHAIN:
            own = dict(specs[name].params)
            if name in PORTS:
                own["port"] = str(folder / PORTS[name])
            stack.enter_context(running(*replace(specs[name], params=own).argv()[1:], domain=DOMAIN))
        stack.enter_context(running("-m", "bench.stop", "command", domain=DOMAIN))
        yield


def command() -> None:
    """Publish 0.3 m/s ahead on /drive, ten times a second, until a signal."""
    import rclpy
    from ackermann_msgs.msg import AckermannDriveStamped
    from rclpy.executors import ExternalShutdownException

    rclpy.init()
    node = rclpy.create_node("commander")
    publisher = node.create_publisher(AckermannDriveStamped, "/drive", 10)
    message = AckermannDriveStamped()
    message.drive.speed = 0.3

    def publish() -> None:
        message.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(message)

    node.create_timer(0.1, publish)
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)


def reflex_s(pico: Pico, front: Sonar) -> list[float]:
    """Return the seconds from frame to line, for each trial."""
    dice, taken = random.Random(1), []
    for _ in range(STOPS):
        pico.wait(time.monotonic(), drives)
        time.sleep(dice.uniform(0.1, 0.3))
        front.told_s.clear()
        front.metres = NEAR_M
        while NEAR_M not in front.told_s:
            time.sleep(0.001)
        told_s = front.told_s[NEAR_M]
        taken.append(pico.wait(told_s, stands) - told_s)
        front.metres = FAR_M
    return taken


def key_s(terminal: Terminal, pico: Pico) -> list[float]:
    """Return the seconds from the space bar to the line, for each trial; each stop is released."""
    dice, taken = random.Random(2), []
    for _ in range(PRESSES):
        time.sleep(dice.uniform(0.3, 0.6))
        pressed_s = time.monotonic()
        terminal.press("space")
        taken.append(pico.wait(pressed_s, lambda line: isinstance(line, Halt)) - pressed_s)
        time.sleep(dice.uniform(0.3, 0.6))
        began_s = again_s = time.monotonic()
        while pico.first(began_s, lambda line: isinstance(line, Release)) is None:
            if time.monotonic() >= again_s:
                terminal.press("ctrl+r")
                again_s = time.monotonic() + AGAIN_S
            time.sleep(0.01)
    return taken


def by_key() -> list[float]:
    """Run lesson 9 and the chassis on the screen, and press."""
    with tempfile.TemporaryDirectory() as name, devices(Path(name)) as (pico, _front):
        profile = Path(name, "space.yaml")
        chassis = {"run": "nodes.chassis", "params": {"port": str(Path(name, "pico"))}}
        document = {"extends": str(ROOT / "profiles" / "09-brain.yaml"), "title": {"en": "Space"}}
        profile.write_text(json.dumps({**document, "nodes": {"chassis": chassis}}))
        with deck(Path(name), str(profile), domain=DOMAIN) as terminal:
            terminal.wait_for("10/10")
            pico.wait(time.monotonic(), stands)
            return key_s(terminal, pico)


def row(name: str, seconds: Sequence[float], goals_ms: str) -> list[str]:
    late = sorted(seconds)[min(len(seconds) - 1, int(0.99 * len(seconds)))]
    return [name, *(f"{1000 * value:.1f}" for value in (statistics.median(seconds), late, max(seconds))), goals_ms]


def main() -> None:
    """Measure both."""
    beside = running("-m", "tui", "run", "09-brain", "--domain", str(DOMAIN + 1), domain=DOMAIN + 1)
    with tempfile.TemporaryDirectory() as name, beside, devices(Path(name)) as (pico, front), nodes(Path(name)):
        robot = reflex_s(pico, front)
    keys = by_key()
    print(f"{STOPS} stops and {PRESSES} presses; load of the machine {os.getloadavg()[0]:.1f}\n")
    table(
        ("to the stop at the Pico", "median, ms", "99th percentile, ms", "longest, ms", "goals, ms"),
        row("from a frame: the robot's nodes, lesson 9 beside", robot, "25 / 60"),
        row("from the space bar", keys, "30"),
    )


if __name__ == "__main__":
    command() if len(sys.argv) > 1 else main()
