"""Lesson 9 from end to end: a voice is heard, and head, wheels and loudspeaker follow."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import ByteMultiArray, String

from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    pass


def voice(sound: bytes) -> ByteMultiArray:
    return ByteMultiArray(data=[bytes((byte,)) for byte in sound])


def text(message: ByteMultiArray) -> str:
    return b"".join(message.data).decode()


def wait_for(heard: list[Any], what: str) -> Any:
    return wait_until(lambda: heard and heard[0], what)


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
            wait_until(lambda: any(w.velocity[0] == pytest.approx(0.5 / 0.0325) for w in wheels), "turning wheels")
            wait_until(
                lambda: heads and heads[-1].position[0] == pytest.approx(math.radians(45)), "the head at 45 degrees"
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
