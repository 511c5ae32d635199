"""The head on a serial port: what its servos do, looked at behind the pseudo-terminal."""

from __future__ import annotations

import fcntl
import math
import os
import random
import signal
import time
from typing import TYPE_CHECKING, Any

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from example_interfaces.srv import AddTwoInts
from sensor_msgs.msg import JointState

from nodes.simulated.device_fault import FINE, NOISE, SILENT, UNPLUGGED
from robot.wire.lsc16 import ServoDecoder, ServoMove
from robot.wire.tfluna import TofFrame, encode
from tests.ros.devices import mock_robot, set_parameter
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.ros.servo_bench import ServoBench
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from typing_extensions import Self

PAN = 1


class Head:
    """The head in a process of its own, and somebody who asks it."""

    def __init__(
        self, peer: Peer, domain: int, port: object, *, mortal: bool = False, **params: object
    ) -> None:
        given = {"port": port, "battery_every_s": 0.4, "rest_rate": 10, "speed": 360, **params}
        self.process = NodeProcess("nodes.head_controller", domain, params=given, mortal=mortal)
        self.peer = peer
        self.states = peer.hear("/head_state", JointState)
        self.told = peer.hear("/diagnostics", DiagnosticArray)
        self._client = peer.node.create_client(AddTwoInts, "/set_head_position")
        self._read = 0

    def __enter__(self) -> Self:
        wait_until(self._client.service_is_ready, "the head's service")
        return self

    def __exit__(self, *_: object) -> None:
        self.process.close()
        self.peer.node.destroy_client(self._client)

    def wait_says(self, *words: str) -> None:
        """Wait for words in its log that were not waited for before."""
        wait_until(
            lambda: all(word in self.process.output[self._read :] for word in words),
            lambda: f"{words} in:\n{self.process.output}",
        )
        self._read = len(self.process.output)

    def wait_answering(self) -> None:
        self.wait_says("The servo controller answers")

    def ask(self, pan: int, tilt: int) -> Any:
        return self._client.call_async(AddTwoInts.Request(a=pan, b=tilt))

    def turn(self, pan: int, tilt: int) -> int:
        return int(self.peer.insist(lambda: self.ask(pan, tilt), "the head's answer").sum)

    def wait_pose(self, pan: float, tilt: float) -> None:
        def there() -> bool:
            return [math.degrees(angle) for angle in self.states[-1].position] == pytest.approx(
                [pan, tilt]
            )

        self.states.clear()
        wait_until(lambda: self.states and there(), f"{pan}, {tilt} on /head_state")

    def wait_unknown(self) -> None:
        self.states.clear()
        wait_until(lambda: self.states and not self.states[-1].position, "no positions")

    def wait_told(self, level: bytes, words: str) -> dict[str, str]:
        def told() -> DiagnosticStatus | None:
            statuses = [message.status[0] for message in self.told]
            return next((s for s in statuses if s.level == level and words in s.message), None)

        self.told.clear()
        status = wait_until(told, f"{words!r} on /diagnostics")
        return {item.key: item.value for item in status.values}


@pytest.fixture
def peer(ros_domain: int) -> Iterator[Peer]:
    with Peer(ros_domain) as peer:
        yield peer


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[ServoBench]:
    bench = ServoBench(tmp_path / "lsc16")
    yield bench
    bench.close()


