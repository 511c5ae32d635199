"""The robot that is not there: its devices speak as the real ones, and fail when asked to."""

from __future__ import annotations

import signal
from functools import partial
from typing import TYPE_CHECKING, Protocol, TypeVar

import pytest
import serial
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import JointState

from nodes.mock_robot import DEVICES
from nodes.simulated.device_fault import FAULTS
from robot.wire.lsc16 import Battery, BatteryRequest, ServoDecoder, ServoFrame
from robot.wire.lsc16 import encode as encode_servo
from robot.wire.pico import Drive, Hello, PicoDecoder, Telemetry, Welcome, encode
from robot.wire.tfluna import Model, TofDecoder, TofFrame
from tests.ros.devices import mock_robot, set_parameter
from tests.ros.node_process import NodeProcess
from tests.ros.peer import LATCHED, Peer
from tests.waiting import wait_until
from tui.devices import trouble as device_trouble

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

Frame = TypeVar("Frame")

NAMES = ("pico", "tof_front", "tof_rear", "lsc16")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("robot") / "devices"


@pytest.fixture(scope="module")
def robot(module_domain: int, folder: Path) -> Iterator[NodeProcess]:
    with mock_robot(module_domain, folder, noise=0.0, dropout=0.0) as robot:
        robot.wait_for_words("The simulated robot is in")
        yield robot


@pytest.fixture(scope="module")
def peer(module_domain: int) -> Iterator[Peer]:
    with Peer(module_domain) as peer:
        yield peer


def open_port(folder: Path, name: str, baud: int = 115200) -> serial.Serial:
    return serial.Serial(str(folder / name), baud, timeout=0.05, exclusive=True)


class Decoder(Protocol[Frame]):
    """What makes frames of octets."""

    def feed(self, data: bytes) -> list[Frame]:
        """Take in what has come; the frames that are whole now."""
        ...


def has_come(
    count: int, frames: list[Frame], port: serial.Serial, decoder: Decoder[Frame], octets: int = 90
) -> bool:
    """Read on into `frames`; whether there are so many."""
    frames.extend(decoder.feed(port.read(octets)))
    return len(frames) >= count


@pytest.mark.usefixtures("robot")
def test_the_pico_answers_drives_and_stops_by_itself(folder: Path, peer: Peer) -> None:
    poses = peer.hear("/mock/pose", PoseStamped)
    motors = peer.hear("/mock/motors", JointState)
    decoder, told = PicoDecoder(), []
    with open_port(folder, "pico") as port:

        def hear(seq: int, speed: float) -> Telemetry | None:
            port.write(encode(Drive(seq, speed, speed, 0.0)))
            told.extend(decoder.feed(port.read(400)))
            return next((m for m in reversed(told) if isinstance(m, Telemetry)), None)

        port.write(encode(Hello(0)))
        sequence = iter(range(1, 60_000))
        wait_until(lambda: (now := hear(next(sequence), 0)) and not now.flags, "armed")
        assert any(isinstance(message, Welcome) for message in told)

        def turns() -> bool:
            """A test that was held up for 0.25 s has to begin anew with a stop, as a chassis."""
            now = next(m for m in reversed(told) if isinstance(m, Telemetry))
            now = hear(next(sequence), 0 if now.flags else 5) or now
            return now.left_rad_s > 4.5

        # It is commanded until all of it was seen: 0.25 s later it stands.
        wait_until(turns, "turning")
        wait_until(
            lambda: turns() and poses and poses[-1].pose.position.x > 0.01, "a robot that moves"
        )
        wait_until(
            lambda: turns() and motors[-1].velocity[0] > 4.5 and motors[-1].effort[1] == 5.0,
            "motors that turn",
        )
    wait_until(
        lambda: len(poses) > 3 and poses[-1].pose.position.x == poses[-3].pose.position.x,
        "standing after the silence",
    )
    wait_until(lambda: not any(motors[-1].velocity) and not any(motors[-1].effort), "motors off")
    assert motors[-1].position[0] == pytest.approx(poses[-1].pose.position.x / 0.0325, abs=0.2)
    assert decoder.errors == 0


