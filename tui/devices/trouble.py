"""Trouble that the simulated robot can have: parameters of its node, set as `ros2 param` does.

The values are those of `nodes.mock_robot`.
"""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from text.i18n import N_

if TYPE_CHECKING:
    from tui.devices.drivers import Device
    from tui.session.feed import Feed
    from tui.session.ports import GraphLink

ROBOT = "nodes.mock_robot"
LINES = frozenset({"pico", "tof_front", "tof_rear", "lsc16"})
"""Its pseudo-terminals, and the parameters for the trouble of each."""
POWERED = frozenset({"pico", "lsc16"})
"""The devices that measure the battery."""
_REAL = PurePosixPath("/dev")


@dataclass(frozen=True)
class SimulatedTrouble:
    """The values of a parameter with and without the trouble."""

    wrong: str | float
    fine: str | float
    told: str
    """Sentence with {device}, marked by `N_`."""
    over: str
    """The same for when it is cleared; it names only this trouble, as there may be others."""
    parameter: str = ""
    """Empty: the parameter named after the device."""
    devices: frozenset[str] = LINES
    """Devices that can have it."""


UNPLUGGED = SimulatedTrouble(
    "unplugged", "fine", N_("{device}: the cable is pulled."), N_("{device}: the cable is plugged in again.")
)
NOISE = SimulatedTrouble(
    "noise", "fine", N_("{device}: there is noise on the line."), N_("{device}: the noise is gone.")
)
SILENCE = SimulatedTrouble(
    "silent", "fine", N_("{device}: it has gone silent."), N_("{device}: it sends data again.")
)
BATTERY = SimulatedTrouble(5.8, 7.4, N_("The battery has 5.8 V."), N_("The battery has 7.4 V."), "battery", POWERED)


def simulated(device: Device | None, feed: Feed) -> tuple[str, str] | None:
    """Return the full name of the simulated robot's node, and which of its lines the device is.

    None for a device that is not simulated, and while the robot is not in the graph.
    """
    if device is None or feed.graph is None or feed.replay is not None or feed.update is None:
        return None
    port = PurePosixPath(device.port)
    if port.name not in LINES or _REAL in port.parents:
        return None
    robots = {name for name, node in feed.nodes.items() if node.command == ROBOT}
    names = [row.name for row in feed.update.nodes if row.name.rpartition("/")[2] in robots]
    return (names[0], port.name) if names else None


async def switch(graph: GraphLink, node: str, device: str, trouble: SimulatedTrouble) -> tuple[bool, str]:
    """Cause the trouble, or clear it; return whether it is present now, or why that failed."""
    name = trouble.parameter or device
    read = await asyncio.wrap_future(graph.parameters(node))
    now = next((row.value for row in read.parameters if row.name == name), None)
    if read.error or now is None:
        return False, read.error or name
    made = now != trouble.wrong
    done = await asyncio.wrap_future(graph.set_parameters(node, {name: trouble.wrong if made else trouble.fine}))
    return made, done.error or done.refused.get(name, "")
