"""The lesson nodes: one file each, and each runs alone: `python -m nodes.mock_sonar`.

Modules with an underscore are what they share: how a node lives and ends (`_life`), its
parameters (`_parameters`), its words (`_speech`).
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


__preload__ = ("_life", "_node", "_parameters", "_speech", "_topics")
"""What nearly every node imports: the launcher's spawn server may import it ahead for all."""
__preload_idle__ = (
    "_refusals",
    "_emergency",
    "_drive_repeat",
    "_safety_gate",
    "_sole_publisher",
    "_head_client",
    "_room_scene",
    "_scene",
    "_servo_client",
    "_sound",
)
"""What some nodes import: the spawn server may import it while nobody waits for a node."""

if sys.argv[0] == "-m":
    # `python -m nodes.x` is importing this package on its way to the node. A Ctrl-C that comes
    # while rclpy loads finds nothing to clean up, and should not leave a traceback behind.
    signal.signal(signal.SIGINT, _leave)
    signal.signal(signal.SIGTERM, _leave)
