"""When a stop by the space bar reaches the gate, and nothing but the wheels is to stop."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tests.e2e.terminal import Terminal


def wait_for_the_gate(terminal: Terminal) -> None:
    """Wait in Topics until somebody is known to listen: before that a stop ends the nodes, too.

    The cursor is on whichever of the topics of that name was there first.
    """
    terminal.press("f3", "/")
    terminal.type("/emergency_stop\r")
    row = re.compile(r" /emergency_stop +std_msgs/Bool +\d+ +[1-9]")
    terminal.wait_until(lambda text: row.search(text) is not None, "a subscriber of the stop")
