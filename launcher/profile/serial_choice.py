"""`port: auto`: assigning the existing serial ports to devices, by their USB ids.

This never guesses: if several ports fit a device, or several devices a port, everything found is
reported and the user chooses.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from launcher.serial_ports import BRIDGES, PICO, SerialPort
from text.sentences import say

AUTO = "auto"
KINDS: Mapping[str, tuple[str, ...]] = {
    "pico": (PICO,),
    "tf_luna": tuple(BRIDGES),
    "tfmini_s": tuple(BRIDGES),
    "lsc16": tuple(BRIDGES),
}
"""Kind of device to the USB ids that it is known to have."""


@dataclass(frozen=True)
class WantedPort:
    """The settings of a device that concern its port."""

    port: str = AUTO
    """`auto`, or a path chosen by the user."""
    usb: tuple[str, ...] = ()
    """USB ids to look for; empty: any USB device."""


@dataclass(frozen=True)
class UnresolvedPort:
    """Why no port could be chosen for a device."""

    message: str
    hint: str


def choose(wanted: Mapping[str, WantedPort], ports: Sequence[SerialPort]) -> dict[str, SerialPort | UnresolvedPort]:
    """Return the port of each device with `auto`, or why there is none.

    A port that is set explicitly for one device is not given to another.
    """
    taken = {each.port for each in wanted.values() if each.port != AUTO}
    free = [port for port in ports if not taken & {port.device, port.name}]
    fitting = {
        device: [port for port in free if port.usb and (not each.usb or port.usb in each.usb)]
        for device, each in wanted.items()
        if each.port == AUTO
    }
    return {device: _one(device, wanted[device], fitting, ports) for device in fitting}


def variable(device: str, setting: str) -> str:
    """Return the name of the environment variable that overrides a device's setting."""
    return re.sub(r"\W", "_", f"DECK_{device}_{setting}".upper(), flags=re.ASCII)


def how_to_choose(device: str) -> str:
    """Say where the user can set the port of a device."""
    return say(
        "choose with {variable}=/dev/serial/by-id/..., or devices.{device}.port in your own profile",
        variable=variable(device, "port"),
        device=device,
    )


def _one(
    device: str, wanted: WantedPort, fitting: Mapping[str, Sequence[SerialPort]], ports: Sequence[SerialPort]
) -> SerialPort | UnresolvedPort:
    found = fitting[device]
    rivals = [other for other in fitting if other != device and set(fitting[other]) & set(found)]
    if len(found) == 1 and not rivals:
        return found[0]
    if not found:
        looked = ", ".join(wanted.usb) or say("any USB device")
        there = "; ".join(map(str, ports)) or say("none")
        message = say("no port matches ({usb}); ports: {ports}", usb=looked, ports=there)
    elif len(found) == 1:
        message = say("{port} may be this or {others}", port=str(found[0]), others=", ".join(rivals))
    else:
        listed = "; ".join(map(str, found))
        message = say("several ports fit: {ports}", ports=listed)
    return UnresolvedPort(message, how_to_choose(device))