@pytest.fixture(scope="module")
def lasting(
    module_domain: int, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[tuple[Head, ServoBench]]:
    bench = ServoBench(tmp_path_factory.mktemp("head") / "lsc16")
    with Peer(module_domain) as peer, Head(peer, module_domain, bench.path) as head:
        yield head, bench
    bench.close()


@pytest.fixture
def head(lasting: tuple[Head, ServoBench]) -> tuple[Head, ServoBench]:
    """The same one for all whose trouble it outlives, mended."""
    head, bench = lasting
    bench.says = b""
    bench.fail(FINE)
    wait_until(lambda: head.turn(0, 0) == 1, "a head that turns")
    head.wait_says()
    bench.taken = b""
    return lasting


def moves_of(bench: ServoBench) -> list[ServoMove]:
    return [frame for frame in ServoDecoder().feed(bench.taken) if isinstance(frame, ServoMove)]


def wait_at(bench: ServoBench, pulses_us: dict[int, int]) -> None:
    """Wait until servos are there; they are on their way a little later than the head believes."""
    wait_until(
        lambda: {servo: round(bench.at(servo)) for servo in pulses_us} == pulses_us,
        lambda: f"{pulses_us}, at {[bench.at(servo) for servo in pulses_us]}",
    )


def test_servos_go_where_the_head_is_asked_to_look_and_no_faster(
    peer: Peer, ros_domain: int, bench: ServoBench
) -> None:
    params: dict[str, Any] = {
        "speed": 180,
        "pan_trim": 9,
        "tilt_reversed": True,
        "tilt_servo": 7,
        "tilt_min": -20,
    }
    with Head(peer, ros_domain, bench.path, **params) as head:
        head.wait_says(f"The head at {bench.path}", "the commanded position", "answers")
        head.wait_unknown()
        values = head.wait_told(DiagnosticStatus.OK, "positions are commanded, not measured")
        assert (values["battery_v"], values["positions"]) == ("7.40", "commanded")
        for pan, tilt in ((82, 0), (-91, 0), (0, 91), (0, -21), (2**62, 0)):
            assert head.turn(pan, tilt) == 0, (pan, tilt)
        head.wait_says("pan must be from -90° to 81°, tilt from -20° to 90°")
        assert moves_of(bench) == []
        # From who knows where: the time of the longest way that it can be.
        began_s = time.monotonic()
        assert head.turn(0, 0) == 1
        assert time.monotonic() - began_s >= 0.5
        wait_at(bench, {PAN: 1600, 7: 1500})
        head.wait_pose(0, 0)
        assert head.turn(45, 18) == 1
        wait_at(bench, {PAN: 2100, 7: 1300})
        set_parameter(peer, "head_controller", "pan_trim", -9.0)
        assert bench.at(PAN) == 2100
        assert head.turn(0, 18) == 1
        wait_at(bench, {PAN: 1400})
        assert [move.time_ms for move in moves_of(bench)] == [500, 250, 350]
        head.process.send(signal.SIGTERM)
        assert head.process.wait() == 0
        assert "Traceback" not in head.process.output
    assert len(moves_of(bench)) == 3


def test_each_connection_is_told_however_soon_it_follows(head: tuple[Head, ServoBench]) -> None:
    node, bench = head
    for _ in range(2):
        bench.fail(UNPLUGGED)
        node.wait_says("Lost")
        bench.fail(FINE)
        node.wait_answering()


def test_a_cable_pulled_while_the_head_moves_is_no_arrival(head: tuple[Head, ServoBench]) -> None:
    node, bench = head
    set_parameter(node.peer, "head_controller", "speed", 20.0)
    first, second = node.ask(90, 0), node.ask(0, 0)
    node.wait_says("Turning the head to pan 90°", "waits for its turn")
    wait_until(lambda: moves_of(bench), "the first move at the servos")
    bench.fail(UNPLUGGED)
    wait_until(lambda: first.done() and second.done(), "answers")
    assert (first.result().sum, second.result().sum) == (0, 0)
    node.wait_says(
        "Refused: pan 90°, tilt 0°", f"Refused: pan 0°, tilt 0° — no connection to {bench.path}"
    )
    assert node.turn(1, 1) == 0
    node.wait_unknown()
    node.wait_told(DiagnosticStatus.ERROR, "no such port")
    bench.fail(FINE)
    node.wait_answering()
    assert len(moves_of(bench)) == 1
    set_parameter(node.peer, "head_controller", "speed", 360.0)
    assert node.turn(-30, 10) == 1
    node.wait_pose(-30, 10)


def test_a_controller_that_falls_silent_is_told_and_gets_no_moves(
    head: tuple[Head, ServoBench],
) -> None:
    node, bench = head
    assert node.turn(10, 0) == 1
    bench.fail(SILENT)
    node.wait_says("is open, but no LSC-16 answers", "9600 baud")
    node.wait_unknown()
    assert node.turn(20, 0) == 0
    node.wait_told(DiagnosticStatus.ERROR, "no LSC-16 answers")
    assert len(moves_of(bench)) == 1


def test_another_device_at_the_port_gets_no_moves(head: tuple[Head, ServoBench]) -> None:
    node, bench = head
    bench.says = encode(TofFrame(123, 1000, 25.0))
    node.wait_says("its data are not from an LSC-16")
    assert node.turn(10, 0) == 0
    bench.says = random.Random(3).randbytes(50)
    node.wait_told(DiagnosticStatus.ERROR, "its data are not from an LSC-16")
    assert node.turn(10, 0) == 0
    assert moves_of(bench) == []


def test_noise_is_outlived(head: tuple[Head, ServoBench]) -> None:
    node, bench = head
    bench.fail(NOISE)
    wait_until(lambda: node.turn(10, 0) == 1, "a move")
    bench.fail(FINE)
    wait_until(lambda: node.turn(20, 0) == 1, "a move")
    wait_at(bench, {PAN: 1722})


def test_with_the_transmitting_wire_alone_nothing_is_asked(
    peer: Peer, ros_domain: int, bench: ServoBench
) -> None:
    bench.fail(SILENT)
    with Head(peer, ros_domain, bench.path, battery_every_s=0) as head:
        head.wait_says("Connected")
        assert head.turn(10, 0) == 1
        wait_at(bench, {PAN: 1611})
        head.wait_told(DiagnosticStatus.OK, "connected")
        assert len(bench.taken) == 13


def test_a_port_of_another_program_is_left_alone_until_it_is_free(
    peer: Peer, ros_domain: int, bench: ServoBench
) -> None:
    other = os.open(bench.path, os.O_RDWR | os.O_NOCTTY)
    fcntl.flock(other, fcntl.LOCK_EX)
    with Head(peer, ros_domain, bench.path) as head:
        head.wait_says("another program is using it")
        assert head.turn(10, 0) == 0
        assert bench.taken == b""
        os.close(other)
        head.wait_answering()
        assert head.turn(10, 0) == 1


def test_no_permission_is_told_with_its_mend(
    peer: Peer, ros_domain: int, bench: ServoBench
) -> None:
    bench.path.chmod(0)
    with Head(peer, ros_domain, bench.path, mortal=True) as head:
        head.wait_says("no permission", "dialout")
        assert head.turn(10, 0) == 0


def test_joints_that_make_no_sense_are_refused_at_the_start(ros_domain: int) -> None:
    params: dict[str, object] = {"pan_servo": 2}
    with NodeProcess("nodes.head_controller", ros_domain, params=params) as node:
        assert node.wait() == 2
        assert "pan_servo and tilt_servo are both 2" in node.output


def test_the_mock_robot_has_such_a_controller(peer: Peer, ros_domain: int, tmp_path: Path) -> None:
    folder = tmp_path / "devices"
    with (
        mock_robot(ros_domain, folder, battery=5.6),
        Head(peer, ros_domain, folder / "lsc16") as head,
    ):
        head.wait_says("The battery of the servos is low: 5.6 V")
        assert head.wait_told(DiagnosticStatus.WARN, "5.6 V")["battery_v"] == "5.60"
        assert head.turn(-45, 20) == 1
        head.wait_pose(-45, 20)
