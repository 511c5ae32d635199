"""Devices on mock and on real hardware, names of places, and `port: auto`."""

from __future__ import annotations

from pathlib import Path

import pytest

from launcher.errors import ProfileError
from launcher.profile.load import Profile, load_profile
from launcher.serial_ports import SerialPort
from tests.unit.profile_files import loaded, told, written

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
    """Load the robot for real hardware, as one who is about to start it."""
    path = written(folder, ROBOT)
    return load_profile(path, hardware="real", environ=environ, ports=lambda: ports)


def test_places_are_put_in_on_mock_hardware(tmp_path: Path) -> None:
    path = written(tmp_path, ROBOT)
    environ = {"DECK_RUN_DIR": "/run/x", "ROS_DOMAIN_ID": "7", "DECK_PICO_PORT": "/dev/real"}
    port = load_profile(path, environ=environ).nodes["chassis"].params["port"]
    assert port == "/run/x/devices/7/pico", "a variable never leads a mock robot to a real one"
    port = load_profile(path, environ=environ, domain=8).nodes["chassis"].params["port"]
    assert port == "/run/x/devices/8/pico"


def test_the_profiles_own_domain_counts_in_places_too(tmp_path: Path) -> None:
    profile = loaded(tmp_path, "domain: 9\n" + ROBOT)
    assert str(profile.nodes["chassis"].params["port"]).endswith("/devices/9/pico")
    assert profile.document.devices["pico"]["port"] == profile.nodes["chassis"].params["port"]
    assert "mock" not in profile.document.devices["pico"]


def test_reading_alone_looks_for_no_ports(tmp_path: Path) -> None:
    profile = loaded(tmp_path, ROBOT, hardware="real")
    assert profile.nodes["chassis"].params["port"] == "auto"


def test_auto_becomes_the_port_that_was_found(tmp_path: Path) -> None:
    profile = started(tmp_path, PICO)
    assert profile.nodes["chassis"].params["port"] == "/dev/serial/by-id/pico"
    assert profile.document.devices["pico"]["port"] == "/dev/serial/by-id/pico"
    assert profile.document.devices["other"]["port"] == "auto", "no node that runs uses it"


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


@pytest.mark.parametrize("usb", ["1234:5678", "[1234:5678]", "[1234:5678, ABCD:0001]"])
def test_usb_ids_of_ones_own(usb: str, tmp_path: Path) -> None:
    path = written(tmp_path, ROBOT.replace("kind: pico", f"usb: {usb}"))
    board = SerialPort("/dev/ttyACM3", "", "1234:5678")
    profile = load_profile(path, hardware="real", environ={}, ports=lambda: [PICO, board])
    assert profile.nodes["chassis"].params["port"] == "/dev/ttyACM3"


def test_what_is_under_real_counts_on_real_hardware_alone(tmp_path: Path) -> None:
    text = (
        "devices: {eye: {source: 1, real: {source: 2}}}\n"
        'nodes: {camera: {exec: [x], params: {source: "${devices.eye.source}"}}}'
    )
    assert loaded(tmp_path, text).nodes["camera"].params["source"] == 1
    assert loaded(tmp_path, text, hardware="real").nodes["camera"].params["source"] == 2


def test_settings_with_several_values_are_told(tmp_path: Path) -> None:
    text = "nodes: {a: {exec: [x]}}\ndevices: {d: {port: [1], mock: {port: {x: 1}}}}"
    assert told(tmp_path, text) == [
        "2:21: devices.d.port: expected a single value",
        "2:39: devices.d.mock.port: expected a single value",
    ]


def test_other_names_in_braces_stay(tmp_path: Path) -> None:
    text = 'nodes: {a: {exec: [x, "${HOME}", "${run_dirs}", "${}"], env: {D: "${domain}"}}}'
    node = loaded(tmp_path, "domain: 5\n" + text).nodes["a"]
    assert node.document.exec == ("x", "${HOME}", "${run_dirs}", "${}")
    assert node.document.env == {"D": "5"}


@pytest.mark.parametrize("hardware", ["mock", "real"])
@pytest.mark.parametrize("pico", ["5", "[1]", "{port: {x: 1}}", "null", "{mock: 3}"])
def test_devices_that_make_no_sense_are_told(pico: str, hardware: str, tmp_path: Path) -> None:
    text = f'devices: {{pico: {pico}}}\nnodes: {{a: {{exec: [x, "${{devices.pico.port}}"]}}}}'
    path = written(tmp_path, text)
    with pytest.raises(ProfileError):
        load_profile(path, hardware=hardware, environ={}, ports=lambda: [PICO])
