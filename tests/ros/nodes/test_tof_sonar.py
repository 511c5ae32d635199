"""The driver of the ToF sonars: bytes to topics, over pseudo-terminals."""

from __future__ import annotations

import math
import os
import pty
import signal
import tty
from typing import TYPE_CHECKING, Any

import pytest
from sensor_msgs.msg import Range
from std_msgs.msg import Float32

from robot.wire.tfluna import TofFrame, encode
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pytestmark = pytest.mark.nightly

TOPIC = "/sensor/sonar_front"
NEAR = encode(TofFrame(123, 1000, 25.0))


class Port:
    """The other end of a serial port, under a name that stays."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.ends: tuple[int, int] | None = None
        self.plug()

    def plug(self) -> None:
        ours, theirs = pty.openpty()
        tty.setraw(theirs)
        os.set_blocking(ours, False)
        self.ends = ours, theirs
        self.path.symlink_to(os.ttyname(theirs))

    def unplug(self) -> None:
        if self.ends is not None:
            self.path.unlink()
            for end in self.ends:
                os.close(end)
            self.ends = None

    def send(self, data: bytes) -> None:
        assert self.ends is not None
        os.write(self.ends[0], data)


@pytest.fixture
def port(tmp_path: Path) -> Iterator[Port]:
    port = Port(tmp_path / "tof")
    yield port
    port.unplug()


@pytest.fixture(scope="module")
def peer(module_domain: int) -> Iterator[Peer]:
    with Peer(module_domain) as peer:
        yield peer


def sonar(domain: int, port: object, **params: object) -> NodeProcess:
    return NodeProcess("nodes.tof_sonar", domain, params={"port": port, "every": 1, **params})


def hears(port: Port, octets: bytes, heard: list[Any], metres: float) -> None:
    """Say it until it is heard."""

    def said() -> bool:
        port.send(octets)
        return any(same(message.data, metres) for message in heard)

    heard.clear()
    wait_until(said, f"{metres} m", every_s=0.05)


def same(one: float, other: float) -> bool:
    return one == pytest.approx(other, abs=1e-6) or (math.isnan(one) and math.isnan(other))


def test_bytes_become_distances_by_rep_117(peer: Peer, module_domain: int, port: Port) -> None:
    heard = peer.hear(TOPIC, Float32)
    ranges = peer.hear(f"{TOPIC}/range", Range)
    with sonar(module_domain, port.path) as node:
        node.wait_for_words(f"Connected to {port.path}, 115200 baud")
        hears(port, NEAR, heard, 1.23)
        hears(port, encode(TofFrame(0, 50, 30.0)), heard, math.inf)
        hears(port, encode(TofFrame(10, 900, 30.0)), heard, -math.inf)
        hears(port, encode(TofFrame(0, 65535, 30.0)), heard, math.nan)
        last = ranges[0]
        assert last.header.frame_id == "sonar_front_link"
        assert last.radiation_type == Range.INFRARED
        assert (last.min_range, last.max_range) == (pytest.approx(0.2), pytest.approx(8.0))
        node.send(signal.SIGTERM)
        assert node.wait() == 0
        assert "Traceback" not in node.output


def test_a_cable_is_pulled_and_put_back(peer: Peer, module_domain: int, port: Port) -> None:
    heard = peer.hear(TOPIC, Float32)
    with sonar(module_domain, port.path) as node:
        node.wait_for_words("Connected")
        hears(port, NEAR, heard, 1.23)
        for count in (2, 3):
            port.unplug()
            wait_until(lambda: math.isnan(heard[-1].data), "nan")
            node.wait_for_words("Lost")
            port.plug()
            wait_until(lambda count=count: node.output.count("Connected") == count, "again")  # type: ignore[misc]
            hears(port, NEAR, heard, 1.23)
        node.send(signal.SIGINT)
        assert node.wait() == 0
        assert "Traceback" not in node.output
