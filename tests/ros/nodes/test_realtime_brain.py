"""The brain that hears and speaks itself, with a real WebSocket server in place of OpenAI's."""

from __future__ import annotations

import base64
import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from diagnostic_msgs.msg import DiagnosticArray
from std_msgs.msg import Bool, ByteMultiArray, Float32, String

from brain.realtime import ACT, SENSE
from robot.sound import samples_of
from tests.model_server import KEY
from tests.model_settings import write_settings
from tests.realtime_server import RealtimeServer, Talk
from tests.ros.node_process import NodeProcess
from tests.ros.nodes.test_brain import voice
from tests.ros.peer import Peer
from tests.waiting import comes, wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pytestmark = pytest.mark.nightly

DRIVE = {"action": "drive", "speed": 0.3, "steering": 0.0}
GO = json.dumps({"thought": "go", "commands": [DRIVE]})
TONE = (8000 * np.sin(np.arange(2400) * 2 * np.pi / 60)).astype("<i2").tobytes()
"""A tenth of a second, 400 Hz, at the rate of the protocol."""


async def quiet(_: Talk) -> None:
    """Say nothing."""


class Robot:
    """Brain and parser as processes of their own; the test is microphone, wheels and server."""

    def __init__(self, domain: int, server: RealtimeServer) -> None:
        self.server = server
        self.peer = Peer(domain)
        self.drives = self.peer.hear("/drive", AckermannDriveStamped)
        self.sound = self.peer.hear("/audio/speaker_raw", ByteMultiArray)
        self.sent = self.peer.hear("/llm_raw_json", String)
        self.states = self.peer.hear("/brain_state", DiagnosticArray)
        self.brain = NodeProcess("nodes.realtime_brain", domain)
        self.parser = NodeProcess("nodes.llm_parser", domain, params={"repeat_for_s": 0.5})
        wait_until(lambda: self.server.talks and self.states, "a talk")
        wait_until(self._reached, "everybody to know each other")
        for heard in (self.drives, self.sound, self.sent):
            heard.clear()

    @property
    def talk(self) -> Talk:
        return self.server.talks[-1]

    def close(self) -> None:
        self.peer.close()
        self.brain.close()
        self.parser.close()

    def speeds(self) -> list[float]:
        return [round(float(message.drive.speed), 3) for message in self.drives]

    def step(self, step: Any) -> Any:
        return self.server.run(step)

    def senses(self, front_m: float) -> str:
        """Have the sonar say a distance; return what the model is told when it asks."""
        self.peer.say("/sensor/sonar_front", Float32(data=front_m))
        before = len(self.talk.those("conversation.item.create"))
        self.step(self.talk.calls(SENSE, "{}", f"sense-{before}"))
        answers = self.step(self.talk.got("conversation.item.create", before + 1))
        return str(answers[-1]["item"]["output"])

    def _reached(self) -> bool:
        """Whether a stop said into the microphone comes out on /drive."""
        self.peer.say("/audio/mic_raw", voice(b"stop"))
        return comes(lambda: self.drives and self.sent, within_s=1.0)


@pytest.fixture
def robot(ros_domain: int, model_folder: Path) -> Iterator[Robot]:
    with RealtimeServer(quiet) as server:
        write_settings(model_folder, server.url, realtime_model="rt-1")
        robot = Robot(ros_domain, server)
        try:
            yield robot
            said = robot.brain.output
        finally:
            robot.close()
        assert KEY not in said
        assert "Traceback" not in said


def test_sound_goes_up_and_a_voice_comes_down(robot: Robot) -> None:
    """16 kHz on the robot, 24 kHz on the line; what the model does goes through the parser."""
    robot.peer.say("/audio/mic_raw", voice(bytes(range(1, 255)) * 12 + b"\x00\x80" * 76))
    (appended,) = robot.step(robot.talk.got("input_audio_buffer.append"))
    assert len(base64.b64decode(appended["audio"])) == pytest.approx(3200 * 1.5, abs=8)
    robot.step(robot.talk.hears("go on"))
    wait_until(lambda: "Distance ahead: 2.00 m" in robot.senses(2.0), "the distance")
    robot.step(robot.talk.calls(ACT, GO, "go"))
    wait_until(lambda: 0.3 in robot.speeds(), "/drive by the model")
    robot.step(robot.talk.says(TONE, TONE, words="I go."))
    wait_until(lambda: sum(len(m.data) for m in robot.sound) >= 6300, "the model's voice")
    played = samples_of(b"".join(b"".join(message.data) for message in robot.sound))
    peaks = np.abs(np.fft.rfft(played.astype(float)))
    assert np.argmax(peaks) * 16_000 / len(played) == pytest.approx(400, abs=10)
    robot.brain.wait_for_words('Heard: "go on"', 'Says: "I go."', "all of it")
    values = {each.key: each.value for each in robot.states[-1].status[0].values}
    assert values["model"] == "rt-1"


def test_whoever_speaks_interrupts_and_a_stop_stops(robot: Robot) -> None:
    """Ten seconds of talk are broken off; after a stop the model can do nothing."""
    robot.step(robot.talk.hears("tell me a story"))
    robot.step(robot.talk.says(*[TONE] * 100))
    wait_until(lambda: robot.sound, "the story")
    robot.step(robot.talk.hears("stop"))
    wait_until(lambda: robot.speeds() == [0.0], "the robot to stand")
    robot.step(robot.talk.got("response.cancel"))
    robot.step(robot.talk.calls(ACT, GO, "call-1"))
    outcome = robot.step(robot.talk.got("conversation.item.create"))[-1]["item"]["output"]
    assert outcome.startswith("not done")
    robot.peer.say("/emergency_stop", Bool(data=True))
    robot.step(robot.talk.got("response.cancel", 2))
    assert not any(robot.speeds())
    assert sum(len(message.data) for message in robot.sound) < 5 * 32_000


def test_a_lost_talk_is_told_and_made_anew(robot: Robot) -> None:
    """The robot stands; a moment later it listens again."""
    robot.step(robot.talk.hang_up())
    robot.brain.wait_for_words("No talk: the connection of the talk was lost; I stand")
    wait_until(lambda: len(robot.server.talks) == 2, "another talk")
    wait_until(lambda: robot.speeds()[-1:] == [0.0], "the order to stand")
    robot.step(robot.talk.hears("go on"))
    robot.step(robot.talk.calls(ACT, GO, "call-1"))
    wait_until(lambda: 0.3 in robot.speeds(), "/drive by the model")


def test_without_settings_it_says_so_and_ends(ros_domain: int, model_folder: Path) -> None:
    del model_folder
    brain = NodeProcess("nodes.realtime_brain", ros_domain)
    try:
        assert brain.wait() == 2
        assert "No talk is possible: no language model is set up" in brain.output
    finally:
        brain.close()
