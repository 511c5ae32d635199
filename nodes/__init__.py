"""The lesson nodes: one file each, and each runs on its own: `python -m nodes.mock_sonar`.

Shared code is in the folders: `parts` (how a node starts and ends, its parameters, its messages),
`drivers` (real devices), `simulated` (simulated devices), `safety` and `driving`.
"""

from __future__ import annotations

import os
import signal
import sys
from types import FrameType


def _leave(_number: int, _frame: FrameType | None) -> None:
    os._exit(0)


__preload__ = (".parts.runner", ".parts.node", ".parts.emergency")
"""Imports of nearly every node: the launcher's spawn server may import them in advance."""
__preload_idle__ = (
    ".parts.commands",
    ".parts.repeat",
    ".safety.gate",
    ".parts.head_client",
    ".simulated.scenes",
    ".drivers.servos",
    ".parts.sound",
    # Brings pydantic, which takes longer than all others together.
    "robot.commands.schema",
)
"""Imports of some nodes: the spawn server may import them while nobody waits for a node."""

if sys.argv[0] == "-m":
    # `python -m nodes.x` imports this package before the node. A Ctrl-C while rclpy loads finds
    # nothing to clean up, and should not leave a traceback behind.
    signal.signal(signal.SIGINT, _leave)
    signal.signal(signal.SIGTERM, _leave)
