"""Driving by a key that is held in a real terminal: wheels turn, and stand when it is let go."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

import pytest
from sensor_msgs.msg import JointState
from typing_extensions import Self

from tests.e2e.conftest import Deck
from tests.e2e.terminal import Terminal
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

MAX_AGE_S = 0.5
DEADLINE_S = 3.0
"""For half a second of holding on and the same at the gate, on a machine that is busy."""
REPEAT_S = 0.033
ASLEEP_S = 1.5
"""Longer than a key is good for."""


class HeldKey:
    """A key that is held: a terminal sends it again and again, after a while."""

    def __init__(self, terminal: Terminal, key: str) -> None:
        self._terminal, self._key = terminal, key
        self._up = threading.Event()
        self._thread = threading.Thread(target=self._repeat)

    def __enter__(self) -> Self:
        self._terminal.press(self._key)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._up.set()
        self._thread.join()

    def _repeat(self) -> None:
        wait_s = 0.4
        while not self._up.wait(wait_s):
            self._terminal.press(self._key)
            wait_s = REPEAT_S


class Robot:
    """A sonar that sees a free way, the gate, the differential; and what the wheels are told."""

    def __init__(self, domain: int, stack: ExitStack) -> None:
        sonar: dict[str, object] = {"pattern": "constant", "value": 3.0, "rate": 10.0}
        gate: dict[str, object] = {"gate": True, "max_age_s": MAX_AGE_S, "rate": 20.0}
        wheels: dict[str, object] = {"drive_topic": "/drive_safe", "rate": 20.0, "max_age_s": 1.0}
        for module, params in {
            "nodes.mock_sonar": sonar,
            "nodes.safety_stop": gate,
            "nodes.electronic_differential": wheels,
        }.items():
            stack.enter_context(NodeProcess(module, domain, params=params))
        self.peer = stack.enter_context(Peer(domain))
        self._told: list[tuple[float, float]] = []
        self.peer.node.create_subscription(JointState, "/wheel_commands", self._hear, 100)

    def turns(self) -> bool:
        return bool(self._told) and self._told[-1][1] != 0

    def turned_after(self, moment_s: float) -> bool:
        """Whether they were told to turn later than that."""
        return any(at > moment_s and speed for at, speed in self._told)

    def _hear(self, message: Any) -> None:
        self._told.append((time.monotonic(), message.velocity[0]))


@pytest.fixture
def robot(ros_domain: int) -> Iterator[Robot]:
    with ExitStack() as stack:
        yield Robot(ros_domain, stack)


@contextmanager
def stopped(terminal: Terminal) -> Iterator[None]:
    """Have the screen sleep, as `kill -STOP` does."""
    os.kill(terminal.process.pid, signal.SIGSTOP)
    try:
        yield
    finally:
        os.kill(terminal.process.pid, signal.SIGCONT)


def test_wheels_turn_while_a_key_is_held_and_stand_when_it_is_let_go_or_nobody_is_left(
    deck: Deck, robot: Robot
) -> None:
    terminal = deck.open("watch", "--lang", "en")
    terminal.wait_for("electronic_differential")
    terminal.press("t")
    terminal.wait_for("Drive by keys → /drive_teleop")
    terminal.wait_for("the path is clear")
    assert not robot.turns()
    with HeldKey(terminal, "ц"):
        wait_until(robot.turns, "the wheels turn")
        terminal.wait_for("obeys the keys")
    let_go_s = time.monotonic()
    wait_until(lambda: not robot.turns(), "the wheels stand", DEADLINE_S)
    # The silence after it is long enough for a command that was left behind.
    terminal.wait_gone("obeys the keys")
    assert not robot.turned_after(let_go_s + DEADLINE_S)
    stands_s = time.monotonic()
    with stopped(terminal):
        terminal.press(*["down"] * 10)
        wait_until(lambda: time.monotonic() > stands_s + ASLEEP_S, "they are old")
    woke_s = time.monotonic()
    wait_until(lambda: time.monotonic() > woke_s + ASLEEP_S, "what was typed meanwhile is read")
    assert not robot.turned_after(stands_s)
    with HeldKey(terminal, "up"):
        wait_until(robot.turns, "the wheels turn again")
        killed_s = time.monotonic()
        terminal.process.kill()
        terminal.wait_exit()
        wait_until(lambda: not robot.turns(), "the wheels stand", DEADLINE_S)
    wait_until(lambda: time.monotonic() > killed_s + 2 * MAX_AGE_S, "every command is too old")
    assert not robot.turns()