@pytest.mark.usefixtures("robot")
def test_the_sonars_see_the_room(folder: Path) -> None:
    for name, nearest in (("tof_front", 1.0), ("tof_rear", 0.5)):
        decoder = TofDecoder()
        frames: list[TofFrame] = []
        with open_port(folder, name) as port:
            wait_until(partial(has_come, 21, frames, port, decoder), "frames")
        assert nearest < frames[-1].distance_m(Model.LUNA) < 2.5


@pytest.mark.usefixtures("robot")
def test_a_late_comer_gets_the_room_as_a_map(peer: Peer) -> None:
    maps = peer.hear("/map", OccupancyGrid, LATCHED)
    wait_until(lambda: maps, "a map")
    (told,) = maps
    assert told.header.frame_id == "odom"
    assert told.info.resolution == pytest.approx(0.05)
    assert len(told.data) == told.info.width * told.info.height
    assert set(told.data) == {-1, 0, 100}
    # The wall ahead of the start, 4 m away at its height.
    row = round((0.8 - told.info.origin.position.y) / 0.05 - 0.5)
    walls = [x for x in range(told.info.width) if told.data[row * told.info.width + x] == 100]
    assert told.info.origin.position.x + (walls[-1] + 0.5) * 0.05 == pytest.approx(4.0, abs=0.03)


@pytest.mark.usefixtures("robot")
def test_the_servo_controller_tells_its_battery(folder: Path) -> None:
    decoder = ServoDecoder()
    frames: list[ServoFrame] = []
    with open_port(folder, "lsc16", 9600) as port:
        port.write(encode_servo(BatteryRequest()))
        wait_until(lambda: has_come(1, frames, port, decoder, 16), "an answer")
    assert frames == [Battery(7400)]


@pytest.mark.usefixtures("robot")
def test_a_cable_is_pulled_and_put_back_under_the_same_name(folder: Path, peer: Peer) -> None:
    port = open_port(folder, "tof_front")
    set_parameter(peer, "mock_robot", "tof_front", "unplugged")
    assert not (folder / "tof_front").exists()
    with pytest.raises((OSError, serial.SerialException)):
        wait_until(lambda: port.read(9) and False, "an end of it")
    port.close()
    set_parameter(peer, "mock_robot", "tof_front", "fine")
    with open_port(folder, "tof_front") as again:
        wait_until(lambda: again.read(9), "bytes")


@pytest.mark.usefixtures("robot")
def test_noise_and_silence_are_to_be_had(folder: Path, peer: Peer) -> None:
    decoder = TofDecoder()
    with open_port(folder, "tof_rear") as port:
        set_parameter(peer, "mock_robot", "tof_rear", "noise")
        wait_until(lambda: decoder.feed(port.read(90)) is None or decoder.errors > 5, "noise")
        set_parameter(peer, "mock_robot", "tof_rear", "silent")
        wait_until(lambda: not port.read(90), "silence")
        set_parameter(peer, "mock_robot", "tof_rear", "fine")
        wait_until(lambda: decoder.feed(port.read(90)), "frames again")


def test_it_takes_its_devices_with_it(module_domain: int, tmp_path: Path) -> None:
    folder = tmp_path / "run" / "devices"
    with mock_robot(module_domain, folder) as robot:
        robot.wait_for_words("The simulated robot is in")
        assert {path.name for path in folder.iterdir()} == set(NAMES)
        assert folder.parent.stat().st_mode & 0o777 == 0o700
        robot.send(signal.SIGTERM)
        assert robot.wait() == 0
        assert list(folder.iterdir()) == []


def test_without_a_folder_the_devices_are_in_the_run_directory(
    module_domain: int, tmp_path: Path
) -> None:
    folder = tmp_path / "run" / "devices"
    with NodeProcess("nodes.mock_robot", module_domain) as robot:
        robot.wait_for_words(f"The simulated robot is in {folder}")
        assert {path.name for path in folder.iterdir()} == set(NAMES)


def test_a_folder_that_cannot_be_is_told_in_one_line(module_domain: int, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with mock_robot(module_domain, tmp_path / "file" / "x") as robot:
        assert robot.wait() == 2
        assert "set the parameter folder" in robot.output
        assert robot.output.count("\n") == 1


def test_the_screen_offers_what_the_robot_takes() -> None:
    assert set(DEVICES) == device_trouble.LINES
    lines = (device_trouble.UNPLUGGED, device_trouble.NOISE, device_trouble.SILENCE)
    assert {value for each in lines for value in (each.wrong, each.fine)} < set(FAULTS)
