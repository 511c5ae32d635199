"""A node, from the profile that describes it to the supervisor that runs it.

Each field is declared here alone: how a value is read (`AsText`), what a path is relative to
(`PathFromProfile`), how `extends` treats it (`Joined`), and whether the loader gives it (`Given`).
Editors show the descriptions beside a key. Single values and types are checked here; what concerns several
fields in `launcher.profile.check`.
"""

from __future__ import annotations

import os
import re
import sys
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from launcher import node_program
from launcher.parts import (
    AsText,
    Checked,
    Given,
    Joined,
    Part,
    PathFromProfile,
    RosName,
    TypeName,
    key,
    refuse,
    ros_name,
)
from text.robot import Role, robot
from text.sentences import say
from text.yaml_scalars import in_quotes
from text.yaml_scalars import written as single

Lifecycle = Literal["inactive", "active"]
Restart = Literal["never", "on-failure", "always"]

READY_WITHIN_S = 10.0
"""How long a node may take to become ready."""
PYTHONS = ("python", "python3")
NODE_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
LONGEST_NODE_NAME = 255
MODULE = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*")
ENV_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_COLD_PREFIXES = ("PYTHON", "LD_", "RMW_", "OPENBLAS_", "OMP_", "MALLOC_", "LTTNG_", "AMENT_")
"""Variables read when an interpreter or a library is loaded: after a fork it is too late."""


def is_file(run: str) -> bool:
    """Whether `run` means a file, not a module."""
    return run.startswith(("./", "../", "/"))


def _module(value: object) -> object:
    if isinstance(value, str) and not is_file(value) and not MODULE.fullmatch(value):
        raise refuse(
            say(
                "{value!r} is not a Python module; write a module as nodes.hello, a file of your own as ./my_node.py",
                value=value,
            )
        )
    return value


def _ros_names(value: object) -> object:
    for old in value if isinstance(value, dict) else ():
        ros_name(old)
    return value


def _variables(value: object) -> object:
    for name, text in value.items() if isinstance(value, dict) else ():
        if not ENV_NAME.fullmatch(name):
            raise refuse(say("{name!r} is not a valid name for an environment variable", name=name))
        if isinstance(text, str) and "\0" in text:
            raise refuse(say("the variable {name} holds a NUL character", name=name))
    return value


def _command(value: object) -> object:
    if isinstance(value, str):
        raise refuse(say("expected a list, found a single text; write [{words}]", words=", ".join(value.split())))
    if value == []:
        raise refuse(say("an empty command; write for example [ros2, run, package, program]"))
    if isinstance(value, list) and any("\0" in str(word) for word in value):
        raise refuse(say("a command cannot hold a NUL character"))
    return value


_SCALARS: dict[str, Any] = {"type": ["string", "number", "boolean"]}
ModuleOrFile = Annotated[str, Checked(_module)]
Command = Annotated[tuple[str, ...], Checked(_command, {"type": "array", "items": _SCALARS, "minItems": 1})]


def written(value: Any) -> str:  # noqa: ANN401 - a parameter
    """Write a parameter so that rcl and any YAML parser read back the same value and type.

    Text is always written in quotes: `"1"` stays text.
    """
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    return in_quotes(value) if isinstance(value, str) else single(value)


@dataclass(frozen=True)
class Ready(Part):
    """When a node counts as ready: exactly one of topic, service, node and lifecycle."""

    topic: RosName | None = key(None, "Ready when somebody publishes this topic.")
    type: TypeName | None = key(None, "With topic: only publishers of this type count, `std_msgs/msg/Float32`.")
    rate: float | None = key(
        None,
        "With topic: messages must arrive this many times a second; nine tenths of it are enough.",
        gt=0,
        le=1000,
    )
    service: RosName | None = key(None, "Ready when this service is offered.")
    node: RosName | None = key(None, "Ready when this node is in the ROS graph.")
    lifecycle: Lifecycle | None = key(
        None,
        "Ready when the node, or the one that `node` names, is in this state of its"
        " lifecycle; somebody else has to bring it there.",
    )
    within: float = key(READY_WITHIN_S, "Seconds it may take.", gt=0, le=3600)
    goes: Annotated[bool, Given()] = False
    """With lifecycle: whether the node is to be brought to that state, not only waited for."""


