"""The lesson nodes: one file each, and each runs alone: `python -m nodes.mock_sonar`.

What they share is in the folders: `parts` (how a node lives and ends, its parameters, its words),
`drivers` (real devices), `simulated` (devices that are not there), `safety` and `driving`.
"""

from __future__ import annotations

import os
import signal
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from types import FrameType


def _leave(_number: int, _frame: FrameType | None) -> None:
    os._exit(0)


__preload__ = ("parts.runner", "parts.node", "parts.parameters", "parts.speech", "parts.qos")
"""What nearly every node imports: the launcher's spawn server may import it ahead for all."""
__preload_idle__ = (
    "parts.refusals",
    "parts.emergency",
    "driving.repeat",
    "safety.gate",
    "parts.sole_publisher",
    "parts.head_client",
    "simulated.room_scene",
    "simulated.scene",
    "drivers.servos",
    "parts.sound",
)
"""What some nodes import: the spawn server may import it while nobody waits for a node."""

if sys.argv[0] == "-m":
    # `python -m nodes.x` is importing this package on its way to the node. A Ctrl-C that comes
    # while rclpy loads finds nothing to clean up, and should not leave a traceback behind.
    signal.signal(signal.SIGINT, _leave)
    signal.signal(signal.SIGTERM, _leave)
