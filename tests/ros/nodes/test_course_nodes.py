"""Any node of the course does its part in Deck's lesson, in the place of Deck's own.

The nodes of `tests/course` have the topics, types and names of the course, and nothing of what
Deck's have beyond it: no stamps, no parameters, no states.
"""

from __future__ import annotations

import contextlib
import json
import shutil
from collections.abc import AsyncIterator, Iterator
from pathlib import Path
from typing import Any

import pytest
from example_interfaces.srv import AddTwoInts
from sensor_msgs.msg import JointState
from std_msgs.msg import ByteMultiArray, String

from launcher.client.client import SupervisorClient, launch
from launcher.status import NodeState
from tests.ros.peer import Peer
from tests.ros.supervised import said, until_state
from tests.waiting import until

COURSE = Path(__file__).parents[2] / "course"
READY = NodeState.READY
RUNNING = NodeState.RUNNING


@pytest.fixture
def person(ros_domain: int) -> Iterator[Peer]:
    with Peer(ros_domain, "person") as peer:
        yield peer


@contextlib.asynccontextmanager
async def lesson(
    folder: Path, domain: int, name: str, changes: dict[str, Any]
) -> AsyncIterator[SupervisorClient]:
    """Run a lesson with nodes exchanged, by the way that README tells."""
    shutil.copytree(COURSE, folder, dirs_exist_ok=True)
    path = folder / "mine.yaml"
    path.write_text(json.dumps({"extends": name, "nodes": changes}))
    client = await launch(path, domain=domain)
    try:
        yield client
    finally:
        await client.shutdown()


def turns(wheels: list[Any]) -> bool:
    """Whether a wheel has been asked to turn."""
    return any(abs(message.velocity[0]) > 0.1 for message in wheels)


@pytest.mark.parametrize(
    ("node", "file"),
    [
        ("sonar_front", "mock_sonar"),
        ("camera", "mock_camera"),
        ("head_controller", "head_controller"),
        ("ai_driver", "ai_driver"),
        ("audio", "mock_audio"),
        ("ai_brain", "ai_brain"),
    ],
)
async def test_the_whole_robot_hears_answers_and_drives(
    tmp_path: Path, ros_domain: int, person: Peer, node: str, file: str
) -> None:
    wheels = person.hear("/wheel_commands", JointState)
    answers = person.hear("/audio/speaker_raw", ByteMultiArray)
    async with lesson(tmp_path, ros_domain, "09-brain", {node: {"run": f"./{file}.py"}}) as client:
        for name in client.nodes:
            await until_state(client, name, RUNNING, READY)
        phrase = ByteMultiArray(data=[bytes([byte]) for byte in b"VOICE_COMMAND: look around"])
        with person.saying("/audio/mic_raw", phrase, 1.0):
            await until(lambda: answers, "an answer", 30)
            await until(lambda: turns(wheels), "wheels that turn", 60)


@pytest.mark.parametrize(
    ("node", "file"), [("head_controller", "head_controller"), ("llm_parser", "llm_parser")]
)
async def test_a_json_drives_and_turns_the_head(
    tmp_path: Path, ros_domain: int, person: Peer, node: str, file: str
) -> None:
    wheels = person.hear("/wheel_commands", JointState)
    changes = {node: {"run": f"./{file}.py"}}
    async with lesson(tmp_path, ros_domain, "10-llm-json", changes) as client:
        for name in list(client.nodes):
            await until_state(client, name, READY)
        assert person.ask("set_head_position", AddTwoInts, AddTwoInts.Request(a=5, b=5)).sum == 1
        drive = {"action": "drive", "speed": 0.3, "steering": 0.1}
        turn = {"action": "turn_head", "pan": 30, "tilt": 0}
        answer = {"thought": "Off we go.", "commands": [drive, turn]}
        with person.saying("/llm_raw_json", String(data=json.dumps(answer)), 1.0):
            await until(lambda: turns(wheels), "wheels that turn", 30)
        head = "turning to 30" if node == "head_controller" else ""
        await said(client, "head_controller", head)


async def test_pictures_are_looked_at(tmp_path: Path, ros_domain: int) -> None:
    changes = {"vlm_agent": {"run": "./vlm_agent_stub.py"}}
    async with lesson(tmp_path, ros_domain, "07-vision", changes) as client:
        await until_state(client, "camera", READY)
        assert (await said(client, "vlm_agent", "a picture of ")).startswith("640x480")


async def test_distances_are_warned_of(tmp_path: Path, ros_domain: int) -> None:
    changes = {"safety_stop": {"run": "./safety_stop.py"}}
    async with lesson(tmp_path, ros_domain, "02-sonar-safety", changes) as client:
        await until_state(client, "safety_stop", RUNNING, READY)
        await said(client, "safety_stop", "far: ")


async def test_seconds_are_counted(tmp_path: Path, ros_domain: int) -> None:
    changes = {"hello": {"run": "./hello.py"}}
    async with lesson(tmp_path, ros_domain, "01-hello", changes) as client:
        await said(client, "hello", "second 2")


async def test_a_differential_that_only_writes_its_log_holds_nobody_up(
    tmp_path: Path, ros_domain: int, person: Peer
) -> None:
    changes = {"electronic_differential": {"run": "./electronic_differential.py"}}
    async with lesson(tmp_path, ros_domain, "10-llm-json", changes) as client:
        await until_state(client, "llm_parser", READY)
        drive = {"action": "drive", "speed": 0.3, "steering": 0.0}
        answer = {"thought": "Off we go.", "commands": [drive]}
        with person.saying("/llm_raw_json", String(data=json.dumps(answer)), 1.0):
            await said(client, "electronic_differential", "left 0.30, right 0.30")


async def test_where_no_gate_is_the_wheels_stand_and_their_node_says_why(
    tmp_path: Path, ros_domain: int, person: Peer
) -> None:
    wheels = person.hear("/wheel_commands", JointState)
    changes = {"safety_stop": {"run": "./safety_stop.py"}}
    async with lesson(tmp_path, ros_domain, "09-brain", changes) as client:
        await until_state(client, "electronic_differential", READY)
        person.say("/ai_command", String(data="вперед"))
        assert "gate: true" in await said(
            client, "electronic_differential", "Nobody publishes /drive_safe"
        )
        assert wheels
        assert not turns(wheels)


async def test_without_a_gate_the_wheels_turn_where_the_profile_asks_for_it(
    tmp_path: Path, ros_domain: int, person: Peer
) -> None:
    wheels = person.hear("/wheel_commands", JointState)
    changes = {
        "safety_stop": {"run": "./safety_stop.py"},
        "electronic_differential": {"params": {"drive_topic": "/drive", "max_age_s": 0.0}},
    }
    async with lesson(tmp_path, ros_domain, "09-brain", changes) as client:
        await until_state(client, "electronic_differential", READY)
        await until_state(client, "ai_driver", READY)
        with person.saying("/ai_command", String(data="вперед"), 1.0):
            await until(lambda: turns(wheels), "wheels that turn", 30)
