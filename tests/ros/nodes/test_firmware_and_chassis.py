"""The firmware under MicroPython and the driver of the chassis, on the two ends of one line."""

from __future__ import annotations

import contextlib
import os
import signal
import threading
import time
from typing import TYPE_CHECKING

import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool

from tests.ros.node_process import NodeProcess
from tests.ros.nodes.test_chassis import wheels
from tests.ros.nodes.test_tof_sonar import Port
from tests.ros.peer import LATCHED, Peer
from tests.unit.robot.test_firmware import Pico
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


class LivePico:
    """Lets the time of the firmware pass with the real one, and carries its bytes."""

    def __init__(self, pico: Pico, port: Port) -> None:
        self.motors = [0, 0]
        self._pico, self._port = pico, port
        self._ending = threading.Event()
        pico.order(boot=False)
        self._thread = threading.Thread(target=self._live, daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._ending.set()
        self._thread.join(10)
        self._pico.close()

    def _live(self) -> None:
        assert self._port.ends is not None
        began = then = time.monotonic()
        while not self._ending.wait(0.005):
            octets = b""
            with contextlib.suppress(BlockingIOError):
                octets = os.read(self._port.ends[0], 4096)
            passed_ms = int((time.monotonic() - then) * 1000)
            then += passed_ms / 1000
            answer = self._pico.order(octets=list(octets), ms=passed_ms)
            self.motors = answer["motors"]
            with contextlib.suppress(BlockingIOError):
                self._port.send(answer["text"].encode())
        assert then >= began


@pytest.fixture
def pico(tmp_path: Path) -> Iterator[LivePico]:
    port = Port(tmp_path / "pico")
    pico = LivePico(Pico(), port)
    yield pico
    pico.close()
    port.unplug()


def test_the_driver_drives_the_firmware(pico: LivePico, ros_domain: int, tmp_path: Path) -> None:
    params: dict[str, object] = {"port": tmp_path / "pico", "max_age_s": 0.5}
    with Peer(ros_domain) as peer, NodeProcess("nodes.chassis", ros_domain, params=params) as node:
        node.wait_for_words("The Pico answers: firmware 1.1.0, protocol 1")
        joints = peer.hear("/joint_states", JointState)
        publisher = peer.publisher("/wheel_commands", JointState)
        timer = peer.node.create_timer(0.1, lambda: publisher.publish(wheels(5.0)))
        wait_until(lambda: pico.motors == [65535 // 4] * 2, "motors at a quarter")
        wait_until(lambda: joints and joints[-1].velocity[0] == 5.0, "their speed")
        peer.say("/emergency_stop", Bool(data=True), listeners=2, qos=LATCHED)
        wait_until(lambda: pico.motors == [0, 0], "motors off")
        peer.say("/emergency_stop", Bool(data=False), listeners=2, qos=LATCHED)
        wait_until(lambda: pico.motors != [0, 0], "motors on again")
        peer.node.destroy_timer(timer)
        wait_until(lambda: pico.motors == [0, 0], "a stop by age")
        timer = peer.node.create_timer(0.1, lambda: publisher.publish(wheels(-5.0)))
        wait_until(lambda: pico.motors[0] < 0, "backward")
        node.send(signal.SIGKILL)
        wait_until(lambda: pico.motors == [0, 0], "the firmware's own stop")
