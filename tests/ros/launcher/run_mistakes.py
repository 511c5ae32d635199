"""Runs programs with mistakes one after the other, each in a fork of one process with rclpy.

Usage: run_mistakes.py FOLDER [--lines]; prints a JSON object: what each program of the folder has
printed. With --lines, of what fails only the line is known and not its part, as in Python 3.10.
"""

from __future__ import annotations

import gc
import json
import os
import signal
import sys
from pathlib import Path

import cv2
import cv_bridge
import example_interfaces.msg
import example_interfaces.srv
import geometry_msgs.msg
import nav_msgs.msg
import numpy as np
import pydantic
import sensor_msgs.msg
import std_msgs.msg
import std_srvs.srv
import tf2_ros

from launcher import node_program
from launcher.faults import explain, failure

AT_MOST_S = 20
WARM = (
    cv2, cv_bridge, example_interfaces, explain, geometry_msgs, nav_msgs, np, pydantic,
    sensor_msgs, std_msgs, std_srvs, tf2_ros,
)  # fmt: skip
"""What the programs and the explanations import, once for all."""


def run(file: Path) -> str:
    """Return what it prints; it is killed if it does not end."""
    out, into = os.pipe()
    pid = os.fork()
    if not pid:
        os.dup2(into, 1)
        os.dup2(into, 2)
        signal.alarm(AT_MOST_S)
        node_program.prepare((str(file),))
        try:
            node_program.run(str(file))
        except BaseException:  # noqa: BLE001 - as an interpreter reports it
            sys.excepthook(*sys.exc_info())
        sys.stderr.flush()
        os._exit(1)
    os.close(into)
    with os.fdopen(out, encoding="utf-8", errors="surrogateescape") as pipe:
        said = pipe.read()
    os.waitpid(pid, 0)
    return said


if __name__ == "__main__":
    assert all(WARM)
    for module in tuple(sys.modules.values()):
        if hasattr(module, "ros_python_check_fields"):
            module.ros_python_check_fields = "1"  # type: ignore[attr-defined]
    if "--lines" in sys.argv:
        failure._position = lambda _level: None  # type: ignore[assignment]
    gc.freeze()
    files = sorted(Path(sys.argv[1]).glob("mistake_*.py"))
    sys.stdout.write(json.dumps({file.stem: run(file) for file in files}))
