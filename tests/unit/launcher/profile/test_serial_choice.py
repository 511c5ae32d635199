"""`port: auto`: the right port by its USB ids, and never a guess."""

from __future__ import annotations

from pathlib import Path

import pytest

from launcher.profile.serial_choice import KINDS, UnresolvedPort, WantedPort, choose
from launcher.serial_ports import SerialPort, lasting_names

PICO = SerialPort("/dev/ttyACM0", "/dev/serial/by-id/usb-MicroPython-if00", "2e8a:0005", "Board")
LUNA = SerialPort("/dev/ttyUSB0", "/dev/serial/by-id/usb-CP2102-if00", "10c4:ea60", "CP2102")
SERVOS = SerialPort("/dev/ttyUSB1", "/dev/serial/by-path/usb-1.2", "1a86:7523", "USB Serial")
MODEM = SerialPort("/dev/ttyACM1", "/dev/serial/by-id/usb-modem", "1234:5678", "Modem")
UART = SerialPort("/dev/ttyAMA0")

A_PICO = WantedPort(usb=KINDS["pico"])
A_LUNA = WantedPort(usb=KINDS["tf_luna"])
SERVO_BOARD = WantedPort(usb=KINDS["lsc16"])


def paths(chosen: dict[str, SerialPort | UnresolvedPort]) -> dict[str, str | None]:
    """Return {device: path}, None where none was found; whatever is unresolved has a hint."""
    unresolved = [each for each in chosen.values() if isinstance(each, UnresolvedPort)]
    assert all("DECK_" in each.hint and "devices." in each.hint for each in unresolved)
    return {
        device: each.path if isinstance(each, SerialPort) else None
        for device, each in chosen.items()
    }


def test_a_pico_is_found_among_others_by_its_lasting_name() -> None:
    assert paths(choose({"pico": A_PICO}, [UART, MODEM, LUNA, PICO])) == {"pico": PICO.name}


def test_without_a_lasting_name_the_device_does() -> None:
    port = SerialPort("/dev/ttyACM7", "", "2e8a:0005")
    assert paths(choose({"pico": A_PICO}, [port])) == {"pico": "/dev/ttyACM7"}


def test_none_that_fits_lists_what_there_is() -> None:
    (found,) = choose({"tof_front": A_LUNA}, [MODEM, UART]).values()
    assert isinstance(found, UnresolvedPort)
    assert "10c4:ea60, 1a86:7523, 0403:6001" in found.message
    assert "usb-modem (1234:5678, Modem)" in found.message
    assert "/dev/ttyAMA0" in found.message
    assert "DECK_TOF_FRONT_PORT=" in found.hint
    (nothing,) = choose({"pico": A_PICO}, []).values()
    assert isinstance(nothing, UnresolvedPort)
    assert "ports: none" in nothing.message


def test_two_that_fit_are_listed_and_neither_is_taken() -> None:
    other = SerialPort("/dev/ttyACM9", "", "2e8a:0005")
    (found,) = choose({"pico": A_PICO}, [PICO, other]).values()
    assert isinstance(found, UnresolvedPort)
    assert PICO.name in found.message
    assert "/dev/ttyACM9" in found.message


def test_one_port_is_not_given_to_two_devices() -> None:
    chosen = choose({"tof_front": A_LUNA, "lsc16": SERVO_BOARD}, [LUNA])
    assert paths(chosen) == {"tof_front": None, "lsc16": None}
    unresolved = chosen["tof_front"]
    assert isinstance(unresolved, UnresolvedPort)
    assert "may be this or lsc16" in unresolved.message


@pytest.mark.parametrize("named", [LUNA.name, LUNA.device])
def test_what_one_device_names_is_nobody_elses(named: str) -> None:
    wanted = {"tof_front": WantedPort(named), "lsc16": SERVO_BOARD}
    assert paths(choose(wanted, [LUNA, SERVOS])) == {"lsc16": SERVOS.name}


def test_ids_of_ones_own_tell_equal_kinds_apart() -> None:
    wanted = {"tof_front": WantedPort(usb=("10c4:ea60",)), "lsc16": WantedPort(usb=("1a86:7523",))}
    assert paths(choose(wanted, [SERVOS, LUNA])) == {"tof_front": LUNA.name, "lsc16": SERVOS.name}


def test_without_ids_any_usb_device_may_be_it_but_no_uart() -> None:
    assert paths(choose({"gps": WantedPort()}, [UART, MODEM])) == {"gps": MODEM.name}
    assert paths(choose({"gps": WantedPort()}, [UART])) == {"gps": None}


def test_the_name_of_the_device_goes_before_that_of_its_socket(tmp_path: Path) -> None:
    device, twin = tmp_path / "ttyUSB0", tmp_path / "ttyUSB1"
    for port in (device, twin):
        port.touch()
    for folder, links in {
        "by-id": {"usb-CP2102": device},
        "by-path": {"usb-1.1": device, "usb-1.2": twin},
    }.items():
        (tmp_path / folder).mkdir()
        for name, port in links.items():
            (tmp_path / folder / name).symlink_to(port)
    names = lasting_names((str(tmp_path / "by-id"), str(tmp_path / "by-path")))
    assert names == {
        str(device): str(tmp_path / "by-id" / "usb-CP2102"),
        str(twin): str(tmp_path / "by-path" / "usb-1.2"),
    }
    assert lasting_names((str(tmp_path / "nowhere"),)) == {}


def test_what_a_port_looks_like() -> None:
    assert PICO.kind == "Pico with MicroPython"
    assert LUNA.kind == "CP2102 bridge: a sonar, or the servos"
    assert MODEM.kind == UART.kind == ""
    assert str(PICO) == "/dev/serial/by-id/usb-MicroPython-if00 (2e8a:0005, Board)"
    assert str(UART) == "/dev/ttyAMA0"