@dataclass(frozen=True)
class Node(Part):
    """One node: a process, and what it needs."""

    name: Annotated[str, Given()] = ""
    """Its key in the profile; for a `run` node also its name in the ROS graph."""
    run: Annotated[ModuleOrFile | None, PathFromProfile(is_file)] = key(
        None,
        "Python module to run as a ROS node, named like its key: `nodes.hello`; or a"
        " file of your own, relative to the profile: `./my_sonar.py`.",
    )
    roles: tuple[Role, ...] = key(
        (),
        "What it is for the robot: `[drives]` for one that commands the wheels; by default what a node"
        " of Deck says of itself.",
        strict=False,
    )
    exec: Annotated[Command | None, AsText()] = key(
        None,
        "Any command instead: `[ros2, run, package, program]`; `python` and `python3`"
        " are the ones that know rclpy: `[python, my_sonar.py]`.",
        strict=False,
    )
    params: Annotated[dict[str, Any], Joined()] = key({}, "ROS parameters, nested as you like.")
    """Once loaded, flattened: `{"limits.front": 0.5}`."""
    remap: Annotated[dict[str, RosName], Checked(_ros_names), AsText(), Joined()] = key(
        {}, "Topic and service names to remap: `{/drive: /drive_safe}`."
    )
    env: Annotated[
        dict[str, str], Checked(_variables, {"type": "object", "additionalProperties": _SCALARS}), AsText(), Joined()
    ] = key({}, "Environment variables on top of the launcher's own.")
    needs: tuple[str, ...] = key(
        (),
        "Nodes that must be ready before this one is started. Nodes excluded by `when` are not waited for.",
        strict=False,
    )
    """Once loaded, only those that run."""
    ready: Ready | None = key(None, "Default: `run` nodes are ready when seen in the ROS graph.")
    lifecycle: Lifecycle | None = key(
        None,
        "A node with a lifecycle is configured, and with `active` activated, once it"
        " runs; it is not ready before. A transition that fails is a failure of the node.",
    )
    restart: Restart = key("never", "Whether to restart it when it ends; the delay doubles, up to 30 s.")
    when: str | None = key(None, 'Run it only if true: `hardware == "mock"`, `hardware in ["real"]`.')
    optional: bool = key(
        False,
        "The lesson can do without it: that its program is not installed, or ends, is reported but is not a failure.",
    )
    warm: bool = key(True, "Fork it from a process that has already imported rclpy.")
    cwd: Annotated[str | None, PathFromProfile()] = key(None, "Working directory, relative to the profile's file.")
    """Absolute; by default the folder in which the launcher was started."""

    def __post_init__(self) -> None:
        """Add the roles that a module says of itself: a profile takes none away, such as that it drives."""
        announced = robot().roles.get(self.run or "", ())
        object.__setattr__(self, "roles", tuple(dict.fromkeys((*announced, *self.roles))))

    @property
    def command(self) -> str:
        """Its program, for display."""
        if self.run is not None:
            return f"./{os.path.basename(self.run)}" if "/" in self.run else self.run  # noqa: PTH119
        words = self.exec or ()
        return " ".join([words[0], os.path.basename(self.file), *words[2:]] if self.file else words)  # noqa: PTH119

    @property
    def is_python(self) -> bool:
        """Whether it is a command that begins with `python`: Deck's own, which knows rclpy."""
        return bool(self.exec) and (self.exec or ("",))[0] in PYTHONS

    @property
    def is_ours(self) -> bool:
        """Whether it is a module of Deck, which is never confined."""
        return self.run is not None and node_program.is_ours(self.run)

    @property
    def drives(self) -> bool:
        """Whether it commands the wheels."""
        return "drives" in self.roles

    @property
    def file(self) -> str:
        """The learner's own Python file that it runs, absolute; empty if it runs none."""
        if self.run is not None:
            return self.run if "/" in self.run else ""
        words = self.exec or ()
        if not self.is_python or len(words) < 2 or not words[1].endswith(".py"):
            return ""
        return os.path.normpath(os.path.join(self.cwd or os.getcwd(), words[1]))  # noqa: PTH109, PTH118

    @property
    def is_forked(self) -> bool:
        """Whether it is forked from a process that has imported rclpy."""
        return self.run is not None and self.warm and not any(name.startswith(_COLD_PREFIXES) for name in self.env)

    @property
    def conditions(self) -> tuple[Ready, ...]:
        """Everything that has to hold before it is ready, in this order."""
        ready = self.ready
        if self.lifecycle is None:
            return () if ready is None else (ready,)
        # Beside a lifecycle, `node` only says whose it is.
        managed = self.name if ready is None or ready.node is None else ready.node
        goes = Ready(node=managed, lifecycle=self.lifecycle, goes=True)
        waits = ready is not None and (ready.topic or ready.service or ready.lifecycle)
        return (goes, ready) if ready is not None and waits else (goes,)

    @property
    def within_s(self) -> float:
        return READY_WITHIN_S if self.ready is None else self.ready.within

    def ros_args(self) -> list[str]:
        """Return `--ros-args` and everything after it; empty for a command without parameters."""
        named = ["-r", f"__node:={self.name}"] if self.run is not None else []
        remaps = [part for old, new in self.remap.items() for part in ("-r", f"{old}:={new}")]
        parameters = [part for name, value in self.params.items() for part in ("-p", f"{name}:={written(value)}")]
        arguments = [*named, *remaps, *parameters]
        return ["--ros-args", *arguments] if arguments else []

    def argv(self) -> list[str]:
        """Return the full command line for a start without the spawn server."""
        words = list(self.exec or ())
        if self.run is not None or self.file:
            words[:2] = [sys.executable, "-u", node_program.__file__, self.run or self.file]
        elif self.is_python:
            words[0] = sys.executable
        return [*words, *self.ros_args()]
