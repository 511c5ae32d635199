"""The command lines that the screen offers do what they say when they are pasted."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

import pytest

from tests.ros.ros2.typed import Typed, typed
from tests.waiting import wait_until
from text import ros2_words

if TYPE_CHECKING:
    from tests.ros.ros2.world import World

JSON = '{"thought": "it\'s $HOME", "commands": []}\n'


def pasted(line: str, *, until: str = "") -> Typed:
    """Run it as a shell would split it."""
    program, *words = shlex.split(line)
    assert program == "ros2"
    done = typed(*words, until=until)
    assert done.err == "", (line, done)
    return done


def test_what_is_published_arrives_as_it_was_filled_in(world: World) -> None:
    world.heard.clear()
    pasted(ros2_words.pub("/ai_command", "std_msgs/msg/String", {"data": JSON}))
    wait_until(lambda: world.heard, "the message")
    assert world.heard[0].data == JSON
    rate = ros2_words.pub("/x", "sensor_msgs/msg/JointState", {"velocity": [1e-7, float("nan")]}, 5)
    assert "velocity=[1e-07, nan]" in pasted(rate, until="publishing #1").out


@pytest.mark.parametrize(
    ("line", "shown"),
    [
        (ros2_words.echo("/word", ("data",), durability="transient_local"), "вперёд: 'x' #1\n"),
        (ros2_words.echo("/wheels", ("velocity", 1)), "array('d', [1.5, -0.25])"),
        (ros2_words.echo("/image", ("width",), reliability="best_effort"), "100\n"),
        (ros2_words.node_info("/turtle"), "  Action Clients:"),
        (ros2_words.parameter("/turtle", "speed"), "Double value is: 0.5"),
        (ros2_words.parameters("/turtle"), "ros__parameters:"),
        (ros2_words.set_parameter("/turtle", "name", ros2_words.flow("5")), "successful"),
        (ros2_words.interface("std_msgs/msg/String"), "string data"),
        (ros2_words.service_type("/add"), "AddTwoInts"),
        (ros2_words.call("/add", "example_interfaces/srv/AddTwoInts", {"a": -2, "b": 5}), "sum=3"),
        (ros2_words.action_info("/fibonacci"), "    /turtle [example_interfaces/action/Fibonacci]"),
        (ros2_words.send_goal("/fibonacci", "example_interfaces/action/Fibonacci", {"order": 3}), "SUCCEEDED"),
    ],
)
def test_it_shows_what_it_is_for(line: str, shown: str) -> None:
    echoes = line.startswith("ros2 topic echo")
    assert shown in pasted(line, until="---" if echoes else "").out


def test_a_log_of_one_node(world: World) -> None:
    line = ros2_words.log_of("/turtle")
    timer = world.node.create_timer(0.1, lambda: world.node.get_logger().info("I am here"))
    try:
        assert "msg: I am here\n" in pasted(line, until="---").out
    finally:
        world.node.destroy_timer(timer)


def test_the_way_nodes_are_started() -> None:
    arguments = ["--ros-args", "-r", "__node:=front", "-p", "rate:=2.0"]
    assert ros2_words.run("nodes.mock_sonar", arguments) == (
        "ros2 run deck_nodes mock_sonar --ros-args -r __node:=front -p rate:=2.0"
    )
    assert ros2_words.record() == "ros2 bag record --all"
