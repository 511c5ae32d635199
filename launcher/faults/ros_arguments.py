"""A learner's program that takes the arguments of ROS for its own.

Deck starts a node as `ros2 run` does: what stands after `--ros-args` is for rclpy.
https://design.ros2.org/articles/ros_command_line_arguments.html
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.status import NodeFault
from text.plain import plain
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from text.sentences import Words

_OF_ROS = re.compile(r"--ros-args|__node:=|__ns:=")
_ERROR = re.compile(r"\berror:", re.IGNORECASE)
_READS_ARGUMENTS = re.compile(r"\.parse(?:_known)?_args\s*\(|\bsys\.argv\b|\bgetopt\b")
_LAST_LINES = 8
_LONGEST = 200


def meaning_of_arguments(exception: str) -> Words | None:
    """Return what an exception means in which an argument of ROS stands, None if none does."""
    if not _OF_ROS.search(exception):
        return None
    return say(
        "the arguments of ROS stand after --ros-args, and this reads them as its own; take them "
        "out first: rclpy.utilities.remove_ros_args(sys.argv)[1:], as in parser.parse_args(...)"
    )


def refused_arguments(lines: Sequence[str], file: str) -> NodeFault | None:
    """Return the fault if the last lines of a program say that it refuses an argument of ROS."""
    for line in reversed(lines[-_LAST_LINES:]):
        meaning = meaning_of_arguments(line) if _ERROR.search(line) else None
        if meaning is not None:
            number, source = _reading_line(file)
            return NodeFault("crash", file, number, 0, source, plain(line.strip()[:_LONGEST]), meaning)
    return None


def _reading_line(file: str) -> tuple[int, str]:
    """Return number and text of the line that reads the command line; (0, "") if none does."""
    try:
        lines = Path(file).read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return 0, ""
    found = [
        (number, plain(line.strip()[:_LONGEST]))
        for number, line in enumerate(lines, 1)
        if _READS_ARGUMENTS.search(line)
    ]
    return found[-1] if found else (0, "")
