"""The safety node on a machine that stands for a second in the midst of taking a command in."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

from nodes.parts.runner import run
from nodes.safety.gate import CommandGate
from nodes.safety_stop import SafetyStop

if TYPE_CHECKING:
    from ackermann_msgs.msg import AckermannDriveStamped

    from robot.words import DriveSetpoint

NAP_S = 1.0
granted = CommandGate._granted


def slowly_granted(self: CommandGate, source: str, message: AckermannDriveStamped) -> DriveSetpoint:
    """Stand still, and judge only then."""
    time.sleep(NAP_S)
    return granted(self, source, message)


if __name__ == "__main__":
    CommandGate._granted = slowly_granted  # type: ignore[method-assign]
    sys.exit(run(SafetyStop))
