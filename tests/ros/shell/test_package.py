"""A package of one's own, as the first lesson has it, and Deck's nodes as a package."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import nodes
from tests.ros.shell.conftest import Run

pytestmark = pytest.mark.nightly

HELLO = """\
import signal
import sys

import rclpy
from rclpy.node import Node


def main():
    rclpy.init()
    signal.signal(signal.SIGINT, lambda *_: sys.exit(0))
    # It is ready, and may be stopped, as soon as it is in the graph.
    print('I am awake', flush=True)
    node = Node('hello_node')
    if '--once' not in sys.argv:
        rclpy.spin(node)
"""
PROFILE = """\
title: {en: My package, ru: Мой пакет}
nodes:
  hello:
    exec: [ros2, run, my_first_package, hello]
    ready: {node: /hello_node, within: 30}
panels: []
"""
CREATE = "ros2 pkg create --build-type ament_python my_first_package --dependencies rclpy std_msgs"


@pytest.mark.timeout(300)
def test_a_package_is_created_built_and_run_as_the_first_lesson_says(run: Run, home: Path) -> None:
    made = run(f"mkdir src && cd src && {CREATE}")
    assert made.returncode == 0, made.stderr
    package = home / "src" / "my_first_package"
    (package / "my_first_package" / "hello_node.py").write_text(HELLO)
    setup = package / "setup.py"
    entry = "'console_scripts': ['hello = my_first_package.hello_node:main',"
    setup.write_text(setup.read_text().replace("'console_scripts': [", entry))
    built = run("colcon build")
    if " " in sys.executable:  # What colcon writes cannot run such a Python.
        assert built.returncode == 2
        assert "move Deck to a folder without blanks" in built.stderr
        return
    assert built.returncode == 0, built.stderr
    assert "Summary: 1 package finished" in built.stdout
    assert "WARNING" not in built.stderr
    source = "source install/setup.bash"
    listed = run(f"{source} && ros2 pkg executables my_first_package")
    assert listed.stdout == "my_first_package hello\n"
    ran = run(f"{source} && ros2 run my_first_package hello --once")
    assert "I am awake" in ran.stdout + ran.stderr
    (home / "mine.yaml").write_text(PROFILE)
    deck = run(f"{source} && python -m tui run mine.yaml --for 0.1")
    assert deck.returncode == 0, deck.stdout + deck.stderr
    assert "[hello] I am awake" in deck.stdout


def test_every_node_is_an_executable_of_deck_nodes(run: Run) -> None:
    modules = {path.stem for path in Path(nodes.__file__).parent.glob("*.py")} - {"__init__"}
    seen = run("ros2 pkg executables deck_nodes")
    assert seen.stdout.splitlines() == [f"deck_nodes {name}" for name in sorted(modules)]
    helped = run("ros2 run deck_nodes mock_sonar --help")
    assert helped.returncode == 0
    assert "sonar" in helped.stdout
