"""`deck check robot --hardware real --preflight` against the devices of the mock robot."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
import serial

from tests.deck_process import deck
from tests.ros.devices import mock_robot, set_parameter
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer

pytestmark = pytest.mark.nightly

DEVICES = ("pico", "tof_front", "tof_rear", "lsc16")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("devices")


@pytest.fixture(scope="module", autouse=True)
def robot(module_domain: int, folder: Path) -> Iterator[NodeProcess]:
    with mock_robot(module_domain, folder) as process:
        process.wait_for_words("simulated robot")
        yield process


@pytest.fixture(scope="module")
def peer(module_domain: int) -> Iterator[Peer]:
    with Peer(module_domain) as peer:
        yield peer


@pytest.fixture(autouse=True)
def _ports(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for device in DEVICES:
        monkeypatch.setenv(f"DECK_{device.upper()}_PORT", str(folder / device))
    # Cameras and sound cards of this machine are none of this test's.
    for media in ("CAMERA", "SOUND"):
        monkeypatch.setenv(f"DECK_{media}_KIND", "none")


def preflight() -> tuple[int | None, dict[str, str]]:
    """Return the exit code, and of each device its line with the fix."""
    done = deck("check", "robot", "--hardware", "real", "--preflight")
    assert done.errors == []
    text = "\n".join(done.lines).replace("\n      -> ", " -> ")
    found = {line.split()[1]: line for line in text.splitlines() if line.split()[1] in DEVICES}
    return done.process.returncode, found


def test_every_device_answers_and_their_ports_are_free_again(folder: Path) -> None:
    code, found = preflight()
    assert code == 0, found
    assert found["pico"].endswith("pico: firmware simulated, battery 7.4 V")
    assert "readings a second" in found["tof_rear"]
    for device in DEVICES:
        serial.Serial(str(folder / device), exclusive=True).close()


def test_devices_in_each_others_place(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DECK_PICO_PORT", str(folder / "tof_front"))
    monkeypatch.setenv("DECK_TOF_FRONT_PORT", str(folder / "pico"))
    code, found = preflight()
    assert code == 2
    assert "a ToF sonar answers here, not the Pico" in found["pico"]
    assert found["tof_front"].startswith("FAIL")
    assert "TF-Luna" in found["tof_front"], "a Pico that is not greeted may be quiet"
    assert found["tof_rear"].startswith("ok")


def test_silence_a_pulled_cable_and_another_program(folder: Path, peer: Peer) -> None:
    set_parameter(peer, "mock_robot", "pico", "silent")
    set_parameter(peer, "mock_robot", "tof_front", "unplugged")
    other = serial.Serial(str(folder / "tof_rear"), exclusive=True)
    try:
        code, found = preflight()
    finally:
        other.close()
        set_parameter(peer, "mock_robot", "pico", "fine")
        set_parameter(peer, "mock_robot", "tof_front", "fine")
    assert code == 2
    assert "the port is silent: no Pico" in found["pico"]
    assert "there is no such port" in found["tof_front"]
    assert "DECK_TOF_FRONT_PORT=" in found["tof_front"]
    assert "has it" in found["tof_rear"]


def test_a_noisy_pico_is_told_as_that(peer: Peer) -> None:
    set_parameter(peer, "mock_robot", "pico", "noise")
    try:
        _code, found = preflight()
    finally:
        set_parameter(peer, "mock_robot", "pico", "fine")
    assert not found["pico"].startswith("ok")
    assert "some lines arrive garbled" in found["pico"]
