"""A camera on one machine, an observer on another, and a cable that loses one packet in twenty."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

import pytest

from robot.topics import CAMERA
from tests.namespaces import Machine
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = [pytest.mark.machine("ip", "namespaces"), pytest.mark.slow]
ROBOT, DESK = "10.98.0.1", "10.98.0.2"
LOST = 0.05
ENOUGH = 10
"""Pictures."""
WATCHING = """
import json, sys
from graph.observer.observer import Observer
topic = sys.argv[2]
def told(update):
    for row in update.topics:
        if row.name == topic:
            kinds = [sample.type_name for sample in update.samples.get(topic, ())]
            told = [kinds, row.from_afar, row.pictures_from, row.facts.get("raw", "")]
            print(json.dumps(told), flush=True)
observer = Observer(int(sys.argv[1]), "subnet")
observer.watch_pictures({topic})
observer.start(told)
sys.stdin.read()
observer.stop()
"""


class Desk:
    """What the observer on the other machine has told."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.kinds: list[str] = []
        self.row: tuple[str, str] = ("", "")
        self.from_afar = False
        self._process = process
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def close(self) -> None:
        self._reader.join(30)

    def _read(self) -> None:
        for line in self._process.stdout or ():
            if line.startswith("["):
                kinds, self.from_afar, *row = json.loads(line)
                self.kinds += kinds
                self.row = (row[0], row[1])


@pytest.fixture
def machines() -> Iterator[tuple[Machine, Machine]]:
    with Machine(ROBOT) as robot, Machine(DESK, beside=robot) as desk:
        for machine in (robot, desk):
            machine.lose(LOST)
        yield robot, desk


@pytest.fixture
def began(ros_domain: int) -> Iterator[Any]:
    environ = {
        **os.environ,
        "ROS_DOMAIN_ID": str(ros_domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET",
    }
    with ExitStack() as stack:

        def begin(machine: Machine, *words: str) -> subprocess.Popen[str]:
            process = subprocess.Popen(
                [*machine.inside(), sys.executable, *words],
                env=environ,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
            stack.callback(process.__exit__, None, None, None)
            stack.callback(process.kill)
            return process

        yield begin


@pytest.mark.timeout(240)
def test_what_deck_relays_is_seen_and_leaves_the_cable_free(
    machines: tuple[Machine, Machine], began: Any, ros_domain: int
) -> None:
    robot, desk = machines
    began(robot, "-m", "nodes.mock_camera")
    watching = began(desk, "-c", WATCHING, str(ros_domain), CAMERA)
    seen = Desk(watching)
    try:
        wait_until(lambda: seen.row[1] == CAMERA, "raw pictures do not come whole", within_s=60)
        assert seen.kinds == []
        assert seen.from_afar
        began(robot, "-m", "graph.picture_relay", json.dumps([ros_domain, "subnet"]))
        wait_until(lambda: len(seen.kinds) >= ENOUGH, "pictures come", within_s=60)
        assert set(seen.kinds) == {"sensor_msgs/msg/CompressedImage"}
        assert seen.row == (f"{CAMERA}/_deck/compressed", "")
        before, count = desk.received_bytes(), len(seen.kinds)
        wait_until(lambda: len(seen.kinds) >= count + ENOUGH, "more pictures come", within_s=60)
        assert desk.received_bytes() - before < 640 * 480 * 3
    finally:
        watching.kill()
        seen.close()
