"""Who is in the network, and on no account of this machine, neither sees nor drives the robot."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from contextlib import ExitStack, suppress
from typing import TYPE_CHECKING, Any

import pytest

from graph.ros import RANGE
from tests.conftest import MIDDLEWARE
from tests.deck_process import DeckProcess
from tests.namespaces import Machine
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from typing_extensions import Self

pytestmark = pytest.mark.machine("ip", "namespaces")
ROBOT, NEIGHBOUR = "10.99.0.1", "10.99.0.2"
WHEELS = "electronic_differential"
PLANTED = """<?xml version="1.0"?>
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <participant profile_name="planted" is_default_profile="true"/>
</profiles>
"""
PORTS_OF_ONE = 3
JOINS = 3
"""How often somebody finds the open robot while he has been looking for the closed one."""


@pytest.fixture
def robot() -> Iterator[Machine]:
    with Machine(ROBOT) as machine:
        yield machine


@pytest.fixture
def neighbour(robot: Machine) -> Iterator[Machine]:
    with Machine(NEIGHBOUR, beside=robot) as machine:
        yield machine


class Seeing:
    """A stranger on a machine, and what he has seen."""

    def __init__(self, machine: Machine, domain: int, *words: str, **environ: str) -> None:
        plain = {name: value for name, value in os.environ.items() if name not in MIDDLEWARE}
        settings = {**plain, RANGE: "LOCALHOST", "ROS_DOMAIN_ID": str(domain), **environ}
        command = [*machine.inside(), sys.executable, "-m", "tests.ros.stranger", *words]
        self._process = subprocess.Popen(
            command, env=settings, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True
        )
        self.seen: dict[str, Any] = {"nodes": [], "fastest": 0.0}
        self.looks = 0
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        # Not killed at once: an incomplete port in shared memory might hold up the next one there.
        self._process.terminate()
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(10)
        self._process.kill()
        self._reader.join()

    def wait_for_robot(self, which: str) -> None:
        """Wait until he sees a robot."""

        def what() -> str:
            return f"to see {which}: looked {self.looks} times, ended {self._process.poll()}"

        wait_until(lambda: WHEELS in self.seen["nodes"], what, 60)

    def _read(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as stream:
            for line in stream:
                self.seen = json.loads(line)
                self.looks += 1


def intruder(machine: Machine, domain: int) -> Seeing:
    """Somebody who knows the robot's address and its domain, and means to drive it."""
    wide = {RANGE: "SUBNET", "ROS_STATIC_PEERS": ROBOT}
    return Seeing(machine, domain, "drive", **wide)


def profile(folder: Path, discovery: str) -> str:
    """Write a robot that obeys /drive at once."""
    path = folder / f"{discovery}.yaml"
    nodes = {WHEELS: {"run": f"nodes.{WHEELS}"}}
    path.write_text(json.dumps({"title": {"en": "T"}, "discovery": discovery, "nodes": nodes}))
    return str(path)


@pytest.mark.slow
def test_the_network_neither_sees_nor_drives_a_local_robot(
    robot: Machine, neighbour: Machine, ros_domain: int, other_domain: int, tmp_path: Path
) -> None:
    with ExitStack() as stack:

        def run(discovery: str, domain: int) -> Seeing:
            words = ("run", profile(tmp_path, discovery), "--domain", str(domain))
            session = DeckProcess(*words, within=robot.inside())
            stack.callback(session.close)
            # With the plainest settings, as whoever starts a node by hand has them.
            friend = stack.enter_context(Seeing(robot, domain))
            friend.wait_for_robot(f"the one on {discovery}")
            return friend

        friend = run("localhost", ros_domain)
        thief = stack.enter_context(intruder(neighbour, ros_domain))
        wait_until(lambda: thief.looks, "a first look around", 60)
        open_friend = run("subnet", other_domain)
        for _ in range(JOINS):
            with intruder(neighbour, other_domain) as guest:
                guest.wait_for_robot("the open one")
        with intruder(neighbour, other_domain):
            wait_until(lambda: open_friend.seen["fastest"] > 1, "to drive the open one", 60)
        assert thief.seen == {"nodes": [], "fastest": 0.0}
        assert friend.seen["fastest"] == 0
        with Seeing(robot, ros_domain, "drive"):
            wait_until(lambda: friend.seen["fastest"] > 1, "to drive from this machine", 60)


@pytest.mark.parametrize("program", ["run", "record"])
def test_no_process_of_deck_listens_to_a_cable(robot: Machine, ros_domain: int, tmp_path: Path, program: str) -> None:
    # Fast DDS reads this one of the current folder, too.
    (tmp_path / "DEFAULT_FASTRTPS_PROFILES.xml").write_text(PLANTED)
    words = {"run": (profile(tmp_path, "localhost"),), "record": ("-o", str(tmp_path / "bag"))}
    session = DeckProcess(program, *words[program], "--domain", str(ros_domain), within=robot.inside(tmp_path))
    try:
        assert _addresses_listened_at(robot) == {"127.0.0.1"}
    finally:
        session.close()


def _addresses_listened_at(machine: Machine) -> set[str]:
    """Wait for the first that is in the domain, and what else has been opened by then."""
    ports = wait_until(lambda: _of_a_participant(machine.listening()), "open ports", 60)
    return {port.partition(":")[0] for port in ports}


def _of_a_participant(ports: list[str]) -> list[str]:
    return ports if len(ports) >= PORTS_OF_ONE else []
