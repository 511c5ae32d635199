"""Robots for agents: a real session, and `deck mcp` started by the client of the SDK."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import mcp_types as types
from mcp.client.client import Client
from mcp.client.stdio import StdioServerParameters

from launcher.client.client import SupervisorClient, attach, launch
from launcher.status import NodeState
from tests.ros.supervised import until_state

REPEAT_FOR_S = 1.0
GATED: dict[str, Any] = {
    "sonar": {
        "run": "nodes.mock_sonar",
        "params": {"pattern": "constant", "value": 3.0, "rate": 10.0},
    },
    # It holds the first command that it ever hears for `settle_s`.
    "safety_stop": {
        "run": "nodes.safety_stop",
        "params": {"gate": True, "rate": 20.0, "settle_s": 0.1},
    },
    "electronic_differential": {
        "run": "nodes.electronic_differential",
        "params": {"drive_topic": "/drive_safe", "rate": 20.0, "max_age_s": 0.5},
    },
    "head_controller": {"run": "nodes.head_controller"},
    "llm_parser": {"run": "nodes.llm_parser", "params": {"repeat_for_s": REPEAT_FOR_S}},
}


def written(folder: Path, nodes: dict[str, Any], agents: dict[str, Any] | None = None) -> Path:
    """Write a profile; JSON is YAML."""
    path = folder / "robot.yaml"
    path.write_text(json.dumps({"title": "Test", "nodes": nodes, "agents": agents or {}}), "utf-8")
    return path


@asynccontextmanager
async def running(
    folder: Path, domain: int, nodes: dict[str, Any], agents: dict[str, Any] | None = None
) -> AsyncIterator[SupervisorClient]:
    """A session that is up, as a screen would see it; it does not attend to agents yet."""
    link = await launch(written(folder, nodes, agents), domain=domain)
    try:
        for name in nodes:
            await until_state(link, name, NodeState.READY, NodeState.RUNNING)
        yield link
    finally:
        await link.shutdown(now=True)


@asynccontextmanager
async def screen() -> AsyncIterator[SupervisorClient]:
    """A screen at which a person can answer."""
    link = await attach()
    await link.attend()
    try:
        yield link
    finally:
        await link.aclose()


class Agent:
    """An agent that calls tools."""

    def __init__(self, client: Client) -> None:
        self.client = client

    async def call(self, tool: str, **arguments: object) -> dict[str, Any]:
        """Call a tool that answers; return its facts."""
        result = await self.client.call_tool(tool, arguments)
        assert not result.is_error, result.content
        facts: dict[str, Any] = result.structured_content
        return facts

    async def refused(self, tool: str, **arguments: object) -> str:
        """Call a tool that refuses; return why."""
        result = await self.client.call_tool(tool, arguments)
        assert result.is_error, result.content
        (block,) = result.content
        assert isinstance(block, types.TextContent)
        return block.text

    async def proposed(self, *commands: dict[str, object], reason: str = "") -> str:
        """Propose; return the id."""
        proposal = (await self.call("propose", commands=list(commands), reason=reason))["proposal"]
        assert isinstance(proposal, str)
        return proposal


def command(*options: str) -> StdioServerParameters:
    """The command that an agent is told to start."""
    return StdioServerParameters(
        command=sys.executable, args=["-m", "tui", "mcp", *options], env=dict(os.environ)
    )


@asynccontextmanager
async def agent(*options: str, name: str = "claude") -> AsyncIterator[Agent]:
    """An agent that has started `deck mcp`."""
    info = types.Implementation(name=name, version="1")
    async with Client(command(*options), client_info=info) as client:
        yield Agent(client)


def drive(speed: float, steering: float = 0.0) -> dict[str, object]:
    """A drive."""
    return {"action": "drive", "speed": speed, "steering": steering}
