"""The format of a profile: the pydantic model for validation, and the source of the JSON schema.

Editors show the descriptions here beside a key. The model covers single values and types only;
checks across fields are in `launcher.profile.check`.
"""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema

from launcher.consent import DEFAULT_RULES as RULES
from launcher.domain.domain import LAST_DOMAIN
from launcher.profile.defaults import READY_WITHIN_S
from launcher.profile.field_marks import AsText, Joined, PathFromProfile
from launcher.profile.fields import Document, RosName, Texts, TypeName, refuse, ros_name
from launcher.profile.panels import Panel
from launcher.profile.serial_choice import KINDS
from launcher.profile.steps.model import StepDocument, Values
from text.sentences import say

Lifecycle = Literal["inactive", "active"]
Restart = Literal["never", "on-failure", "always"]

NODE_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
LONGEST_NODE_NAME = 255
MODULE = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*")
PEER = re.compile(r"[A-Za-z0-9:][A-Za-z0-9.:%_-]*")
ENV_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)


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


def _discovery(value: object) -> object:
    if value in ("localhost", "subnet"):
        return value
    if not isinstance(value, list) or not value:
        raise refuse(say("expected localhost, subnet or a list of addresses, found {value!r}", value=value))
    for peer in value:
        if not isinstance(peer, str) or not PEER.fullmatch(peer):
            raise refuse(say("{peer!r} is not an address; write it as 192.168.1.7 or robot.local", peer=peer))
    return tuple(value)


ModuleOrFile = Annotated[str, BeforeValidator(_module)]
_SCALARS: dict[str, Any] = {"type": ["string", "number", "boolean"]}
Command = Annotated[
    tuple[str, ...], BeforeValidator(_command), WithJsonSchema({"type": "array", "items": _SCALARS, "minItems": 1})
]
Discovery = Annotated[
    Any,
    BeforeValidator(_discovery),
    WithJsonSchema(
        {"anyOf": [{"enum": ["localhost", "subnet"]}, {"type": "array", "items": {"type": "string"}, "minItems": 1}]}
    ),
]


_DEVICE: dict[str, Any] = {
    "type": "object",
    "properties": {
        "kind": {
            "enum": [*KINDS, "camera", "sound"],
            "description": "The kind of device, for `port: auto` and `deck check --preflight`.",
        },
        "port": {"type": "string", "description": "A path, preferably in /dev/serial/by-id; auto: found by USB ids."},
        "usb": {
            "anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}],
            "description": "USB ids for `port: auto`, vendor:product: 2e8a:0005.",
        },
        "baud": {"type": "integer", "description": "Baud rate of the port."},
        "mock": {"type": "object", "description": "Settings that apply on mock hardware."},
        "real": {"type": "object", "description": "Settings that apply on real hardware."},
    },
}


class ReadyDocument(Document):
    """When a node counts as ready: exactly one of topic, service, node and lifecycle."""

    topic: RosName | None = Field(None, description="Ready when somebody publishes this topic.")
    type: TypeName | None = Field(
        None, description="With topic: only publishers of this type count, `std_msgs/msg/Float32`."
    )
    rate: float | None = Field(
        None,
        gt=0,
        le=1000,
        description="With topic: messages must arrive this many times a second; nine tenths of it are enough.",
    )
    service: RosName | None = Field(None, description="Ready when this service is offered.")
    node: RosName | None = Field(None, description="Ready when this node is in the ROS graph.")
    lifecycle: Lifecycle | None = Field(
        None,
        description="Ready when the node, or the one that `node` names, is in this state of its"
        " lifecycle; somebody else has to bring it there.",
    )
    within: float = Field(READY_WITHIN_S, gt=0, le=3600, description="Seconds it may take.")


