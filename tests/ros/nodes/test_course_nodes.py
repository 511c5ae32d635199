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
async def lesson(folder: Path, domain: int, name: str, changes: dict[str, Any]) -> AsyncIterator[SupervisorClient]:
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
    return any(abs(message.velocity[0]) > 0.1 for message in wheels)


BRAIN = {
    "sonar_front": "mock_sonar",
    "camera": "mock_camera",
    "head_controller": "head_controller",
    "ai_driver": "ai_driver",
    "audio": "mock_audio",
    "ai_brain": "ai_brain",
}


async def test_the_whole_robot_hears_answers_and_drives(tmp_path: Path, ros_domain: int, person: Peer) -> None:
    wheels = person.hear("/wheel_commands", JointState)
    answers = person.hear("/audio/speaker_raw", ByteMultiArray)
    changes = {node: {"run": f"./{file}.py"} for node, file in BRAIN.items()}
    async with lesson(tmp_path, ros_domain, "09-brain", changes) as client:
        for name in client.nodes:
            await until_state(client, name, RUNNING, READY)
        phrase = ByteMultiArray(data=[bytes([byte]) for byte in b"VOICE_COMMAND: look around"])
        with person.saying("/audio/mic_raw", phrase, 1.0):
            await until(lambda: answers, "an answer", 30)
            await until(lambda: turns(wheels), "wheels that turn", 60)


async def test_a_json_drives_and_turns_the_head(tmp_path: Path, ros_domain: int, person: Peer) -> None:
    wheels = person.hear("/wheel_commands", JointState)
    changes = {name: {"run": f"./{name}.py"} for name in ("head_controller", "llm_parser")}
    async with lesson(tmp_path, ros_domain, "10-llm-json", changes) as client:
        for name in list(client.nodes):
            await until_state(client, name, READY)
        assert person.ask("set_head_position", AddTwoInts, AddTwoInts.Request(a=5, b=5)).sum == 1
        drive = {"action": "drive", "speed": 0.3, "steering": 0.1}
        turn = {"action": "turn_head", "pan": 30, "tilt": 0}
        answer = {"thought": "Off we go.", "commands": [drive, turn]}
        with person.saying("/llm_raw_json", String(data=json.dumps(answer)), 1.0):
            await until(lambda: turns(wheels), "wheels that turn", 30)
        await said(client, "head_controller", "turning to 30")


@pytest.mark.parametrize(
    ("name", "node", "file", "words"),
    [
        ("07-vision", "vlm_agent", "vlm_agent_stub", "a picture of 640x480"),
        ("02-sonar-safety", "safety_stop", "safety_stop", "far: "),
        ("01-hello", "hello", "hello", "second 2"),
    ],
)
async def test_it_does_its_part_in_a_lesson(
    tmp_path: Path, ros_domain: int, name: str, node: str, file: str, words: str
) -> None:
    changes = {node: {"run": f"./{file}.py"}}
    async with lesson(tmp_path, ros_domain, name, changes) as client:
        await said(client, node, words)
