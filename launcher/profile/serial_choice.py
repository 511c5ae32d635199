"""`port: auto`: which of the ports that are there belongs to which device, by their USB ids.

Never a guess: a device that could have two ports, or a port that could be two devices', is told
with all that was found, and a person chooses.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from launcher.profile.device_variables import variable
from launcher.serial_ports import BRIDGES, PICO
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from launcher.serial_ports import SerialPort

AUTO = "auto"
KINDS: Mapping[str, tuple[str, ...]] = {
    "pico": (PICO,),
    "tf_luna": tuple(BRIDGES),
    "tfmini_s": tuple(BRIDGES),
    "lsc16": tuple(BRIDGES),
}
"""Kind of device to the USB ids that it is known to come with."""


@dataclass(frozen=True)
class WantedPort:
    """What is known of a device's port."""

    port: str = AUTO
    """`auto`, or a path that somebody has chosen."""
    usb: tuple[str, ...] = ()
    """Ids to look for; empty: whatever is a USB device."""


@dataclass(frozen=True)
class Unclear:
    """Why a device has no port."""

    message: str
    hint: str


def choose(
    wanted: Mapping[str, WantedPort], ports: Sequence[SerialPort]
) -> dict[str, SerialPort | Unclear]:
    """Return for each device with `auto` its port, or why there is none.

    A port that another device names is nobody else's.
    """
    taken = {each.port for each in wanted.values() if each.port != AUTO}
    free = [port for port in ports if not taken & {port.device, port.name}]
    fitting = {
        device: [port for port in free if port.usb and (not each.usb or port.usb in each.usb)]
        for device, each in wanted.items()
        if each.port == AUTO
    }
    return {device: _one(device, wanted[device], fitting, ports) for device in fitting}


def how_to_choose(device: str) -> str:
    """Say where a person writes the port of a device."""
    return say(
        "choose with {variable}=/dev/serial/by-id/..., or devices.{device}.port in a profile of"
        " yours",
        variable=variable(device, "port"),
        device=device,
    )


def _one(
    device: str,
    wanted: WantedPort,
    fitting: Mapping[str, Sequence[SerialPort]],
    ports: Sequence[SerialPort],
) -> SerialPort | Unclear:
    found = fitting[device]
    rivals = [other for other in fitting if other != device and set(fitting[other]) & set(found)]
    if len(found) == 1 and not rivals:
        return found[0]
    if not found:
        looked = ", ".join(wanted.usb) or say("any USB device")
        there = "; ".join(map(str, ports)) or say("none")
        message = say("no port fits ({usb}); ports: {ports}", usb=looked, ports=there)
    elif len(found) == 1:
        message = say(
            "{port} may be this or {others}", port=str(found[0]), others=", ".join(rivals)
        )
    else:
        listed = "; ".join(map(str, found))
        message = say("several ports fit: {ports}", ports=listed)
    return Unclear(message, how_to_choose(device))