class NodeDocument(Document):
    """One node: a process, and what it needs."""

    run: Annotated[ModuleOrFile | None, PathFromProfile(is_file)] = Field(
        None,
        description="Python module to run as a ROS node, named like its key: `nodes.hello`; or a"
        " file of your own, relative to the profile: `./my_sonar.py`.",
    )
    exec: Annotated[Command | None, AsText()] = Field(
        None,
        strict=False,
        description="Any command instead: `[ros2, run, package, program]`; `python` and `python3`"
        " are the ones that know rclpy: `[python, my_sonar.py]`.",
    )
    params: Annotated[dict[str, Any], Joined()] = Field({}, description="ROS parameters, nested as you like.")
    remap: Annotated[dict[str, RosName], BeforeValidator(_ros_names), AsText(), Joined()] = Field(
        {}, description="Topic and service names to remap: `{/drive: /drive_safe}`."
    )
    env: Annotated[
        dict[str, str],
        BeforeValidator(_variables),
        WithJsonSchema({"type": "object", "additionalProperties": _SCALARS}),
        AsText(),
        Joined(),
    ] = Field({}, description="Environment variables on top of the launcher's own.")
    needs: tuple[str, ...] = Field(
        (),
        strict=False,
        description="Nodes that must be ready before this one is started. Nodes excluded by `when`"
        " are not waited for.",
    )
    ready: ReadyDocument | None = Field(
        None, description="Default: `run` nodes are ready when seen in the ROS graph."
    )
    lifecycle: Lifecycle | None = Field(
        None,
        description="A node with a lifecycle is configured, and with `active` activated, once it"
        " runs; it is not ready before. A transition that fails is a failure of the node.",
    )
    restart: Restart = Field(
        "never", description="Whether to restart it when it ends; the delay doubles, up to 30 s."
    )
    when: str | None = Field(None, description='Run it only if true: `hardware == "mock"`, `hardware in ["real"]`.')
    optional: bool = Field(
        False,
        description="The lesson can do without it: that its program is not installed, or ends, is"
        " reported but is not a failure.",
    )
    warm: bool = Field(True, description="Fork it from a process that has already imported rclpy.")
    cwd: Annotated[str | None, PathFromProfile()] = Field(
        None, description="Working directory, relative to the profile's file."
    )


class AgentsDocument(Document):
    """What agents that speak to `deck mcp` may do, whatever a person allows them."""

    max_speed_m_s: float = Field(RULES.max_speed_m_s, ge=0, le=10, description="Fastest speed of a proposal, m/s.")
    max_distance_m: float = Field(RULES.max_distance_m, ge=0, le=100, description="Longest way of one proposal, m.")
    max_total_m: float = Field(
        RULES.max_total_m,
        ge=0,
        le=1000,
        description="Longest way within five minutes of all that nobody was asked about, m.",
    )
    publish: tuple[RosName, ...] = Field(
        (), strict=False, description="Topics that agents may publish on; one that moves the robot stays refused."
    )
    call: tuple[RosName, ...] = Field((), strict=False, description="Services that agents may call.")


class ProfileDocument(Document):
    """A profile of Deck: nodes started, supervised and shown together."""

    extends: str | None = Field(None, description="Another profile, by name or path; this file overrides it.")
    title: Annotated[Texts, AsText()] = Field(
        {}, description="A line for the picker, by language: `{en: ..., ru: ...}`."
    )
    about: Annotated[Texts, AsText()] = Field({}, description="What it starts and what you see, by language.")
    lesson: Annotated[str, WithJsonSchema({"type": ["string", "integer"]}), AsText()] = Field(
        "", description="Number of the lesson: 9, 4b."
    )
    domain: int | None = Field(
        None,
        ge=0,
        le=LAST_DOMAIN,
        description="ROS_DOMAIN_ID, preferably 1 to 101; by default one derived from the user.",
    )
    discovery: Discovery = Field(
        "localhost", description="Who can reach the robot: localhost, subnet, or [static peers]."
    )
    nodes: dict[str, NodeDocument | None] = Field(
        {}, description="Nodes by name; null removes a node of the extended profile."
    )
    devices: Annotated[dict[str, Annotated[dict[str, Any], WithJsonSchema(_DEVICE)]], Joined()] = Field(
        {}, description="Settings of devices, used as ${devices.pico.port} and overridden by DECK_PICO_PORT."
    )
    panels: tuple[Panel, ...] = Field(
        (), strict=False, description="Panels that the deck shows beside nodes and logs."
    )
    agents: Annotated[AgentsDocument, Joined()] = Field(
        default_factory=lambda: AgentsDocument.model_validate({}),
        description="Limits for agents, and what else they may do.",
    )
    values: Values = Field({}, description="Values that differ from run to run, used in checks as `${near_m}`.")
    steps: tuple[StepDocument, ...] = Field(
        (), strict=False, description="What the learner does, and how it is checked."
    )
