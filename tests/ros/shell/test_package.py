"""A package of one's own, as the first lesson has it, and Deck's nodes as a package."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path

import pytest

import nodes
from launcher.ros_tools import PREFIX
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


def test_colcon_says_where_it_cannot_work(run: Run, tmp_path: Path) -> None:
    python = tmp_path / "a folder" / "python"
    for path, code, words in (
        (python, 2, f"has a blank in it: {python}"),
        ("/nowhere/python", 127, "it is in Deck's extra `course`"),
    ):
        done = run(f"DECK_PYTHON={shlex.quote(str(path))} colcon build")
        assert (done.returncode, words in done.stderr) == (code, True), done


def test_what_only_cmake_builds_is_named_with_the_way_that_works(run: Run, home: Path) -> None:
    """CMake itself says that it lacks ament_cmake, or it is not there at all."""
    package = home / "src" / "lamp_interfaces"
    package.mkdir(parents=True)
    (package / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.8)\nproject(lamp_interfaces NONE)\n"
        "find_package(ament_cmake REQUIRED)\n"
    )
    (package / "package.xml").write_text(
        '<package format="3"><name>lamp_interfaces</name><version>0.0.0</version>'
        "<description>d</description><maintainer email='a@b.c'>a</maintainer><license>MIT</license>"
        "<buildtool_depend>ament_cmake</buildtool_depend>"
        "<member_of_group>rosidl_interface_packages</member_of_group>"
        "<export><build_type>ament_cmake</build_type></export></package>"
    )
    built = run("colcon build")
    assert built.returncode != 0
    if " " not in sys.executable:
        assert "lamp_interfaces is built by ament_cmake, which Deck's ROS does not" in built.stderr
        assert "copy the folder to interfaces/" in built.stderr


def test_every_node_is_an_executable_of_deck_nodes(run: Run) -> None:
    modules = {path.stem for path in Path(nodes.__file__).parent.glob("*.py")} - {"__init__"}
    seen = run("ros2 pkg executables deck_nodes")
    assert seen.stdout.splitlines() == [f"deck_nodes {name}" for name in sorted(modules)]
    helped = run("ros2 run deck_nodes mock_sonar --help")
    assert helped.returncode == 0
    assert "sonar" in helped.stdout


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("ros2 run deck_nodes no_such_node", "No executable found"),
        ("ros2 run no_such_package hello", "Package 'no_such_package' not found"),
        ("ros2 pkg prefix no_such_package", "Package not found"),
    ],
)
def test_what_is_not_there_is_said(run: Run, line: str, said: str) -> None:
    seen = run(line)
    assert (seen.returncode, seen.stderr.strip()) == (1, said)


def test_the_prefix_is_laid_out_as_one_of_ament(run: Run) -> None:
    assert run("ros2 pkg prefix deck_nodes").stdout.strip() == str(PREFIX)
    share = run("ros2 pkg prefix --share deck_nodes").stdout.strip()
    assert (Path(share) / "package.xml").is_file()
    python = "from ament_index_python import get_package_prefix as p; print(p('std_msgs'))"
    seen = run(f'python -c "{python}"')
    assert Path(seen.stdout.strip()).is_dir(), seen.stderr


@pytest.mark.parametrize(
    ("line", "instead"),
    [("bag burst x", "deck replay"), ("launch x y", "deck run")],
)
def test_what_deck_does_elsewhere_is_named(run: Run, line: str, instead: str) -> None:
    seen = run(f"ros2 {line}")
    assert seen.returncode == 2
    assert instead in seen.stderr


def test_a_static_transform_is_published_and_echoed(run: Run) -> None:
    seen = run(
        "ros2 run tf2_ros static_transform_publisher"
        " --x 0.15 --z 0.25 --frame-id base_link --child-frame-id camera_link 2>told & p=$!;"
        " ros2 run tf2_ros tf2_echo base_link camera_link 10 | grep -m 1 -A 1 '^At time';"
        " until [ -s told ]; do sleep 0.1; done; kill -INT $p; wait $p; echo $?; cat told"
    )
    echoed, _, told = seen.stdout.partition("\n0\n")
    assert echoed == "At time 0.0\n- Translation: [0.150, 0.000, 0.250]", seen.stderr
    assert "from 'base_link' to 'camera_link'" in told
