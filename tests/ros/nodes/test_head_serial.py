"""The head on a serial port: what its servos do, looked at behind the pseudo-terminal."""

from __future__ import annotations

import fcntl
import math
import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from example_interfaces.srv import AddTwoInts
from sensor_msgs.msg import JointState
from typing_extensions import Self

from nodes.simulated.devices import FINE, SILENT, UNPLUGGED, FaultyLine, PseudoSerial
from robot.wire.lsc16 import ServoDecoder, ServoMove
from robot.world.boards import SimulatedServos
from tests.ros.devices import set_parameter
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until

_STEP_S = 0.005


class ServoBench:
    """An LSC-16 that keeps time with the clock; to be closed."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.servos = SimulatedServos()
        self.taken = b""
        """All that came for the device."""
        self.says = b""
        """What it says all the time in place of an answer, if anything."""
        self._lock = threading.Lock()
        self._line = FaultyLine(PseudoSerial(path), seed=1)
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._live, name="servos", daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._ending.set()
        self._thread.join(5)
        self._line.close()

    def fail(self, fault: str = FINE) -> None:
        """Have one of the faults of the mock robot from now on."""
        with self._lock:
            self._line.set_fault(fault)

    def at(self, servo: int) -> float:
        with self._lock:
            return self.servos.pulse_us(servo)

    def _live(self) -> None:
        last_s = time.monotonic()
        while not self._ending.wait(_STEP_S):
            now_s = time.monotonic()
            with self._lock:
                heard = self._line.read()
                self.taken += heard
                self.servos.advance(now_s - last_s)
                answer = self.servos.feed(heard)
                self._line.write(self.says or answer, now_s)
            last_s = now_s


PAN = 1


class Head:
    """The head in a process of its own, and somebody who asks it."""

    def __init__(self, peer: Peer, domain: int, port: object, *, mortal: bool = False, **params: object) -> None:
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
            return [math.degrees(angle) for angle in self.states[-1].position] == pytest.approx([pan, tilt])

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
def lasting(module_domain: int, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Head, ServoBench]]:
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
    params: dict[str, Any] = {"speed": 180, "pan_trim": 9, "tilt_reversed": True, "tilt_servo": 7, "tilt_min": -20}
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


def test_a_cable_pulled_while_the_head_moves_is_no_arrival(head: tuple[Head, ServoBench]) -> None:
    node, bench = head
    set_parameter(node.peer, "head_controller", "speed", 20.0)
    first, second = node.ask(90, 0), node.ask(0, 0)
    node.wait_says("Turning the head to pan 90°", "waits for its turn")
    wait_until(lambda: moves_of(bench), "the first move at the servos")
    bench.fail(UNPLUGGED)
    wait_until(lambda: first.done() and second.done(), "answers")
    assert (first.result().sum, second.result().sum) == (0, 0)
    node.wait_says("Refused: pan 90°, tilt 0°", f"Refused: pan 0°, tilt 0° — no connection to {bench.path}")
    assert node.turn(1, 1) == 0
    node.wait_unknown()
    node.wait_told(DiagnosticStatus.ERROR, "no such port")
    bench.fail(FINE)
    node.wait_answering()
    assert len(moves_of(bench)) == 1
    set_parameter(node.peer, "head_controller", "speed", 360.0)
    assert node.turn(-30, 10) == 1
    node.wait_pose(-30, 10)


def test_a_controller_that_falls_silent_is_told_and_gets_no_moves(head: tuple[Head, ServoBench]) -> None:
    node, bench = head
    assert node.turn(10, 0) == 1
    bench.fail(SILENT)
    node.wait_says("is open, but no LSC-16 answers", "9600 baud")
    node.wait_unknown()
    assert node.turn(20, 0) == 0
    node.wait_told(DiagnosticStatus.ERROR, "no LSC-16 answers")
    assert len(moves_of(bench)) == 1


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
