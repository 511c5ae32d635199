"""Hearing and speaking, offline: from spoken words to the wheels, and an answer that is spoken."""

from __future__ import annotations

import signal
from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import ByteMultiArray, Float32, String

from brain.speech.espeak import EspeakVoice
from brain.speech.server import wav_of
from brain.speech.sound import Sound
from nodes.parts.sound import from_message, to_message
from robot.sound import RATE_HZ, level_dbfs, text_in
from tests.ros.node_process import NodeProcess
from tests.waiting import wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.peer import Peer

pytestmark = pytest.mark.nightly

BLOCK = RATE_HZ // 10 * 2
ROOM = bytes(2 * RATE_HZ)
"""A second without a word."""


def spoken(words: str) -> bytes:
    return EspeakVoice().speak(words, "en").at(RATE_HZ).pcm


def speech_in(messages: list[ByteMultiArray]) -> bytes:
    """What of it is sound, not text."""
    return b"".join(sound for sound in map(from_message, messages) if text_in(sound) is None)


def test_a_spoken_file_drives_the_wheels_and_is_answered_aloud(
    peer: Peer, ros_domain: int, tmp_path: Path
) -> None:
    file = tmp_path / "said.wav"
    file.write_bytes(wav_of(EspeakVoice().speak("robot forward", "en")))
    heard = peer.hear("/audio/heard", String)
    drive = peer.hear("/drive", AckermannDriveStamped)
    wheels = peer.hear("/wheel_commands", JointState)
    answers = peer.hear("/say", String)
    played = peer.hear("/audio/speaker_raw", ByteMultiArray)
    gate: dict[str, object] = {
        "gate": True,
        "max_age_s": 0.0,
        "slow_distance": 0.0,
        "settle_s": 0.0,
    }
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


def test_it_hears_commands_only(peer: Peer, ros_domain: int, tmp_path: Path) -> None:
    file = tmp_path / "said.wav"
    chat = spoken("what is the weather like tomorrow")
    file.write_bytes(wav_of(Sound(chat + ROOM + spoken("robot turn left"), RATE_HZ)))
    heard = peer.hear("/audio/heard", String)
    with (
        NodeProcess("nodes.hearing", ros_domain) as node,
        NodeProcess("nodes.mock_audio", ros_domain, params={"sound_file": str(file)}),
        # Text in place of sound is somebody else's.
        peer.saying("/audio/mic_raw", to_message(b"robot forward")),
    ):
        node.wait_for_words("Listening on /audio/mic_raw, recognising by sphinx")
        wait_until(lambda: heard, "a command")
        node.wait_for_words("but no words in it")
        node.send(signal.SIGTERM)
        assert node.wait() == 0
        assert "Traceback" not in node.output
    assert {message.data for message in heard} == {"robot turn left"}


def test_it_does_not_hear_while_the_robot_speaks(
    peer: Peer, ros_domain: int, tmp_path: Path
) -> None:
    file = tmp_path / "said.wav"
    file.write_bytes(wav_of(EspeakVoice().speak("robot turn right", "en")))
    heard = peer.hear("/audio/heard", String)
    said = {"sound_file": str(file), "period": 3.0}
    with (
        NodeProcess("nodes.hearing", ros_domain),
        NodeProcess("nodes.mock_audio", ros_domain, params=said) as somebody,
    ):
        with peer.saying("/audio/speaker_raw", to_message(b"\0\x10" * (BLOCK // 2)), 0.1):
            wait_until(lambda: somebody.output.count("Somebody speaks") == 2, "somebody")
            assert heard == []
        wait_until(lambda: heard, "a command after that", within_s=50)
        assert heard[0].data == "robot turn right"


def test_words_are_spoken_in_their_language_and_silenced(peer: Peer, ros_domain: int) -> None:
    played = peer.hear("/audio/speaker_raw", ByteMultiArray)
    with NodeProcess("nodes.speaking", ros_domain) as node:
        node.wait_for_words("Speaking what comes on /say, by espeak")
        peer.say("/say", String(data="Вижу стену, стою."))
        node.wait_for_words('Saying: "Вижу стену, стою."')
        wait_until(lambda: len(played) > 3 and level_dbfs(speech_in(played)) > -40.0, "a voice")
        assert {len(message.data) for message in played[:-1]} == {BLOCK}
        for number in range(6):
            peer.say("/say", String(data=f"sentence {number} " + "one two three four five " * 40))
        node.wait_for_words('Too much to say, left out: "sentence')
        peer.say("/say", String())
        node.wait_for_words("Silenced")
        peer.say("/say", String(data="quiet now"))
        node.wait_for_words('Saying: "quiet now"')
        node.send(signal.SIGINT)
        assert node.wait() == 0
        assert "Traceback" not in node.output


@pytest.mark.parametrize(
    ("module", "params", "words"),
    [
        ("hearing", {"language": "ru"}, "pocketsphinx knows only English: take backend:=vosk"),
        ("hearing", {"backend": "vosk"}, "vosk is not installed: pip install vosk"),
        ("hearing", {"backend": "sherpa"}, "sherpa-onnx is not installed: pip install sherpa-onnx"),
        ("hearing", {"backend": "server"}, "no language model is set up"),
        ("speaking", {"backend": "piper"}, "piper-tts is not installed: pip install piper-tts"),
        ("speaking", {"backend": "server"}, "no language model is set up"),
        ("mock_audio", {"sound_file": "/nowhere.wav"}, "/nowhere.wav: cannot be read"),
        ("mock_audio", {"sound_file": __file__}, "test_voice.py: is not a sound file"),
    ],
)
def test_what_is_missing_is_told_with_the_mend(
    ros_domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    module: str, params: dict[str, object], words: str,
) -> None:  # fmt: skip
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    with NodeProcess(f"nodes.{module}", ros_domain, params=params) as node:
        assert node.wait() == 2
        node.wait_for_words(words)
        assert "Traceback" not in node.output


@pytest.mark.parametrize(
    ("module", "package"), [("hearing", "pocketsphinx"), ("speaking", "espeakng_loader")]
)
def test_a_missing_extra_is_named(
    ros_domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, module: str, package: str
) -> None:
    (tmp_path / f"{package}.py").write_text("raise ImportError('not here')")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    with NodeProcess(f"nodes.{module}", ros_domain, cold=True) as node:
        assert node.wait() == 2
        node.wait_for_words("is not installed: pip install 'deck-robot[voice]'")
