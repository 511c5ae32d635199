"""What an agent sees, proposes and carries out, who lets it, and who gets in by HTTP."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import signal
import sys
import time
import urllib.error
import urllib.request
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path
from typing import Any

import mcp_types as types
import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from mcp.client.client import Client
from mcp.client.stdio import StdioServerParameters
from std_msgs.msg import Bool, String

from launcher.client.client import SupervisorClient, attach, launch
from launcher.consent import AUDIT_FILE, ConsentAnswer
from launcher.control.consent import REFUSED_FOR_S
from launcher.status import NodeState, Severity
from nodes.parts.stop_news import named
from robot.topics import DRIVE_SAFE, LLM_RESULT
from safety.stop_file import TOPIC, StopFile
from safety.stop_record import Stop
from tests.deck_process import DeckProcess, deck
from tests.ros.peer import Peer
from tests.ros.supervised import until_state
from tests.slowness import patient
from tests.waiting import until, wait_until

pytestmark = pytest.mark.nightly
REPEAT_FOR_S = 1.0
GATED: dict[str, Any] = {
    "sonar": {"run": "nodes.mock_sonar", "params": {"pattern": "constant", "value": 3.0, "rate": 10.0}},
    # It holds the first command that it ever hears for `settle_s`.
    "safety_stop": {"run": "nodes.safety_stop", "params": {"gate": True, "rate": 20.0, "settle_s": 0.1}},
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
        result = await self.client.call_tool(tool, arguments)
        assert not result.is_error, result.content
        facts: dict[str, Any] = result.structured_content
        return facts

    async def refused(self, tool: str, **arguments: object) -> str:
        result = await self.client.call_tool(tool, arguments)
        assert result.is_error, result.content
        (block,) = result.content
        assert isinstance(block, types.TextContent)
        return block.text

    async def proposed(self, *commands: dict[str, object], reason: str = "") -> str:
        proposal = (await self.call("propose", commands=list(commands), reason=reason))["proposal"]
        assert isinstance(proposal, str)
        return proposal


def command(*options: str) -> StdioServerParameters:
    """The command that an agent is told to start."""
    return StdioServerParameters(command=sys.executable, args=["-m", "tui", "mcp", *options], env=dict(os.environ))


@asynccontextmanager
async def agent(*options: str, name: str = "claude") -> AsyncIterator[Agent]:
    """An agent that has started `deck mcp`."""
    info = types.Implementation(name=name, version="1")
    async with Client(command(*options), client_info=info) as client:
        yield Agent(client)


def drive(speed: float, steering: float = 0.0) -> dict[str, object]:
    return {"action": "drive", "speed": speed, "steering": steering}


def speeds(peer: Peer) -> list[AckermannDriveStamped]:
    """Return what reaches the wheels, from now on."""
    return peer.hear(DRIVE_SAFE, AckermannDriveStamped)


def moved(told: list[AckermannDriveStamped]) -> bool:
    return any(one.drive.speed != 0.0 for one in told)


def accepted(results: list[String]) -> int:
    """Return how many responses were carried out."""
    return sum(json.loads(one.data)["event"] == "accepted" for one in results)


async def lets(claude: Agent) -> None:
    """Wait until the gate, which has just started, lets the robot drive."""

    async def free() -> bool:
        result = await claude.client.call_tool("propose", {"commands": [drive(0.1)]})
        return not result.is_error and bool(result.structured_content["gate_lets"])

    await until(free, "a gate that lets it", every_s=0.2)


async def asked(link: SupervisorClient) -> int:
    """Return the number of the question that is on the screen."""
    (question,) = await until(lambda: link.agents.questions, "a question")
    return question.number


def audited(link: SupervisorClient) -> list[tuple[str, str]]:
    """Return tool and outcome of each call so far."""
    lines = Path(link.session.log_dir, AUDIT_FILE).read_text("utf-8").splitlines()
    return [(line["tool"], line["outcome"]) for line in map(json.loads, lines)]


async def leaves_the_person_alone(claude: Agent) -> None:
    """Ask again after a refusal, in vain, and return once that is possible again."""
    until_s = time.monotonic() + REFUSED_FOR_S
    why = await claude.refused("execute", proposal=await claude.proposed(drive(0.2)))
    assert "the person has just refused: nothing is asked for another" in why
    await until(lambda: time.monotonic() > until_s, "the time in which nobody is asked")


async def test_it_looks_and_drives_only_as_far_as_the_person_lets_it(
    tmp_path: Path, ros_domain: int, peer: Peer
) -> None:
    told = speeds(peer)
    results = peer.hear(LLM_RESULT, String)
    async with running(tmp_path, ros_domain, GATED) as link, agent() as claude:
        await lets(claude)
        state = await claude.call("look")
        assert state["session"] == "robot"
        assert state["sonar_m"]["front"] == pytest.approx(3.0, abs=0.1)
        assert state["gate"]["verdict"] == "free"
        assert state["approval"] == "ask"

        # Without a screen nobody can be asked.
        proposal = await claude.proposed(drive(0.2), reason="why not")
        assert "no screen" in await claude.refused("execute", proposal=proposal)

        async with screen() as person:
            answer = await claude.call("propose", commands=[drive(0.2, 0.1)], reason="to see more")
            assert answer["distance_m"] == pytest.approx(0.2)
            assert answer["gate_lets"]
            executing = asyncio.create_task(claude.call("execute", proposal=answer["proposal"]))
            number = await asked(person)
            (question,) = person.agents.questions
            assert question.agent == "claude"
            assert [str(line) for line in question.lines] == [
                "drives at 0.2 m/s, steering 0.1 rad, for 1 s: 0.20 m at most",
                "the gate would let it: free for 3.00 m",
                "it says: to see more",
            ]
            assert not moved(told)
            assert not results
            await person.answer(number, ConsentAnswer.ONCE)
            assert (await executing)["outcome"] == "carried out"
            assert moved(told)
            assert max(one.drive.speed for one in told) == pytest.approx(0.2)
            await until(lambda: told[-1].drive.speed == 0.0, "the end of the drive")
            assert accepted(results) == 1
            again = await claude.refused("execute", proposal=answer["proposal"])
            assert "carried out once" in again

            told.clear()
            proposal = await claude.proposed(drive(0.2))
            refusing = asyncio.create_task(claude.refused("execute", proposal=proposal))
            await person.answer(await asked(person), ConsentAnswer.REFUSE)
            assert "has refused" in await refusing
            await leaves_the_person_alone(claude)
            assert not moved(told)

        # The screen goes away while it is asked.
        async with screen() as person:
            proposal = await claude.proposed(drive(0.2))
            refusing = asyncio.create_task(claude.refused("execute", proposal=proposal))
            await asked(person)
        assert "the screen was closed" in await refusing
        assert not moved(told)
        assert accepted(results) == 1
        assert ("execute", "begins") in audited(link)
        assert audited(link)[-1][0] == "execute"
        lines = [line for line in await link.history(None, 200) if line.source == "agent"]
        (does,) = [line.text for line in lines if line.severity is Severity.INFO]
        assert does == (
            f"agent “claude” does {answer['proposal']}: drives at 0.2 m/s, steering 0.1 rad, for 1 s: 0.20 m at most"
        )


async def test_an_agent_that_goes_away_leaves_a_robot_that_stands(
    tmp_path: Path, ros_domain: int, peer: Peer
) -> None:
    told = speeds(peer)
    long = {"run": "nodes.llm_parser", "params": {"repeat_for_s": 50.0}}
    nodes = {**GATED, "llm_parser": long}
    async with running(tmp_path, ros_domain, nodes, {"max_distance_m": 10.0}) as link:
        async with agent("--approve", "always") as claude:
            await lets(claude)
            proposal = await claude.proposed(drive(0.1))
            executing = asyncio.create_task(claude.client.call_tool("execute", {"proposal": proposal}))
            await until(lambda: moved(told), "wheels that turn")
        with contextlib.suppress(Exception):
            await executing
        # By itself it would end after 50 s.
        await until(lambda: told[-1].drive.speed == 0.0, "wheels that stand", within_s=20.0)
        await until(lambda: not link.agents.connected, "its end")
        assert ("execute", "cancelled by the agent") in audited(link)


async def test_a_stop_that_only_the_server_of_agents_hears_is_passed_on(
    tmp_path: Path, ros_domain: int, peer: Peer
) -> None:
    """Nobody here obeys, a screen is not there: what is on disk is from `deck mcp`."""
    file = StopFile(ros_domain, "/test")
    heard: list[Stop] = []
    hear: Any = lambda _, info: heard.append(named(info))  # noqa: E731 - rclpy's types lack this form
    peer.node.create_subscription(Bool, "/emergency_stop", hear, 10)
    async with running(tmp_path, ros_domain, {"sonar": GATED["sonar"]}), agent() as claude:
        await claude.call("look")
        stop = peer.node.create_publisher(Bool, "/emergency_stop", 10)

        async def kept() -> bool:
            stop.publish(Bool(data=True))
            return file.read().record.engaged

        await until(kept, "the stop on disk", every_s=0.2)
        saved = file.read()
        await until(lambda: saved.record.held <= set(heard), "the name that all know")
        assert saved.stop is not None
        assert saved.stop.by == TOPIC


# ---------------------------------------------------------------- by HTTP


HELLO = {
    "jsonrpc": "2.0",
    "id": 1,
    "method": "initialize",
    "params": {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "raw", "version": "1"}},
}


@pytest.fixture(autouse=True)
def _own_config(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))


@contextmanager
def http() -> Iterator[tuple[DeckProcess, str, str]]:
    (token,) = deck("mcp", "--show-token").lines
    process = DeckProcess("mcp", "--http", "--port", "0", "--lang", "en")
    try:
        said = wait_until(lambda: process.errors[:1], "its address")
        yield process, said[0].split()[0], token
        process.signal(signal.SIGINT)
        assert process.finish() == 0
        assert process.lines == []
        assert token not in "".join(process.errors)
    finally:
        process.close()


def status(address: str, **headers: str) -> int:
    body = json.dumps(HELLO).encode()
    given = {
        "Content-Type": "application/json",
        "Accept": "application/json, text/event-stream",
        **{name.replace("_", "-"): value for name, value in headers.items()},
    }
    try:
        with urllib.request.urlopen(urllib.request.Request(address, body, given), timeout=patient(20)) as it:
            return int(it.status)
    except urllib.error.HTTPError as error:
        return error.code


def test_only_who_knows_the_token_gets_in_and_no_web_page(ros_domain: int) -> None:
    del ros_domain
    with http() as (_process, address, token):
        right = f"Bearer {token}"
        assert address.startswith("http://127.0.0.1:")
        assert status(address) == 401
        assert status(address, Authorization="Bearer wrong") == 401
        assert status(address, Authorization=token) == 401
        assert status(address + f"?token={token}") == 401
        assert status(address, Authorization=right) == 200
        assert status(address, Authorization=right, Host="evil.example") == 421
        assert status(address, Authorization=right, Origin="http://evil.example") == 403
