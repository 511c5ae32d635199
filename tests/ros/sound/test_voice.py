"""Hearing and speaking, offline: from spoken words to the wheels, and an answer that is spoken."""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import ByteMultiArray, Float32, String

from brain.speech.espeak import EspeakVoice
from nodes.parts.sound import sound_of
from robot.sound import RATE_HZ, level_dbfs, text_in
from tests.ros.node_process import NodeProcess
from tests.waiting import wait_until
from tests.wav import wav_of

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.peer import Peer

pytestmark = pytest.mark.nightly


def spoken(words: str) -> bytes:
    return EspeakVoice().speak(words, "en").at(RATE_HZ).pcm


def speech_in(messages: list[ByteMultiArray]) -> bytes:
    """What of it is sound, not text."""
    return b"".join(sound for sound in map(sound_of, messages) if text_in(sound) is None)


def test_a_spoken_file_drives_the_wheels_and_is_answered_aloud(peer: Peer, ros_domain: int, tmp_path: Path) -> None:
    file = tmp_path / "said.wav"
    file.write_bytes(wav_of(EspeakVoice().speak("robot forward", "en")))
    heard = peer.hear("/audio/heard", String)
    drive = peer.hear("/drive", AckermannDriveStamped)
    wheels = peer.hear("/wheel_commands", JointState)
    answers = peer.hear("/say", String)
    played = peer.hear("/audio/speaker_raw", ByteMultiArray)
    gate: dict[str, object] = {"gate": True, "max_age_s": 0.0, "slow_distance": 0.0, "settle_s": 0.0}
    differential: dict[str, object] = {"drive_topic": "/drive_safe", "max_age_s": 60.0}
    nodes: dict[str, dict[str, object]] = {
        "hearing": {},
        "speaking": {},
        "ai_brain": {"stale_after_s": 60.0},
        "ai_driver": {},
        "safety_stop": gate,
        "electronic_differential": differential,
        "mock_audio": {"sound_file": str(file), "period": 4.0},
    }
    with ExitStack() as stack:
        stack.enter_context(peer.saying("/sensor/sonar_front", Float32(data=float("inf"))))
        running = {
            name: stack.enter_context(NodeProcess(f"nodes.{name}", ros_domain, params=params))
            for name, params in nodes.items()
        }
        wait_until(lambda: heard, "words")
        assert {message.data for message in heard} == {"robot forward"}
        wait_until(lambda: any(one.drive.speed > 0 for one in drive), "a command")
        wait_until(lambda: any(min(one.velocity) > 0 for one in wheels), "turning wheels")
        wait_until(lambda: answers, "an answer")
        assert answers[0].data == "As you say."
        wait_until(lambda: level_dbfs(speech_in(played)) > -40.0, "a voice")
        running["hearing"].wait_for_words('Heard: "robot forward"')
        running["mock_audio"].wait_for_words("The loudspeaker plays sound", '"As you say."')
