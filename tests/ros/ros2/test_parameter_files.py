"""Files of parameters, and nodes whose parameters have no values, as `ros2 param` takes them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import yaml
from rclpy.parameter import Parameter

from tests.ros.ros2.typed import Typed, typed

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.ros2.world import World


def loaded(file: Path, text: str, *more: str) -> Typed:
    file.write_text(text)
    return typed("param", "load", "/turtle", str(file), *more)


def test_a_parameter_without_a_value_is_left_out_of_a_dump(world: World) -> None:
    world.node.declare_parameter("port", Parameter.Type.STRING)
    try:
        dumped = typed("param", "dump", "/turtle")
        assert (dumped.code, dumped.err) == (0, "")
        held = yaml.safe_load(dumped.out)["/turtle"]["ros__parameters"]
        assert "port" not in held
        assert (held["speed"], held["safe"]) == (0.5, {"near": 3})
    finally:
        world.node.undeclare_parameter("port")


def test_files_are_loaded_as_ros_does(world: World, tmp_path: Path) -> None:
    file = tmp_path / "turtle.yaml"
    text = (
        "/**:\n  other:\n    ros__parameters: {speed: 9.0}\n"
        "/**:\n  turtle:\n    ros__parameters: {speed: 0.25}\n"
        "turtle:\n  ros__parameters: {safe: {near: 4}}\n"
    )
    done = loaded(file, text)
    assert (done.code, done.err) == (0, "")
    assert done.out == "Set parameter speed successful\nSet parameter safe.near successful\n"
    values = [world.node.get_parameter(name).value for name in ("speed", "safe.near")]
    assert values == [0.25, 4]
    text = "/*:\n  ros__parameters: {speed: 2.0}\nturtle:\n  ros__parameters: {safe.near: 3}\n"
    assert loaded(file, text, "--no-use-wildcard").out == "Set parameter safe.near successful\n"
    assert loaded(file, "turtle:\n  ros__parameters: {name: '5', speed: 0.5}\n").code == 0
    assert world.node.get_parameter("name").value == "5"
    world.node.set_parameters([Parameter("name", value="лис")])


def test_files_that_cannot_be_loaded_are_refused_in_words(tmp_path: Path) -> None:
    file = tmp_path / "turtle.yaml"
    for text, why in (
        ("", "1:1: the file is empty"),
        ("/other:\n  ros__parameters: {a: 1}\n", "1:1: the file has nothing for /turtle"),
        ("turtle:\n  ros__parameters:\n    a: [1\n", "3:"),
        ("turtle:\n  ros__parameters:\n    a:\n", "3:5: 'a' has no value"),
    ):
        refused = loaded(file, text)
        assert (refused.code, refused.out) == (1, "")
        assert refused.err.startswith(f"{file}:{why}"), refused.err
    big = loaded(file, "turtle:\n  ros__parameters: {a: 99999999999999999999}\n")
    assert big.err == "a: 99999999999999999999 is too large for a 64-bit integer\n"
    file.unlink()
    assert "No such file" in typed("param", "load", "/turtle", str(file)).err
