"""A cut of the network that is longer than Fast DDS remembers anybody."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from typing import TYPE_CHECKING

import pytest

from tests.namespaces import Machine
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = [pytest.mark.machine("ip", "namespaces"), pytest.mark.slow]
ROBOT, DESK = "10.98.0.1", "10.98.0.2"
WATCHING = """
import json, sys
from graph.observer.observer import Observer
observer = Observer(int(sys.argv[1]), "subnet")
observer.start(lambda update: print(json.dumps([n.name for n in update.nodes]), flush=True))
sys.stdin.read()
observer.stop()
"""


@pytest.fixture
def machines() -> Iterator[tuple[Machine, Machine]]:
    with Machine(ROBOT) as robot, Machine(DESK, beside=robot) as desk:
        yield robot, desk


@pytest.mark.timeout(240)
def test_after_it_the_nodes_of_the_other_machine_are_seen_again(
    machines: tuple[Machine, Machine], ros_domain: int
) -> None:
    robot, desk = machines
    environ = {
        **os.environ,
        "ROS_DOMAIN_ID": str(ros_domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET",
    }
    seen: list[list[str]] = [[]]

    def begun(machine: Machine, *words: str) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [*machine.inside(), sys.executable, *words],
            env=environ,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    with (
        begun(robot, "-m", "tests.ros.told_node", "teller") as teller,
        begun(desk, "-c", WATCHING, str(ros_domain)) as watching,
    ):

        def read() -> None:
            for line in watching.stdout or ():
                if line.startswith("["):
                    seen[0] = json.loads(line)

        reader = threading.Thread(target=read)
        reader.start()
        wait_until(lambda: seen[0] == ["/teller"], "the node is seen", within_s=40)
        robot._run("ip", "link", "set", "cable", "down")
        wait_until(lambda: seen[0] == [], "it is forgotten", within_s=60)
        robot._run("ip", "link", "set", "cable", "up")
        wait_until(lambda: seen[0] == ["/teller"], "it is seen again", within_s=100)
        for process in (watching, teller):
            assert process.stdin is not None
            process.stdin.close()
        reader.join(20)
