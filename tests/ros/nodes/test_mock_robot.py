"""The robot that is not there: its devices speak as the real ones, and fail when asked to."""

from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest
import serial
from nav_msgs.msg import OccupancyGrid

from tests.ros.devices import mock_robot, set_parameter
from tests.ros.node_process import NodeProcess
from tests.ros.peer import LATCHED, Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


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


def test_it_takes_its_devices_with_it(module_domain: int, tmp_path: Path) -> None:
    folder = tmp_path / "run" / "devices"
    with mock_robot(module_domain, folder) as robot:
        robot.wait_for_words("The simulated robot is in")
        assert {path.name for path in folder.iterdir()} == set(NAMES)
        assert folder.parent.stat().st_mode & 0o777 == 0o700
        robot.send(signal.SIGTERM)
        assert robot.wait() == 0
        assert list(folder.iterdir()) == []
