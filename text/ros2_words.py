"""What a screen shows or does, as a command line of `ros2` to be pasted into a shell."""

from __future__ import annotations

import json
import math
import shlex
from collections.abc import Iterable, Mapping
from typing import Any

VOLATILE, RELIABLE = "volatile", "reliable"


def _line(*words: str) -> str:
    return shlex.join(("ros2", *words))


def echo(
    topic: str, path: Iterable[str | int] = (), *, reliability: str = RELIABLE, durability: str = VOLATILE
) -> str:
    """Return what prints a topic, or the part of each message that `path` leads to.

    `ros2` cannot go into an array: the path ends there. The policies are those to be requested.
    """
    words = ["topic", "echo", topic]
    fields = []
    for step in path:
        if isinstance(step, int):
            break
        fields.append(step)
    if fields:
        words += ["--field", ".".join(fields)]
    if reliability != RELIABLE:
        words += ["--qos-reliability", reliability]
    if durability != VOLATILE:
        words += ["--qos-durability", durability, "--qos-reliability", reliability]
    return _line(*words)


def log_of(node: str) -> str:
    """Return what prints the log, of one node unless `node` is empty."""
    if not node:
        return _line("topic", "echo", "/rosout")
    name = node.strip("/").replace("/", ".")
    return _line("topic", "echo", "/rosout", "--filter", f"m.name == {name!r}")


def pub(topic: str, type_name: str, value: Mapping[str, Any], hz: float | None = None) -> str:
    """Return what publishes a message once, or so many times a second."""
    how = ["--once"] if hz is None else ["--rate", f"{hz:g}"]
    return _line("topic", "pub", *how, topic, type_name, flow(value))


def call(service: str, type_name: str, request: Mapping[str, Any]) -> str:
    """Return what calls a service."""
    return _line("service", "call", service, type_name, flow(request))


def topic_info(topic: str) -> str:
    """Return what tells who publishes and hears a topic, and by which QoS."""
    return _line("topic", "info", "--verbose", topic)


def service_type(service: str) -> str:
    """Return what tells the type of a service."""
    return _line("service", "type", service)


def send_goal(action: str, type_name: str, goal: Mapping[str, Any]) -> str:
    """Return what sends a goal and shows how it gets on."""
    return _line("action", "send_goal", "--feedback", action, type_name, flow(goal))


def action_info(action: str) -> str:
    """Return what tells who serves an action."""
    return _line("action", "info", "--show-types", action)


def node_info(node: str) -> str:
    """Return what tells what a node publishes, hears and serves."""
    return _line("node", "info", node)


def parameter(node: str, name: str) -> str:
    """Return what reads a parameter."""
    return _line("param", "get", node, name)


def parameters(node: str) -> str:
    """Return what writes all parameters of a node as a file."""
    return _line("param", "dump", node)


def set_parameter(node: str, name: str, text: str) -> str:
    """Return what sets a parameter to a value in YAML."""
    return _line("param", "set", node, name, text)


def interface(type_name: str) -> str:
    """Return what shows the definition of a type."""
    return _line("interface", "show", type_name)


def tf2_echo(target: str, source: str) -> str:
    """Return what prints where the frame `source` is in `target`."""
    return _line("run", "tf2_ros", "tf2_echo", target, source)


def static_transform(target: str, source: str, translation: Iterable[float], rotation: Iterable[float]) -> str:
    """Return what publishes for ever where the frame `source` is in `target`."""
    words = ["run", "tf2_ros", "static_transform_publisher"]
    for name, number in zip("xyz", translation, strict=True):
        words += [f"--{name}", f"{number:.6g}"]
    for name, number in zip("xyzw", rotation, strict=True):
        words += [f"--q{name}", f"{number:.6g}"]
    return _line(*words, "--frame-id", target, "--child-frame-id", source)


def record(topics: Iterable[str] = ()) -> str:
    """Return what records these topics, or all."""
    return _line("bag", "record", *(topics or ("--all",)))


def play(bag: str) -> str:
    """Return what plays a recording."""
    return _line("bag", "play", bag)


def run(module: str, ros_args: Iterable[str] = ()) -> str:
    """Return what starts a node of Deck's, `nodes.mock_sonar`; `ros_args` from `--ros-args` on."""
    return _line("run", "deck_nodes", module.rpartition(".")[2], *ros_args)


def run_file(file: str, ros_args: Iterable[str] = ()) -> str:
    """Return what starts a learner's own file, which is in no package."""
    return shlex.join(["python3", file, *ros_args])


def flow(value: object) -> str:
    """Return a value as YAML in one line, as `ros2` takes it."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key}: {flow(each)}" for key, each in value.items()) + "}"
    if isinstance(value, (bytes, bytearray)):
        value = list(value)
    elif hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(flow, value)) + "]"
    return _scalar(value)


def _scalar(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and not math.isfinite(value):
        return ".nan" if math.isnan(value) else ".inf" if value > 0 else "-.inf"
    if isinstance(value, float):
        # YAML takes 1e-07 for a text.
        text = repr(value)
        return text if "e" not in text or "." in text else text.replace("e", ".0e")
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else str(value)
