"""Two nodes in one file are two in the graph, though Deck names the node of a profile anew."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from launcher import node_program

TALKER = """\
import rclpy
from rclpy.node import Node
rclpy.init()
nodes = [Node(name) for name in ("talker", "listener", "talker")]
print(*(node.get_name() for node in nodes))
"""


@pytest.mark.parametrize(
    ("given", "names"),
    [("mine", "mine listener mine"), ("listener", "talker listener talker"), ("talker", "talker listener talker")],
)
def test_only_the_first_is_named_anew(given: str, names: str, tmp_path: Path, ros_domain: int) -> None:
    file = tmp_path / "nodes.py"
    file.write_text(TALKER)
    done = subprocess.run(
        [sys.executable, node_program.__file__, file, "--ros-args", "-r", f"__node:={given}"],
        env={**os.environ, "ROS_DOMAIN_ID": str(ros_domain)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == f"{names}\n"
    assert done.stderr.count("already registered") == 1, "of the two talkers"
