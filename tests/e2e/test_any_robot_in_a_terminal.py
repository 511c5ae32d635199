"""Deck on a robot that is not this one: robot, its nodes, its brain, the course and the agents are not installed."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from std_msgs.msg import String

from tests.e2e.conftest import ROOT, Deck
from tests.ros.peer import Peer

WITHOUT = ("agents", "brain", "course", "nodes", "robot")
REFUSING = f"""
import sys


class Refusing:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {WITHOUT}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)


sys.meta_path.insert(0, Refusing())
"""
TALKER = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

rclpy.init()
node = Node("talker")
publisher = node.create_publisher(String, "/chatter", 10)
node.create_timer(0.2, lambda: publisher.publish(String(data="hello")))
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    pass
"""
PROFILE = """
title: Two that talk
nodes:
  talker:
    run: ./talker.py
    ready: {topic: /chatter, type: std_msgs/msg/String}
  other:
    exec: [python, talker.py, --ros-args, -r, "__node:=other"]
    roles: [drives]
"""


@pytest.fixture
def elsewhere(tmp_path: Path) -> dict[str, str]:
    """An environment in which these rooms cannot be imported."""
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(REFUSING)
    env = {"PYTHONPATH": str(tmp_path / "site")}
    for room in WITHOUT:
        python = [sys.executable, "-c", f"import {room}"]
        refused = subprocess.run(python, cwd=ROOT, env=env, capture_output=True, text=True, check=False)
        assert f"No module named '{room}'" in refused.stderr
    return env


def test_a_domain_of_others_is_watched(deck: Deck, ros_domain: int, elsewhere: dict[str, str]) -> None:
    with Peer(ros_domain) as peer:
        publisher = peer.node.create_publisher(String, "/chatter", 10)
        peer.node.create_timer(0.2, lambda: publisher.publish(String(data="hello")))
        terminal = deck.open("watch", env=elsewhere)
        screen = terminal.wait_for("1 node runs here")
        assert "Graph" in screen
        assert "Composer" not in screen
        terminal.press("2")
        terminal.wait_for("hello")
        for key, words in (
            ("5", "/chatter"),
            ("8", "/tf"),
            ("9", "Space"),
            ("0", "Nothing that the wall"),
            ("4", "Logs"),
            ("1", "1 node runs here"),
        ):
            terminal.press(key)
            terminal.wait_for(words)
        # Nothing is there to drive, to send, or to be learnt.
        for key in ("t", "3", "L", "6", "7"):
            terminal.press(key)
        terminal.press("space")
        terminal.wait_for("EMERGENCY STOP")
        terminal.press("q")
        assert terminal.wait_exit() == 0


def test_plain_nodes_are_started(deck: Deck, tmp_path: Path, elsewhere: dict[str, str]) -> None:
    (tmp_path / "talker.py").write_text(TALKER)
    (tmp_path / "plain.yaml").write_text(PROFILE)
    terminal = deck.open(str(tmp_path / "plain.yaml"), env=elsewhere)
    terminal.wait_for("● ready")
    terminal.press("2")
    terminal.wait_for("hello")
    terminal.press("q")
    assert terminal.wait_exit() == 0
