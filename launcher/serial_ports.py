"""The serial ports of this machine: the connected devices and their permanent names."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from text.sentences import say

LASTING = ("/dev/serial/by-id", "/dev/serial/by-path")
"""Folders of names that outlive a plugging, the better one first: by-id goes with the device,
by-path with the socket that it is plugged into."""
PICO = "2e8a:0005"
BRIDGES = {"10c4:ea60": "CP2102", "1a86:7523": "CH340", "0403:6001": "FTDI"}
"""USB-to-serial chips used in many devices: the ids identify only the chip, not the device."""


@dataclass(frozen=True)
class SerialPort:
    """A serial port of this machine, by its permanent name where udev gives one."""

    device: str
    """Its current name in the kernel: `/dev/ttyACM0`."""
    name: str = ""
    """The permanent name, or `device` if there is none."""
    usb: str = ""
    """Vendor and product as `2e8a:0005`, empty if it is not a USB device."""
    description: str = ""

    @property
    def path(self) -> str:
        return self.name or self.device

    @property
    def kind(self) -> str:
        """What its USB ids suggest it is, for display; empty if they suggest nothing."""
        if self.usb == PICO:
            return say("Pico with MicroPython")
        if self.usb in BRIDGES:
            return say("{chip} bridge: a sonar, or the servos", chip=BRIDGES[self.usb])
        return ""

    def __str__(self) -> str:
        """Name it with everything that helps to distinguish it from others."""
        about = ", ".join(part for part in (self.usb, self.description) if part)
        return f"{self.path} ({about})" if about else self.path


def serial_ports() -> list[SerialPort]:
    """Return every port with a device behind it, in the order of the kernel's names.

    Raises:
        ImportError: if pyserial is not installed.
    """
    from serial.tools import list_ports

    names = lasting_names()
    return [
        SerialPort(
            port.device,
            names.get(os.path.realpath(port.device), ""),
            "" if port.vid is None else f"{port.vid:04x}:{port.pid or 0:04x}",
            "" if port.description in (None, "n/a") else str(port.description),
        )
        for port in sorted(list_ports.comports(), key=lambda port: str(port.device))
        # Ports of the motherboard are listed even if they have no connector.
        if port.hwid != "n/a"
    ]


def lasting_names(folders: tuple[str, ...] = LASTING) -> dict[str, str]:
    """Return {device: permanent name}; of two identical adapters only one gets their by-id name."""
    names: dict[str, str] = {}
    for folder in folders:
        for link in sorted(Path(folder).glob("*")):
            names.setdefault(os.path.realpath(link), str(link))
    return names
