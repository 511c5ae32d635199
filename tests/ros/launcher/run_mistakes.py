"""Runs programs with mistakes one after the other, each in a fork of one process with rclpy.

Usage: run_mistakes.py FOLDER; prints a JSON object: what each program of the folder has printed.
"""

from __future__ import annotations

import json
import os
import runpy
import signal
import sys
import traceback
from pathlib import Path

import example_interfaces.srv
import geometry_msgs.msg
import rclpy  # noqa: F401
import std_msgs.msg  # noqa: F401

AT_MOST_S = 20


def run(file: Path) -> str:
    """Return what it prints; it is killed if it does not end."""
    out, into = os.pipe()
    pid = os.fork()
    if not pid:
        os.dup2(into, 1)
        os.dup2(into, 2)
        signal.alarm(AT_MOST_S)
        try:
            runpy.run_path(str(file), run_name="__main__")
        except BaseException:  # noqa: BLE001 - as an interpreter reports it
            traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)
    os.close(into)
    with os.fdopen(out, encoding="utf-8") as pipe:
        said = pipe.read()
    os.waitpid(pid, 0)
    return said


if __name__ == "__main__":
    assert example_interfaces.srv
    assert geometry_msgs.msg
    print(json.dumps({file.stem: run(file) for file in sorted(Path(sys.argv[1]).glob("*.py"))}))  # noqa: T201
