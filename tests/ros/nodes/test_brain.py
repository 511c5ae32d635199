"""Lesson 9 from end to end: a voice is heard, and head, wheels and loudspeaker follow."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import ByteMultiArray, Float32, String

from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import comes, wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.nightly


AHEAD = {
    "nan": "with the voice, no picture and no valid distance straight ahead",
    "inf": "nothing in range ahead",
    "-inf": "something too close to measure ahead",
}


def voice(sound: bytes) -> ByteMultiArray:
    return ByteMultiArray(data=[bytes((byte,)) for byte in sound])


def text(message: ByteMultiArray) -> str:
    return b"".join(message.data).decode()


def wait_for(heard: list[Any], what: str) -> Any:
    return wait_until(lambda: heard and heard[0], what)


class Brain:
    """The brain in a process of its own; the test is everything around it."""

    def __init__(self, domain: int, lang: str = "en") -> None:
        self.process = NodeProcess(
            "nodes.ai_brain", domain, lang=lang, params={"stale_after_s": 60.0}
        )
        self.peer = Peer(domain)
        self.commands = self.peer.hear("/ai_command", String)
        self.spoken = self.peer.hear("/audio/speaker_raw", ByteMultiArray)
        wait_until(self._answers, "an answer")

    def close(self) -> None:
        self.peer.close()
        self.process.close()

    def see(self, distance: float) -> None:
        """Let it know the distance for sure: it tells it with its next thought."""
        self.peer.say("/sensor/sonar_front", Float32(data=distance))
        shown = AHEAD.get(str(distance), f"{distance:.2f} m ahead")
        wait_until(lambda: self._answers() and shown in self.process.output, shown)

    def _answers(self) -> bool:
        """Say a word, one at a time: more might not wait; whether it knows yet who listens."""
        self.commands.clear()
        self.spoken.clear()
        before = self.process.output.count("Decision: ")
        self.peer.say("/audio/mic_raw", voice(b"stop"))
        wait_until(lambda: self.process.output.count("Decision: ") > before, "a decision")
        return comes(lambda: self.commands and self.spoken, within_s=1.0)

    def hear(self, sound: bytes) -> tuple[str, str]:
        """Say something to it; the word for the driver and the reply come back."""
        self.commands.clear()
        self.spoken.clear()
        self.peer.say("/audio/mic_raw", voice(sound))
        reply = text(wait_for(self.spoken, "a reply"))
        return wait_for(self.commands, "/ai_command").data, reply


@pytest.fixture
def brain(ros_domain: int) -> Iterator[Brain]:
    brain = Brain(ros_domain)
    yield brain
    brain.close()


def test_a_voice_sets_the_whole_robot_in_motion(ros_domain: int) -> None:
    """Eight real nodes, started as lesson 9 starts them."""
    nodes: list[tuple[str, str, dict[str, object]]] = [
        ("nodes.mock_sonar", "sonar_front", {"pattern": "constant", "value": 2.0, "rate": 10.0}),
        ("nodes.mock_camera", "camera", {}),
        ("nodes.mock_audio", "audio", {"first_after": 2.0, "period": 4.0}),
        ("nodes.head_controller", "", {}),
        ("nodes.ai_driver", "ai_driver", {}),
        ("nodes.safety_stop", "safety_stop", {"gate": True}),
        ("nodes.electronic_differential", "", {"drive_topic": "/drive_safe", "max_age_s": 1.0}),
        ("nodes.ai_brain", "", {}),
    ]
    started = [NodeProcess(module, ros_domain, name=name, params=p) for module, name, p in nodes]
    try:
        with Peer(ros_domain) as peer:
            mic = peer.hear("/audio/mic_raw", ByteMultiArray)
            heads = peer.hear("/head_state", JointState)
            commands = peer.hear("/ai_command", String)
            drives = peer.hear("/drive", AckermannDriveStamped)
            wheels = peer.hear("/wheel_commands", JointState)
            speaker = peer.hear("/audio/speaker_raw", ByteMultiArray)
            assert "VOICE_COMMAND" in text(wait_for(mic, "a voice"))
            wait_until(lambda: any(c.data == "вперед" for c in commands), "вперед")
            wait_until(lambda: any(d.drive.speed == 0.5 for d in drives), "/drive forward")
            wait_until(
                lambda: any(w.velocity[0] == pytest.approx(0.5 / 0.0325) for w in wheels),
                "turning wheels",
            )
            wait_until(
                lambda: heads and heads[-1].position[0] == pytest.approx(math.radians(45)),
                "the head at 45 degrees",
            )
            wait_until(lambda: any("drive on" in text(reply) for reply in speaker), "the reply")
            started[2].wait_for_words("The loudspeaker plays")
            started[-1].wait_for_words("with the voice, a picture and 2.00 m ahead", "has turned")
        for node in started:
            assert node.process.poll() is None, node.output
            assert "Traceback" not in node.output
    finally:
        for node in started:
            node.close()


def test_an_obstacle_or_a_broken_sonar_means_stop(brain: Brain) -> None:
    for distance in (0.99, 0.0, math.nan, -math.inf):
        brain.see(distance)
        command, reply = brain.hear(b"VOICE_COMMAND: go")
        assert command == "стоп", distance
        assert "I stand still" in reply


def test_without_a_sonar_it_does_not_drive(brain: Brain) -> None:
    command, reply = brain.hear(b"VOICE_COMMAND: go")
    assert command == "стоп"
    assert "cannot see" in reply


def test_with_a_free_way_and_no_head_it_drives_and_tells_what_is_missing(brain: Brain) -> None:
    brain.see(math.inf)
    command, reply = brain.hear(b"VOICE_COMMAND: go")
    assert command == "вперед"
    assert "drive on" in reply
    brain.process.wait_for_words("[WARN]", "set_head_position is not there")


def test_a_word_that_drives_is_obeyed_if_it_is_safe(brain: Brain) -> None:
    for distance, said, command in (
        (2.0, "left", "налево"),
        (2.1, "Вперёд!", "вперед"),
        (0.3, "forward", "стоп"),
        (0.4, "назад", "назад"),
        (2.2, "stop", "стоп"),
    ):
        brain.see(distance)
        assert brain.hear(said.encode())[0] == command, (distance, said)


def test_sound_that_is_no_words_is_no_wish(brain: Brain) -> None:
    brain.see(3.0)
    brain.commands.clear()
    for sound in (b"\xff\xfe\x00\x80", b"\xd0", bytes(3200), bytes(range(256)) * 40):
        brain.peer.say("/audio/mic_raw", voice(sound))
    brain.peer.say("/audio/mic_raw", voice(b"left"))
    assert wait_for(brain.commands, "/ai_command").data == "налево"
    assert len(brain.commands) == 1


def test_recognised_words_count_if_they_are_said_to_the_robot(brain: Brain) -> None:
    answers = brain.peer.hear("/say", String)
    brain.see(3.0)
    brain.commands.clear()
    answers.clear()
    for words in ("turn left", "look around", "the robot is on the table", ""):
        brain.peer.say("/audio/heard", String(data=words))
    brain.peer.say("/audio/heard", String(data="Robot, turn right!"))
    wait_until(lambda: answers, "an answer")
    assert [message.data for message in brain.commands] == ["направо"]
    assert [message.data for message in answers] == ["As you say."]
    assert 'Heard "turn left", which is not a command for me' in brain.process.output
    assert brain.process.process.poll() is None


def test_an_empty_message_is_heard_without_harm(brain: Brain) -> None:
    assert brain.hear(b"")[0] == "стоп"
