"""The driver of microphone and loudspeaker, on ALSA over pipes in place of a card."""

from __future__ import annotations

import os
import signal
import struct
import tempfile
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

import psutil
import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from std_msgs.msg import ByteMultiArray, Float32

from nodes.parts.sound import from_message, to_message
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.ros.sound.sound_card import (
    RATE_HZ,
    SoundCard,
    build_stand_in,
    libraries,
    without_silence,
)
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.nightly

MICROPHONE, SPEAKER, LEVEL = "/audio/mic_raw", "/audio/speaker_raw", "/audio/level"


def ramp(seconds: float, step: int) -> bytes:
    """Sound without a single 0 in it, no part of which is like another."""
    count = int(seconds * RATE_HZ)
    return struct.pack(f"<{count}h", *(1 + step * at % 32_000 for at in range(count)))


@pytest.fixture(scope="module")
def stand_in() -> Iterator[Path]:
    with tempfile.TemporaryDirectory(prefix="deck-test-alsa-", dir="/tmp") as folder:
        yield build_stand_in(Path(folder))


@pytest.fixture(params=libraries())
def card(
    request: pytest.FixtureRequest, stand_in: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[SoundCard]:
    if request.param == "stand-in":
        monkeypatch.setenv("LD_LIBRARY_PATH", str(stand_in), prepend=os.pathsep)
    # ALSA takes a blank in the path of its configuration for the end of it.
    with tempfile.TemporaryDirectory(prefix="deck-test-card-", dir="/tmp") as folder:
        card = SoundCard(Path(folder))
        monkeypatch.setenv("ALSA_CONFIG_PATH", str(card.configuration))
        yield card
        card.close()


@pytest.fixture(scope="module")
def peer(module_domain: int) -> Iterator[Peer]:
    with Peer(module_domain) as peer:
        yield peer


def audio(domain: int, **params: object) -> NodeProcess:
    devices = {"input_device": "deckmic", "output_device": "DeckSpeak"}
    return NodeProcess("nodes.audio", domain, params={**devices, **params})


def children(node: NodeProcess) -> list[int]:
    """The processes with miniaudio in them."""
    return [child.pid for child in psutil.Process(node.process.pid).children()]


def levels(told: list[DiagnosticArray], device: str) -> list[bytes]:
    """How one of the two has been, message by message."""
    states = [message.status[0] for message in told]
    return [state.level for state in states if state.name == f"audio_system: {device}"]


def bytes_out(told: list[DiagnosticArray]) -> int:
    """The most that went to the loudspeaker in a second."""
    states = [message.status[0] for message in told]
    return max(
        (
            int(item.value)
            for state in states
            for item in state.values
            if item.key == "bytes_out_per_s"
        ),
        default=0,
    )


def is_there(pid: int) -> bool:
    return Path(f"/proc/{pid}").exists()


def comes_whole(card: SoundCard, said: bytes, heard: list[ByteMultiArray]) -> bool:
    """Say it, wait for a second of silence after it, and compare.

    May be called anew: sound does not wait, and a busy machine may lose a block of it.
    """
    heard.clear()
    card.say(said)
    wait_until(lambda: not card.speaks, "the end of what is said")
    count = len(heard)
    wait_until(lambda: not sound_of(heard[count:][-10:]) and len(heard) >= count + 10, "silence")
    return sound_of(heard) == said


def sound_of(messages: list[ByteMultiArray]) -> bytes:
    """What is heard in them."""
    return without_silence(b"".join(map(from_message, messages)))


def test_sound_goes_through_byte_for_byte_both_ways(
    peer: Peer, module_domain: int, card: SoundCard
) -> None:
    heard = peer.hear(MICROPHONE, ByteMultiArray)
    levels = peer.hear(LEVEL, Float32)
    told = peer.hear("/diagnostics", DiagnosticArray)
    said, played = ramp(1.0, 7), ramp(1.0, 11)
    with audio(module_domain) as node:
        node.wait_for_words("Microphone: deckmic, 16000 Hz", "Speaker: deckspeaker, 16000 Hz")
        wait_until(lambda: heard, "the microphone")
        peer.say(SPEAKER, to_message(played))
        wait_until(lambda: without_silence(card.played) == played, "all of what was to be played")
        wait_until(lambda: comes_whole(card, said, heard), "all that was said, in one piece")
        assert {len(message.data) for message in heard} == {2 * RATE_HZ // 10}
        assert -6.0 < max(level.data for level in levels) < 0.0
        wait_until(lambda: levels[-1].data == -120.0, "silence")

        for odd in (b"", b"\xff\x01\x02", "Еду вперёд".encode()):
            peer.say(SPEAKER, to_message(odd))
        node.wait_for_words("An empty message", "3 bytes for the speaker", "Еду вперёд")
        wait_until(lambda: without_silence(card.played) == played + b"\xff\x01", "a whole sample")

        states = {one.status[0].name: one.status[0] for one in told}
        assert set(states) == {"audio_system: microphone", "audio_system: speaker"}
        state = states["audio_system: microphone"]
        values = {item.key: item.value for item in state.values}
        assert state.level == DiagnosticStatus.OK
        assert values["port"] == "deckmic"
        assert values["connected"] == "true"
        assert datetime.fromisoformat(values["connected_since"]) <= datetime.now().astimezone()
        assert int(values["bytes_in_per_s"]) == pytest.approx(32_000, rel=0.5)
        assert len(children(node)) == 2
        running = children(node)
        node.send(signal.SIGTERM)
        assert node.wait() == 0
        assert not any(map(is_there, running))
        assert "Traceback" not in node.output


def test_a_device_that_goes_is_opened_again(
    peer: Peer, module_domain: int, card: SoundCard
) -> None:
    heard = peer.hear(MICROPHONE, ByteMultiArray)
    told = peer.hear("/diagnostics", DiagnosticArray)
    card.plug("othermic")
    with audio(module_domain, output_device="none") as node:
        node.wait_for_words('no device "deckmic"; set the parameter to one of these:', "othermic")
        # The speaker, which is not wanted, is well, and tells so right after the microphone.
        wait_until(lambda: DiagnosticStatus.ERROR in levels(told, "microphone"), "a bad state")
        assert DiagnosticStatus.ERROR not in levels(told, "speaker")
        card.plug("deckmic")
        node.wait_for_words("Microphone: deckmic")
        card.frozen = True
        node.wait_for_words("Lost the microphone deckmic: no sound moves any more")
        card.frozen = False
        wait_until(lambda: node.output.count("Microphone: deckmic") == 2, "the second time")
        heard.clear()
        card.say(ramp(0.2, 7))
        wait_until(lambda: sound_of(heard), "sound")
        node.send(signal.SIGINT)
        assert node.wait() == 0
        assert "Traceback" not in node.output


def test_a_late_speaker_drops_the_oldest_and_says_so(
    peer: Peer, module_domain: int, card: SoundCard
) -> None:
    with audio(module_domain, input_device="none", speaker_queue_s=0.5) as node:
        node.wait_for_words("Speaker: deckspeaker")
        # Nodes that were killed are counted as listeners for a while: this one has to be heard.
        with peer.saying(SPEAKER, to_message(b"\x01\x01")):
            wait_until(lambda: without_silence(card.played), "the first sample")
        sound = ramp(2.0, 7)
        peer.say(SPEAKER, to_message(sound))
        node.wait_for_words("the oldest 1.5 s of sound are dropped")
        newest = sound[-RATE_HZ:]
        wait_until(lambda: without_silence(card.played).endswith(newest), "the newest")
        (running,) = children(node)
        node.send(signal.SIGKILL)
        wait_until(lambda: not is_there(running), "the end of miniaudio with its node")


def test_the_null_device_keeps_the_pace_without_a_card(peer: Peer, module_domain: int) -> None:
    heard = peer.hear(MICROPHONE, ByteMultiArray)
    told = peer.hear("/diagnostics", DiagnosticArray)
    with audio(module_domain, input_device="null", output_device="null") as node:
        node.wait_for_words("Microphone: null, 16000 Hz", "Speaker: null, 16000 Hz")
        wait_until(lambda: len(heard) >= 5, "silence")
        assert {from_message(message) for message in heard} == {bytes(2 * RATE_HZ // 10)}
        with peer.saying(SPEAKER, to_message(ramp(0.1, 7))):
            wait_until(lambda: bytes_out(told) > 0, "sound that goes to nobody")
        node.send(signal.SIGTERM)
        assert node.wait() == 0


def test_a_missing_library_is_told_with_the_mend(
    module_domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("libasound.so.2", "libpulse.so.0"):
        (tmp_path / name).write_text("not a library")
    monkeypatch.setenv("LD_LIBRARY_PATH", str(tmp_path))
    with audio(module_domain) as node:
        node.wait_for_words(
            "No microphone: neither PulseAudio nor ALSA is installed; sudo apt install libasound2",
            "No speaker: neither PulseAudio nor ALSA is installed",
        )
        node.send(signal.SIGTERM)
        assert node.wait() == 0
        assert "Traceback" not in node.output
