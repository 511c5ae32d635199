"""A list of the graph has everybody who is there, or says who is missing."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

import pytest
from std_msgs.msg import String

from graph.participants.telling import Telling
from tests.middleware_words import own_words
from tests.ros.node_process import NodeProcess
from tests.ros.peer import DISCOVERY, ROOT
from tests.ros.ros2.typed import typed
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.ros.ros2.world import World

SLOW = "slow_to_tell"
LOOKS = 4
ENDS_WITHIN_S = 5.0
LISTENING = """
import rclpy
rclpy.init()
node = rclpy.create_node('slow_to_tell')
print('here', flush=True)
rclpy.spin(node)
"""
TALKING = """
import rclpy
from rclpy.qos import qos_profile_sensor_data
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node('slow_to_tell')
publisher = node.create_publisher(String, '/spoken', qos_profile_sensor_data)
node.create_timer(0.1, lambda: publisher.publish(String(data='slow_to_tell')))
print('here', flush=True)
rclpy.spin(node)
"""


TOLD = """
import rclpy
from graph.participants.telling import Telling
rclpy.init()
print('reads' if Telling.load(rclpy.create_node('reader')) else 'does not read')
"""


@contextmanager
def announcing_rarely(domain: int, program: str) -> Iterator[str]:
    """A node of somebody who does not have Deck's settings: it announces itself each 3 s."""
    environ = {key: value for key, value in os.environ.items() if key not in DISCOVERY}
    with subprocess.Popen(
        [sys.executable, "-c", program],
        cwd=ROOT,
        env=environ | {"ROS_DOMAIN_ID": str(domain)},
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    ) as process:
        assert process.stdout is not None
        assert next(filter(own_words, process.stdout)) == "here\n"
        try:
            yield SLOW
        finally:
            # A signal that comes just as rclpy begins to wait is forgotten.
            process.terminate()
            with suppress(subprocess.TimeoutExpired):
                process.wait(ENDS_WITHIN_S)
            process.kill()


@pytest.fixture
def slow(module_domain: int) -> Iterator[str]:
    with announcing_rarely(module_domain, LISTENING) as name:
        yield name


@pytest.fixture
def slow_talker(module_domain: int) -> Iterator[str]:
    with announcing_rarely(module_domain, TALKING) as name:
        yield name


def test_who_announces_itself_rarely_is_found_each_time(slow: str) -> None:
    for _ in range(LOOKS):
        listed = typed("node", "list")
        assert (listed.code, listed.out, listed.err) == (0, f"/{slow}\n/turtle\n", "")
    services = typed("service", "list")
    assert f"/{slow}/set_parameters_atomically\n" in services.out
    info = typed("node", "info", f"/{slow}")
    assert f"    /{slow}/set_parameters_atomically: " in info.out
    value = typed("param", "get", f"/{slow}", "use_sim_time")
    assert (value.code, value.out) == (0, "Boolean value is: False\n")


@pytest.mark.usefixtures("ros_domain")
def test_what_they_tell_is_read_by_a_program_that_has_loaded_nothing_before() -> None:
    """Here other tests have loaded the type; where it is not, lists of topics are incomplete."""
    program = [sys.executable, "-c", TOLD]
    reading = subprocess.run(program, cwd=ROOT, capture_output=True, text=True, check=True)
    assert own_words(reading.stdout) == "reads\n"


def test_it_is_so_where_what_they_tell_cannot_be_read(
    slow: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Then the names of nodes that the middleware has made of it are asked for."""
    monkeypatch.setattr(Telling, "load", lambda _node: None)
    for _ in range(LOOKS):
        listed = typed("node", "list")
        assert (listed.code, listed.out, listed.err) == (0, f"/{slow}\n/turtle\n", "")


def test_publishers_of_every_kind_are_found_before_a_quality_is_chosen(
    slow_talker: str, world: World
) -> None:
    """One is found at once and is reliable, the other is found late and is not."""
    world.publisher("/spoken", String)
    echoed = typed("topic", "echo", "--once", "/spoken", "--field", "data")
    assert f"{slow_talker}\n---\n" in echoed.out
    assert "Falling back to" in echoed.out


def test_who_is_halted_is_missed_aloud(module_domain: int) -> None:
    """It cannot tell what it has: whatever is listed may not be all."""
    with NodeProcess("nodes.mock_sonar", module_domain, name="halted") as node:
        wait_until(lambda: "/halted\n" in typed("node", "list").out, "the node")
        node.send(signal.SIGSTOP)
        try:
            for words in (("node", "list"), ("topic", "list", "-t"), ("node", "info", "/halted")):
                less = typed(*words)
                assert less.code == 1, less
                assert f"(pid {node.process.pid}, halted)" in less.err
        finally:
            node.send(signal.SIGCONT)
        wait_until(lambda: "/halted\n" in typed("node", "list").out, "the node that goes on")
