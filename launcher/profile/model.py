"""The format of a profile: the pydantic model for validation, and the source of the JSON schema.

`python -m launcher.profile.model > profiles/schema.json` writes the schema, for editors. What a node
may say is in `launcher.profile.node`, what a step may say in `launcher.profile.steps`.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, WithJsonSchema

from launcher.consent import AgentRules
from launcher.domain.domain import LAST_DOMAIN, default_domain
from launcher.errors import ProfileProblem
from launcher.parts import AsText, Given, Joined, Texts, refuse
from launcher.profile.node import Node
from launcher.profile.panels import Panel
from launcher.profile.serial_choice import KINDS
from launcher.profile.steps.checks import Document
from launcher.profile.steps.model import StepDocument, Values
from text.sentences import say

PEER = re.compile(r"[A-Za-z0-9:][A-Za-z0-9.:%_-]*")


def _discovery(value: object) -> object:
    if value in ("localhost", "subnet"):
        return value
    if not isinstance(value, list) or not value:
        raise refuse(say("expected localhost, subnet or a list of addresses, found {value!r}", value=value))
    for peer in value:
        if not isinstance(peer, str) or not PEER.fullmatch(peer):
            raise refuse(say("{peer!r} is not an address; write it as 192.168.1.7 or robot.local", peer=peer))
    return tuple(value)


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


class Profile(Document):
    """A profile of Deck: nodes started, supervised and shown together."""

    extends: str | None = Field(default=None, description="Another profile, by name or path; this file overrides it.")
    title: Annotated[Texts, AsText()] = Field(
        default={}, description="A line for the picker, by language: `{en: ..., ru: ...}`."
    )
    about: Annotated[Texts, AsText()] = Field(default={}, description="What it starts and what you see, by language.")
    lesson: Annotated[str, WithJsonSchema({"type": ["string", "integer"]}), AsText()] = Field(
        default="", description="Number of the lesson: 9, 4b."
    )
    domain: int = Field(
        default_factory=default_domain,
        ge=0,
        le=LAST_DOMAIN,
        description="ROS_DOMAIN_ID, preferably 1 to 101; by default one derived from the user.",
    )
    """Once loaded, the one to run in, wherever it was set."""
    discovery: Discovery = Field(
        default="localhost", description="Who can reach the robot: localhost, subnet, or [static peers]."
    )
    nodes: dict[str, Node] = Field(
        default={}, description="Nodes by name; null removes a node of the extended profile."
    )
    """Once loaded, only those that run on this hardware, in file order."""
    devices: Annotated[dict[str, Annotated[dict[str, Any], WithJsonSchema(_DEVICE)]], Joined()] = Field(
        default={}, description="Settings of devices, used as ${devices.pico.port} and overridden by DECK_PICO_PORT."
    )
    panels: tuple[Panel, ...] = Field(
        default=(), strict=False, description="Panels that the deck shows beside nodes and logs."
    )
    agents: Annotated[AgentRules, Joined()] = Field(
        default_factory=AgentRules, description="Limits for agents, and what else they may do."
    )
    values: Values = Field(
        default={}, description="Values that differ from run to run, used in checks as `${near_m}`."
    )
    steps: tuple[StepDocument, ...] = Field(
        default=(), strict=False, description="What the learner does, and how it is checked."
    )
    path: Annotated[Path, Given()] = Path()
    """Absolute."""
    name: Annotated[str, Given()] = ""
    """File name without its suffix: `09-brain`; of a lesson.yaml, the name of its folder."""
    hardware: Annotated[str, Given()] = "mock"
    is_domain_chosen: Annotated[bool, Given()] = False
    """Whether somebody has chosen the domain: in the profile, by `--domain` or by ROS_DOMAIN_ID."""
    used: Annotated[tuple[str, ...], Given()] = ()
    """The devices that its nodes refer to, in file order."""
    warnings: Annotated[tuple[ProfileProblem, ...], Given()] = ()
    """Things that are allowed but probably not intended."""


def render() -> str:
    """Return the correct content of `profiles/schema.json`."""
    schema: dict[str, Any] = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    schema |= Profile.model_json_schema(by_alias=True)
    nodes = schema["properties"]["nodes"]
    nodes["additionalProperties"] = {"anyOf": [nodes["additionalProperties"], {"type": "null"}]}
    return json.dumps(_without_noise(schema), indent=2, ensure_ascii=False) + "\n"


def _without_noise(value: Any) -> Any:  # noqa: ANN401 - any JSON
    """Drop pydantic's additions, which would only clutter the hints of an editor."""
    if isinstance(value, list):
        return [_without_noise(item) for item in value]
    if not isinstance(value, dict):
        return value
    return {
        key: _without_noise(inner)
        for key, inner in value.items()
        if not (key == "title" and isinstance(inner, str) and "description" in value)
        and not (key == "default" and inner in (None, {}, [], ""))
    }


if __name__ == "__main__":
    sys.stdout.write(render())
