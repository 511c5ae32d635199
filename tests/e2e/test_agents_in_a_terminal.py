"""An agent asks a person at a real terminal: their key lets it drive, refuses, or stops it."""

from __future__ import annotations

import asyncio
import json
from pathlib import Path

import mcp_types as types
import pytest
from mcp.client.client import Client

from tests.e2e.conftest import Deck
from tests.e2e.terminal import Terminal
from tests.ros.agents.robots import GATED, Agent, command, drive, written

pytestmark = pytest.mark.nightly

READ_S = 1.5
"""Longer than a question has to be seen before it can be allowed."""


async def answered(terminal: Terminal, agent: Agent, *keys: str) -> str:
    """Propose and execute; press these keys once asked. Return the outcome, or why not."""
    proposal = await agent.proposed(drive(0.1), reason="to look around")
    executing = asyncio.ensure_future(agent.client.call_tool("execute", {"proposal": proposal}))
    screen = await asyncio.to_thread(terminal.wait_for, "asks to move the robot")
    assert "drives at 0.1 m/s" in screen
    assert "to look around" in screen
    # Refusing takes no time, allowing does: the keys are repeated as a person would.
    while not executing.done():
        terminal.press(*keys)
        await asyncio.wait([executing], timeout=READ_S)
    (block,) = (await executing).content
    assert isinstance(block, types.TextContent)
    return block.text


async def test_a_key_lets_it_drive_refuses_or_stops(deck: Deck, tmp_path: Path) -> None:
    profile = written(tmp_path, {name: GATED[name] for name in GATED})
    terminal = deck.open(str(profile), "--lang", "en")
    await asyncio.to_thread(terminal.wait_for, "5/5")
    server = command("--lang", "en")
    server = server.model_copy(update={"env": {**(server.env or {}), **deck.env}})
    info = types.Implementation(name="claude", version="1")
    async with Client(server, client_info=info) as client:
        agent = Agent(client)
        done = json.loads(await answered(terminal, agent, "shift+f4"))
        assert done["outcome"] == "carried out"
        json.loads(await answered(terminal, agent, "shift+f5"))
        await asyncio.to_thread(terminal.wait_for, "may drive until")
        proposal = await agent.proposed(drive(0.1))
        assert (await agent.call("execute", proposal=proposal))["outcome"] == "carried out"
        await agent.call("stop")
        await asyncio.to_thread(terminal.wait_for, "■ EMERGENCY STOP")
        screen = await asyncio.to_thread(
            terminal.wait_until, lambda text: "may drive until" not in text, "no allowance"
        )
        assert "■ EMERGENCY STOP" in screen
        proposal = await agent.proposed(drive(0.1))
        assert "emergency stop is in force" in await agent.refused("execute", proposal=proposal)
        terminal.press("ctrl+r")
        await asyncio.to_thread(
            terminal.wait_until, lambda text: "■ EMERGENCY STOP" not in text, "the release"
        )
        # Last: after a refusal nobody is asked for a while.
        assert "has refused" in await answered(terminal, agent, "shift+f9")
    terminal.press("6")
    await asyncio.to_thread(terminal.wait_for, "agent")
    terminal.press("q")
