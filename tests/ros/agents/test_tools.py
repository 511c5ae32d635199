"""What an agent sees, proposes and carries out, and who lets it."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import json
import time
from pathlib import Path
from typing import Any

import cv2
import mcp_types as types
import numpy as np
import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from std_msgs.msg import Bool, ByteMultiArray, String
from std_srvs.srv import Trigger

from launcher.client.client import SupervisorClient
from launcher.consent import AUDIT_FILE, ConsentAnswer
from launcher.control.consent import REFUSED_FOR_S
from launcher.status import NodeState, Severity
from nodes.parts.stop_reports import named
from robot.safety.stop_file import TOPIC, StopFile
from robot.safety.stop_record import Stop
from robot.topics import DRIVE_SAFE, LLM_RESULT
from tests.ros.agents.robots import GATED, Agent, agent, drive, running, screen
from tests.ros.peer import Peer
from tests.ros.supervised import until_state
from tests.waiting import until

pytestmark = pytest.mark.nightly

PARSER: dict[str, Any] = GATED["llm_parser"]


def speeds(peer: Peer) -> list[AckermannDriveStamped]:
    """Return what reaches the wheels, from now on."""
    return peer.hear(DRIVE_SAFE, AckermannDriveStamped)


def moved(told: list[AckermannDriveStamped]) -> bool:
    """Whether the wheels were told to turn."""
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
            f"agent “claude” does {answer['proposal']}: "
            "drives at 0.2 m/s, steering 0.1 rad, for 1 s: 0.20 m at most"
        )


async def test_an_emergency_stop_ends_questions_proposals_and_allowances(
    tmp_path: Path, ros_domain: int, peer: Peer
) -> None:
    told = speeds(peer)
    robot = running(tmp_path, ros_domain, GATED)
    async with robot as link, screen() as person, agent() as claude:
        await lets(claude)
        early = await claude.proposed(drive(0.1))
        executing = asyncio.create_task(claude.call("execute", proposal=early))
        await person.answer(await asked(person), ConsentAnswer.FOR_A_TIME)
        await executing
        # Allowed for a time: without a question.
        await claude.call("execute", proposal=await claude.proposed(drive(0.1)))
        told.clear()

        kept = await claude.proposed(drive(0.1))
        stopped = await claude.call("stop")
        assert "/safety_stop" in stopped["held_by"]
        await until(lambda: not person.agents.connected[0].allowed_until_s, "no allowance")
        late = await claude.proposed(drive(0.1))
        # A stop that is in force is the reason, also once it has ended what was proposed since.
        await claude.call("echo", topic="/safety_state", count=3)
        for proposal in (kept, late):
            why = await claude.refused("execute", proposal=proposal)
            assert "emergency stop is in force" in why
        assert (await claude.call("look"))["emergency_stop"]["engaged"]
        assert "there is no tool" in await claude.refused("release")

        release = peer.node.create_publisher(Bool, "/emergency_stop", 10)

        async def free() -> bool:
            release.publish(Bool(data=False))
            return not (await claude.call("look"))["emergency_stop"]["engaged"]

        await until(free, "the release", every_s=0.2)
        for proposal in (kept, late):
            assert "no proposal" in await claude.refused("execute", proposal=proposal)
        # A node that starts now hears of no stop any more.
        await link.restart("llm_parser")
        await until_state(link, "llm_parser", NodeState.STARTING, NodeState.WAITING)
        await until_state(link, "llm_parser", NodeState.READY)
        await lets(claude)

        async def drives() -> bool:
            proposal = await claude.proposed(drive(0.1))
            executing = asyncio.create_task(claude.call("execute", proposal=proposal))
            await person.answer(await asked(person), ConsentAnswer.ONCE)
            assert not (await executing)["stopped_by_emergency_stop"]
            return moved(told)

        # The gate may not have found the new node yet, and it drives for 1 s only.
        await until(drives, "wheels that turn")
        await until(lambda: told[-1].drive.speed == 0.0, "the end of the drive")
        told.clear()
        asking = await claude.proposed(drive(0.1))
        refusing = asyncio.create_task(claude.refused("execute", proposal=asking))
        await asked(person)
        peer.node.create_publisher(Bool, "/emergency_stop", 10)
        stop = peer.node.create_publisher(Bool, "/emergency_stop", 10)
        await until(lambda: stop.get_subscription_count() >= 3, "nodes that hear a stop")
        stop.publish(Bool(data=True))
        assert "ended the question" in await refusing
        assert not moved(told)


async def test_limits_that_no_approval_lifts(tmp_path: Path, ros_domain: int, peer: Peer) -> None:
    told = speeds(peer)
    rules = {"max_speed_m_s": 0.1, "max_distance_m": 0.1, "max_total_m": 0.15}
    async with running(tmp_path, ros_domain, GATED, rules):
        async with agent("--approve", "always") as claude:
            why = await claude.refused("propose", commands=[drive(0.11)])
            assert "too fast" in why
            await lets(claude)
            await claude.call("execute", proposal=await claude.proposed(drive(0.1)))
            assert moved(told)
            over = await claude.proposed(drive(-0.1))
            assert "within five minutes" in await claude.refused("execute", proposal=over)
        await until(lambda: told[-1].drive.speed == 0.0, "the end of the drive")
        async with agent("--approve", "never") as claude:
            told.clear()
            proposal = await claude.proposed(drive(0.1))
            assert "--approve never" in await claude.refused("execute", proposal=proposal)
            assert "--approve never" in await claude.refused("head", pan=10, tilt=0)
            assert not moved(told)


@pytest.mark.parametrize(
    ("nodes", "why"),
    [
        ({name: node for name, node in GATED.items() if name != "llm_parser"}, "no node hears"),
        ({"head_controller": {"run": "nodes.head_controller"}, "llm_parser": PARSER}, "no safety"),
        ({**GATED, "llm_parser": {"run": "nodes.llm_parser"}}, "does not end a drive"),
        ({**GATED, "other": {"run": "nodes.electronic_differential"}}, "past the safety gate"),
        ({**GATED, "parser_2": PARSER}, "several nodes"),
    ],
    ids=["no parser", "no gate", "no end", "past the gate", "two parsers"],
)
async def test_where_no_safe_road_leads_to_the_wheels_it_does_not_drive(
    tmp_path: Path, ros_domain: int, nodes: dict[str, Any], why: str
) -> None:
    async with running(tmp_path, ros_domain, nodes), agent("--approve", "always") as claude:
        assert why in await claude.refused("propose", commands=[drive(0.1)])


async def test_the_lesson_of_json_turns_the_head_but_does_not_drive(ros_domain: int) -> None:
    from launcher.client.client import launch
    from launcher.profile.catalog import find_profile

    link = await launch(find_profile("10-llm-json"), domain=ros_domain)
    try:
        async with agent("--approve", "always", "10") as claude:

            async def served() -> bool:
                return "no safety gate" in await claude.refused("propose", commands=[drive(0.1)])

            await until(served, "the reason", every_s=0.2)
            done = await claude.call("head", pan=20, tilt=-10)
            assert done["head"] == [{"pan": 20, "tilt": -10, "sum": 1, "error": None}]
    finally:
        await link.shutdown(now=True)


async def test_it_sees_echoes_and_speaks(tmp_path: Path, ros_domain: int, peer: Peer) -> None:
    heard = peer.hear("/audio/speaker_raw", ByteMultiArray)
    nodes = {"mock_camera": {"run": "nodes.mock_camera"}, "sonar": GATED["sonar"]}
    async with running(tmp_path, ros_domain, nodes), agent() as claude:
        seen = await claude.client.call_tool("see", {"width": 320})
        image, _facts = seen.content
        assert isinstance(image, types.ImageContent)
        assert image.mime_type == "image/jpeg"
        picture = cv2.imdecode(np.frombuffer(base64.b64decode(image.data), np.uint8), 1)
        assert picture is not None
        assert picture.shape == (240, 320, 3)
        assert "nobody publishes pictures" in await claude.refused("see", topic="/nothing")

        echoed = await claude.call("echo", topic="sensor/sonar_front", count=2)
        assert echoed["messages"] == ["data: 3.0\n"] * 2
        assert "nobody publishes" in await claude.refused("echo", topic="/nothing")
        assert "not a ROS name" in await claude.refused("echo", topic="/../etc/passwd")
        assert "count" in await claude.refused("echo", topic="/rosout", count=1000)
        names = [row["topic"] for row in (await claude.call("topics", contains="sonar"))["topics"]]
        assert "/sensor/sonar_front" in names
        found = (await claude.call("graph", contains="mock_camera"))["nodes"]
        assert [node["node"] for node in found] == ["/mock_camera"]

        assert (await claude.call("say", text="I see a ball"))["said"] == "I see a ball"
        await until(lambda: heard, "the voice")
        assert b"".join(heard[0].data) == b"I see a ball"
        assert "drives the robot" in await claude.refused("say", text="Вперёд!")
        assert "drives the robot" in await claude.refused("say", text="please go Back now")


async def test_publish_and_call_are_what_the_profile_lists(
    tmp_path: Path, ros_domain: int, peer: Peer
) -> None:
    lamp = peer.hear("/lamp", String)
    orders = peer.hear("/ai_command", String)

    def serve(_request: Trigger.Request, answer: Trigger.Response) -> Trigger.Response:
        answer.message = "on"
        return answer

    peer.node.create_service(Trigger, "/lamp_on", serve)
    rules = {"publish": ["/lamp", "/ai_command"], "call": ["/lamp_on", "/sonar/set_parameters"]}
    nodes = {"sonar": GATED["sonar"]}
    async with running(tmp_path, ros_domain, nodes, rules), agent() as claude:

        async def names() -> bool:
            tools = {tool.name for tool in (await claude.client.list_tools()).tools}
            return {"publish", "call"} <= tools

        await until(names, "the tools")
        done = await claude.call("publish", topic="/lamp", message={"data": "green"})
        assert done["subscribers"] >= 1
        await until(lambda: lamp, "the message")
        assert "message" in await claude.refused("publish", topic="/lamp")
        why = await claude.refused("publish", topic="/lamp", message={"colour": 1})
        assert "colour" in why
        why = await claude.refused("publish", topic="/ai_command", message={"data": "forward"})
        assert "may move the robot" in why
        assert "does not list" in await claude.refused("publish", topic="/other", message={})
        assert "message: 'on'" in (await claude.call("call", service="/lamp_on", request={}))[
            "answer"
        ].replace('"', "'")
        why = await claude.refused("call", service="/sonar/set_parameters", request={})
        assert "changes how a node works" in why
        assert not orders


async def test_agents_come_before_the_session_and_outlive_it(
    tmp_path: Path, ros_domain: int
) -> None:
    nodes = {"sonar": GATED["sonar"]}

    async def sees(claude: Agent, words: str) -> bool:
        result = await claude.client.call_tool("look", {})
        return words in str(result.content)

    async with agent() as claude:
        assert "no robot to speak to" in await claude.refused("look")
        assert "no robot to speak to" in await claude.refused("stop")
        async with running(tmp_path, ros_domain, nodes):
            await until(lambda: sees(claude, '"session": "robot"'), "the session", every_s=0.2)
        await until(lambda: sees(claude, "no robot to speak to"), "its end", every_s=0.2)
        async with running(tmp_path, ros_domain, nodes):
            await until(lambda: sees(claude, '"session": "robot"'), "the next one", every_s=0.2)


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
            executing = asyncio.create_task(
                claude.client.call_tool("execute", {"proposal": proposal})
            )
            await until(lambda: moved(told), "wheels that turn")
        with contextlib.suppress(Exception):
            await executing
        # By itself it would end after 50 s.
        await until(lambda: told[-1].drive.speed == 0.0, "wheels that stand", within_s=20.0)
        await until(lambda: not link.agents.connected, "its end")
        assert ("execute", "cancelled by the agent") in audited(link)


async def test_a_question_goes_with_the_agent_that_asks(tmp_path: Path, ros_domain: int) -> None:
    async with running(tmp_path, ros_domain, GATED), screen() as person:
        async with agent() as claude:
            await lets(claude)
            proposal = await claude.proposed(drive(0.1))
            executing = asyncio.create_task(
                claude.client.call_tool("execute", {"proposal": proposal})
            )
            number = await asked(person)
        with contextlib.suppress(Exception):
            await executing
        await until(lambda: not person.agents.questions, "the end of the question")
        assert not await person.answer(number, ConsentAnswer.ONCE)


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
