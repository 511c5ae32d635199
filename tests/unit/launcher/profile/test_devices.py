"""Devices of a profile, and which serial port is which."""

from __future__ import annotations

from pathlib import Path

import pytest

from launcher.errors import ProfileError
from launcher.profile.load import Profile, load_profile
from launcher.profile.serial_choice import KINDS, UnresolvedPort, WantedPort, choose
from launcher.serial_ports import SerialPort
from tests.unit.profile_files import loaded, written

ROBOT = """\
devices:
  pico:
    kind: pico
    port: auto
    mock: {port: "${run_dir}/devices/${domain}/pico"}
  other: {kind: tf_luna, port: auto}
nodes:
  chassis: {exec: [chassis], params: {port: "${devices.pico.port}"}}
  spare: {exec: [x, "${devices.other.port}"], when: hardware == "mock"}
"""
PICO = SerialPort("/dev/ttyACM0", "/dev/serial/by-id/pico", "2e8a:0005")


def started(folder: Path, *ports: SerialPort, **environ: str) -> Profile:
    path = written(folder, ROBOT)
    return load_profile(path, hardware="real", environ=environ, ports=lambda: ports)


def test_places_are_put_in_on_mock_hardware(tmp_path: Path) -> None:
    path = written(tmp_path, ROBOT)
    environ = {"DECK_RUN_DIR": "/run/x", "ROS_DOMAIN_ID": "7", "DECK_PICO_PORT": "/dev/real"}
    port = load_profile(path, environ=environ).nodes["chassis"].params["port"]
    assert port == "/run/x/devices/7/pico", "a variable never leads a mock robot to a real one"
    port = load_profile(path, environ=environ, domain=8).nodes["chassis"].params["port"]
    assert port == "/run/x/devices/8/pico"


def test_auto_becomes_the_port_that_was_found(tmp_path: Path) -> None:
    profile = started(tmp_path, PICO)
    assert profile.nodes["chassis"].params["port"] == "/dev/serial/by-id/pico"
    assert profile.devices["pico"]["port"] == "/dev/serial/by-id/pico"
    assert profile.devices["other"]["port"] == "auto", "no node that runs uses it"


def test_a_variable_goes_before_auto(tmp_path: Path) -> None:
    profile = started(tmp_path, DECK_PICO_PORT="/dev/mine")
    assert profile.nodes["chassis"].params["port"] == "/dev/mine"


def test_a_port_that_is_missing_is_told_with_its_place_and_its_mend(tmp_path: Path) -> None:
    with pytest.raises(ProfileError) as caught:
        started(tmp_path)
    (problem,) = caught.value.problems
    assert (problem.line, problem.column, problem.field) == (4, 11, "devices.pico.port")
    assert "no port matches (2e8a:0005); ports: none" in problem.message
    assert "DECK_PICO_PORT=" in problem.hint


def test_what_is_under_real_counts_on_real_hardware_alone(tmp_path: Path) -> None:
    text = (
        "devices: {eye: {source: 1, real: {source: 2}}}\n"
        'nodes: {camera: {exec: [x], params: {source: "${devices.eye.source}"}}}'
    )
    assert loaded(tmp_path, text).nodes["camera"].params["source"] == 1
    assert loaded(tmp_path, text, hardware="real").nodes["camera"].params["source"] == 2


@pytest.mark.parametrize("hardware", ["mock", "real"])
@pytest.mark.parametrize("pico", ["5", "[1]", "{port: {x: 1}}", "null", "{mock: 3}"])
def test_devices_that_make_no_sense_are_told(pico: str, hardware: str, tmp_path: Path) -> None:
    text = f'devices: {{pico: {pico}}}\nnodes: {{a: {{exec: [x, "${{devices.pico.port}}"]}}}}'
    path = written(tmp_path, text)
    with pytest.raises(ProfileError):
        load_profile(path, hardware=hardware, environ={}, ports=lambda: [PICO])


PICO_SERIAL_CHOICE = SerialPort("/dev/ttyACM0", "/dev/serial/by-id/usb-MicroPython-if00", "2e8a:0005", "Board")
LUNA = SerialPort("/dev/ttyUSB0", "/dev/serial/by-id/usb-CP2102-if00", "10c4:ea60", "CP2102")
MODEM = SerialPort("/dev/ttyACM1", "/dev/serial/by-id/usb-modem", "1234:5678", "Modem")
UART = SerialPort("/dev/ttyAMA0")

A_PICO = WantedPort(usb=KINDS["pico"])
A_LUNA = WantedPort(usb=KINDS["tf_luna"])
SERVO_BOARD = WantedPort(usb=KINDS["lsc16"])


def paths(chosen: dict[str, SerialPort | UnresolvedPort]) -> dict[str, str | None]:
    unresolved = [each for each in chosen.values() if isinstance(each, UnresolvedPort)]
    assert all("DECK_" in each.hint and "devices." in each.hint for each in unresolved)
    return {device: each.path if isinstance(each, SerialPort) else None for device, each in chosen.items()}


def test_a_pico_is_found_among_others_by_its_lasting_name() -> None:
    assert paths(choose({"pico": A_PICO}, [UART, MODEM, LUNA, PICO_SERIAL_CHOICE])) == {
        "pico": PICO_SERIAL_CHOICE.name
    }


def test_two_that_fit_are_listed_and_neither_is_taken() -> None:
    other = SerialPort("/dev/ttyACM9", "", "2e8a:0005")
    (found,) = choose({"pico": A_PICO}, [PICO_SERIAL_CHOICE, other]).values()
    assert isinstance(found, UnresolvedPort)
    assert PICO_SERIAL_CHOICE.name in found.message
    assert "/dev/ttyACM9" in found.message


def test_one_port_is_not_given_to_two_devices() -> None:
    chosen = choose({"tof_front": A_LUNA, "lsc16": SERVO_BOARD}, [LUNA])
    assert paths(chosen) == {"tof_front": None, "lsc16": None}
    unresolved = chosen["tof_front"]
    assert isinstance(unresolved, UnresolvedPort)
    assert "may be this or lsc16" in unresolved.message
