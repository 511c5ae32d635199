"""A list of the graph has everybody who is there, or says who is missing."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from tests.middleware_words import own_words
from tests.ros.node_process import NodeProcess
from tests.ros.peer import DISCOVERY, ROOT
from tests.ros.ros2.typed import typed
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

SLOW = "slow_to_tell"
LOOKS = 4


@pytest.fixture
def slow(module_domain: int) -> Iterator[str]:
    """A node of somebody who does not have Deck's settings: it announces itself each 3 s."""
    environ = {key: value for key, value in os.environ.items() if key not in DISCOVERY}
    program = (
        "import rclpy\nrclpy.init()\n"
        f"node = rclpy.create_node('{SLOW}')\nprint('here', flush=True)\nrclpy.spin(node)\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", program],
        cwd=ROOT,
        env=environ | {"ROS_DOMAIN_ID": str(module_domain)},
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    ) as process:
        assert process.stdout is not None
        assert next(filter(own_words, process.stdout)) == "here\n"
        yield SLOW
        process.terminate()
        process.communicate()


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
