"""A node that hangs, or dies, holds up no command of `ros2` for ever."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from tests.ros.peer import DISCOVERY, ROOT
from tests.ros.ros2.typed import typed
from tests.waiting import wait_until

HUNG = """
import threading, rclpy
from rclpy.node import Node
from std_srvs.srv import Trigger
rclpy.init()
hung, well = Node("hung"), Node("well")
hung.declare_parameter("rate", 1.0)
hung.create_service(Trigger, "/never", lambda request, response: response)
well.declare_parameter("speed", 2.0)
print("here", flush=True)
rclpy.spin(well)
"""
"""Of two nodes in one process only one is spun."""
COUNTER = """
import time, rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer
from rclpy.node import Node
rclpy.init()
node = Node("counter")
server = ActionServer(node, Fibonacci, "count", lambda goal: time.sleep(600))
print("here", flush=True)
rclpy.spin(node)
"""

MORTAL = """
import rclpy
from rclpy.node import Node
from std_srvs.srv import Trigger
rclpy.init()
node = Node("mortal")
node.create_service(Trigger, "/die", lambda request, response: 1 / 0)
print("here", flush=True)
rclpy.spin(node)
"""


SLOW = """
import time, rclpy
from rclpy.lifecycle import LifecycleNode
class Slow(LifecycleNode):
    def on_configure(self, state):
        time.sleep(600)
rclpy.init()
node = Slow("slow")
print("here", flush=True)
rclpy.spin(node)
"""


@contextmanager
def program(text: str, domain: int) -> Iterator[subprocess.Popen[str]]:
    """A program of somebody's own, until it says that it is there."""
    with subprocess.Popen(
        [sys.executable, "-c", text],
        cwd=ROOT,
        env={**os.environ, **DISCOVERY, "ROS_DOMAIN_ID": str(domain)},
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            assert process.stdout is not None
            assert any(line == "here\n" for line in process.stdout)
            yield process
        finally:
            process.kill()


@pytest.fixture(scope="module")
def hung(module_domain: int) -> Iterator[int]:
    with program(HUNG, module_domain):
        yield module_domain


def test_the_others_are_listed_and_the_one_that_hangs_is_named(hung: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(hung))
    listed = typed("param", "list", "--timeout", "1")
    assert listed.code == 1
    assert "/well:\n" in listed.out
    assert "  speed\n" in listed.out
    assert "/hung:" not in listed.out
    assert listed.err.startswith("/hung has not answered within 1 s: it may be stuck")


@pytest.mark.parametrize(
    "words",
    [
        ("param", "get", "/hung", "rate"),
        ("param", "dump", "/hung"),
        ("param", "set", "/hung", "rate", "2.0"),
        ("service", "call", "/never", "std_srvs/srv/Trigger"),
    ],
    ids=" ".join,
)
def test_whoever_does_not_answer_is_named(hung: int, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...]) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(hung))
    asked = typed(*words, "--timeout", "0.5")
    assert asked.code == 1
    assert f"{'/never' if words[0] == 'service' else '/hung'} has not answered" in asked.err


def test_a_service_whose_node_dies_of_the_call_is_told(ros_domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(ros_domain))
    with program(MORTAL, ros_domain):
        asked = typed("service", "call", "/die", "std_srvs/srv/Trigger", "--timeout", "60")
    assert asked.code == 1
    assert "/die has gone before it answered" in asked.err


def test_a_transition_may_take_as_long_as_the_option_says(ros_domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(ros_domain))
    with program(SLOW, ros_domain):
        asked = typed("lifecycle", "set", "/slow", "configure", "--timeout", "0.5")
    assert asked.code == 1
    assert "/slow has not answered within 0.5 s" in asked.err


@contextmanager
def goal(domain: int) -> Iterator[subprocess.Popen[str]]:
    """A goal that is on its way for ever, once it is accepted."""
    words = ("action", "send_goal", "/count", "example_interfaces/action/Fibonacci", "--timeout", "1")
    with subprocess.Popen(
        [sys.executable, "-m", "ros2", *words],
        cwd=ROOT,
        env={**os.environ, **DISCOVERY, "ROS_DOMAIN_ID": str(domain)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as sending:
        try:
            assert sending.stdout is not None
            assert any(line.startswith("Goal accepted") for line in sending.stdout)
            yield sending
        finally:
            sending.kill()


@pytest.mark.nightly  # The middleware takes 20 s until it knows.
def test_a_goal_whose_server_is_killed_ends_with_a_word(ros_domain: int) -> None:
    with program(COUNTER, ros_domain) as server, goal(ros_domain) as sending:
        server.kill()
        wait_until(lambda: sending.poll() is not None, "the end of the command")
        assert sending.stderr is not None
        assert "/count has gone before it answered" in sending.stderr.read()
        assert sending.returncode == 1


def test_ctrl_c_ends_a_goal_whose_server_hangs(ros_domain: int) -> None:
    with program(COUNTER, ros_domain) as server, goal(ros_domain) as sending:
        server.send_signal(signal.SIGSTOP)
        sending.send_signal(signal.SIGINT)
        wait_until(lambda: sending.poll() is not None, "the end of the command")
        assert sending.stderr is not None
        assert "/count has not answered" in sending.stderr.read()
        assert sending.returncode == 1
