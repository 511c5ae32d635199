"""A stop by the space bar outlives screen, gate and supervisor, and can always be released."""

from __future__ import annotations

import json
import os
import signal
from typing import TYPE_CHECKING

import pytest

from tests.e2e import marked
from tests.e2e.listening import wait_for_the_gate
from tests.ros.peer import Peer
from tests.ros.wheels import Wheels
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.e2e.conftest import Deck
    from tests.e2e.terminal import Terminal

STOP, KEPT = "■ EMERGENCY STOP", "■ EMERGENCY STOP (from earlier)"
RELEASE = "^r Release"
STARTED_WITHIN_S = 180.0
"""On a machine that is busy with other tests; `deck up` itself waits for a minute."""


@pytest.fixture
def profile(tmp_path: Path, ros_domain: int) -> str:
    """The robot from its sonars to its motors, all of them emulated."""
    devices = tmp_path / "devices"
    sonar = {"run": "nodes.tof_sonar", "needs": ["mock_robot"], "restart": "on-failure"}
    gate = {"gate": True, "rear_topic": "/sensor/sonar_rear", "critical_distance": 0.3}
    nodes = {
        "mock_robot": {
            "run": "nodes.mock_robot",
            "params": {"folder": str(devices), "dropout": 0.0, "noise": 0.0},
            "ready": {"topic": "/mock/pose"},
        },
        "chassis": {
            "run": "nodes.chassis",
            "needs": ["mock_robot"],
            "params": {"port": str(devices / "pico")},
            "restart": "on-failure",
        },
        "sonar_front": {**sonar, "params": {"port": str(devices / "tof_front")}},
        "sonar_rear": {**sonar, "params": {"port": str(devices / "tof_rear"), "topic": "/sensor/sonar_rear"}},
        "safety_stop": {"run": "nodes.safety_stop", "params": gate, "restart": "on-failure"},
        "differential": {
            "run": "nodes.electronic_differential",
            "params": {"drive_topic": "/drive_safe", "max_age_s": 0.5},
            "restart": "on-failure",
        },
    }
    path = tmp_path / "small_robot.yaml"
    document = {"title": {"en": "A small robot"}, "domain": ros_domain, "nodes": nodes}
    path.write_text(json.dumps(document), encoding="utf-8")
    return str(path)


@pytest.fixture
def wheels(ros_domain: int) -> Iterator[Wheels]:
    with Peer(ros_domain) as peer:
        yield Wheels(peer)


def up(deck: Deck, profile: str) -> None:
    assert deck.open("up", profile).wait_exit(STARTED_WITHIN_S) == 0


def attached(deck: Deck) -> Terminal:
    terminal = deck.open("attach")
    terminal.wait_for("safety_stop")
    return terminal


def detach(terminal: Terminal) -> None:
    terminal.press("q")
    assert terminal.wait_exit() == 0


def kill(deck: Deck, words: str) -> None:
    (pid,) = (pid for pid, line in marked.alive(deck.mark).items() if words in line)
    os.kill(pid, signal.SIGKILL)


def assert_held(wheels: Wheels) -> None:
    """Ask the robot to drive, and see that it does not."""
    since = len(wheels.told)
    wheels.drive()
    wheels.assert_stands()
    wheels.assert_still(since)
    wheels.quiet()


def test_it_outlives_the_screen_the_gate_and_the_supervisor(deck: Deck, profile: str, wheels: Wheels) -> None:
    up(deck, profile)
    terminal = attached(deck)
    wheels.drive()
    wheels.wait_moving()
    wait_for_the_gate(terminal)
    terminal.press("space")
    terminal.wait_for(STOP)
    wheels.assert_stands()
    wheels.quiet()
    detach(terminal)

    kill(deck, "deck: safety_stop")
    terminal = attached(deck)
    terminal.wait_for(KEPT)
    terminal.wait_for(RELEASE)
    assert_held(wheels)
    # A screen that is killed says nothing.
    terminal.process.kill()

    kill(deck, "-m launcher.sup")
    wait_until(lambda: not marked.nodes(deck.mark), "the end of every node")
    up(deck, profile)
    terminal = attached(deck)
    terminal.wait_for(KEPT)
    terminal.wait_for(RELEASE)
    wait_until(lambda: wheels.told, "news of the new robot's motors")
    assert_held(wheels)
    terminal.press("ctrl+r")
    terminal.wait_gone(STOP)
    wheels.drive()
    wheels.wait_moving()
    wheels.quiet()
    detach(terminal)
    assert deck.open("down").wait_exit(STARTED_WITHIN_S) == 0


def test_where_nobody_listens_the_release_starts_again_what_the_stop_has_ended(deck: Deck) -> None:
    terminal = deck.open("01-hello", "--lang", "en")
    terminal.wait_for("1/1")
    terminal.press("space")
    terminal.wait_for("^r starts them again")
    terminal.wait_until(lambda _screen: not marked.nodes(deck.mark), "the end of the node")
    terminal.press("ctrl+r")
    terminal.wait_for("Restarted what the stop had ended: hello")
    terminal.wait_for("1/1")
    assert STOP not in terminal.text()
    detach(terminal)
