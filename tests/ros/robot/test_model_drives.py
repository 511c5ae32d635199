"""The robot of real drivers with a hostile model as its driver: the gate and the limits hold.

The model answers every voice with full speed, for ever, and what it is not allowed besides.
"""

from __future__ import annotations

import contextlib
import json
import random
from collections import Counter
from itertools import count
from typing import TYPE_CHECKING, Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from rclpy.time import Time
from std_msgs.msg import Bool, String

from robot.commands.schema import CommandError, SpokenResponse, parse_llm
from robot.limits import SPEED, STEERING
from tests.deck_process import deck
from tests.model_server import KEY, ModelServer, obeys
from tests.model_settings import write_settings
from tests.ros.node_process import NodeProcess
from tests.ros.nodes.test_brain import voice
from tests.ros.peer import Peer
from tests.waiting import comes, wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.model_server import Exchange

pytestmark = pytest.mark.nightly

FUZZED = 10_000
THROUGH_THE_NODES = 150
DRIVE_S = 150.0
"""The gate lets it go on by fits and starts where messages are late."""
HOSTILE: tuple[Any, ...] = (
    *(0.5, -0.5, 0.50001, 5, -1e308, 1e400, True, None, "0.5", [], {}, [0.5], ""),
    *("NaN", "вперёд", 0.1 + 0.2, 10**400),
)


def stamp_ns(message: AckermannDriveStamped | DiagnosticArray) -> int:
    return int(Time.from_msg(message.header.stamp).nanoseconds)


def drive(speed: float) -> str:
    command = {"action": "drive", "speed": speed, "steering": 0.0}
    return json.dumps({"thought": "faster!", "commands": [command] * 8, "say": ""})


def fuzzed(chance: random.Random) -> str:
    """Return an answer that is often right, and often wrong in one way or another."""
    commands = []
    for _ in range(chance.randrange(4)):
        action = chance.choice(("drive", "drive", "turn_head", "fly", 7))
        fields = ("speed", "steering") if action == "drive" else ("pan", "tilt")
        command: dict[str, Any] = {"action": action}
        for name in fields:
            good = chance.randint(-45, 45) / (100 if action == "drive" else 1)
            command[name] = good if chance.random() < 0.8 else chance.choice(HOSTILE)
        if chance.random() < 0.1:
            command["speed_limit"] = "off"
        commands.append(command)
    text = json.dumps({"thought": "t", "commands": commands, "say": "s"})
    if chance.random() < 0.3:
        at = chance.randrange(len(text))
        text = text[:at] + chance.choice('{}[]",:0\x00é ') + text[at + chance.randrange(3) :]
    return text


def test_no_fuzzed_answer_is_out_of_range() -> None:
    """Ten thousand: whatever is accepted is within the limits, every number of it."""
    chance, accepted = random.Random(14), 0
    for _ in range(FUZZED):
        try:
            response = parse_llm(fuzzed(chance), SpokenResponse)
        except CommandError:
            continue
        accepted += 1
        for command in response.commands:
            if command.action == "drive":
                assert command.speed in SPEED
                assert command.steering in STEERING
            else:
                assert -90 <= command.pan <= 90
                assert -90 <= command.tilt <= 90
    assert 0.2 * FUZZED < accepted < 0.8 * FUZZED, "both kinds are tried"


def test_what_a_model_says_is_done_once_or_not_at_all(ros_domain: int, model_folder: Path) -> None:
    """Through the real nodes: each accepted answer reaches the parser once, a bad one never."""
    chance, numbers = random.Random(41), count()
    good: list[str] = []

    def script(exchange: Exchange) -> None:
        if "deck-" in json.dumps(exchange.request["response_format"]):
            obeys("")(exchange)
            return
        text = fuzzed(chance).replace('"t"', f'"number {next(numbers)}"', 1)
        with contextlib.suppress(CommandError):
            good.append(parse_llm(text, SpokenResponse).thought)
        exchange.says(text)

    with ModelServer(script) as server, Peer(ros_domain) as peer:
        write_settings(model_folder, server.url, budget={"calls_per_minute": 10_000})
        sent = peer.hear("/llm_raw_json", String)
        drives = peer.hear("/drive", AckermannDriveStamped)
        brain = NodeProcess("nodes.ai_brain", ros_domain, params={"backend": "llm"})
        parser = NodeProcess("nodes.llm_parser", ros_domain)
        try:
            wait_until(lambda: _answered(peer, sent), "the first answer")
            for number in range(-2, THROUGH_THE_NODES):
                if number == 0:
                    # What was said until somebody answered has been answered or dropped by now.
                    good.clear()
                    sent.clear()
                # Of every question something comes: what was accepted, or the order to stand.
                before = len(sent)
                peer.say("/audio/mic_raw", voice(b"go"))
                wait_until(lambda: len(sent) > before, "an outcome")  # noqa: B023
            thoughts = Counter(json.loads(message.data)["thought"] for message in sent)
        finally:
            brain.close()
            parser.close()
    del thoughts["no answer: stand"]
    assert set(thoughts) == set(good)
    assert set(thoughts.values()) == {1}
    assert drives
    assert all(SPEED.allow(message.drive.speed) for message in drives)


def _answered(peer: Peer, sent: list[String]) -> bool:
    """Ask, and leave it time to answer: a newer question takes the place of the one before."""
    peer.say("/audio/mic_raw", voice(b"go"))
    return comes(lambda: sent, within_s=5.0)


@pytest.fixture
def robot(ros_domain: int, model_folder: Path) -> Iterator[tuple[ModelServer, Peer]]:
    """Bring the robot up with a model, and a microphone that is never silent."""
    with ModelServer(obeys(drive(0.5))) as server:
        write_settings(model_folder, server.url, budget={"calls_per_minute": 10_000})
        up = deck(
            "up", "robot", "--set", "mock_audio.first_after=0.1", "--set", "mock_audio.period=0.3"
        )
        try:
            assert (up.process.returncode, up.errors) == (0, [])
            with Peer(ros_domain) as peer:
                yield server, peer
        finally:
            deck("down")


@pytest.mark.timeout(600)  # A drive of a half minute on a quiet machine.
def test_full_speed_for_ever_hits_nothing(robot: tuple[ModelServer, Peer]) -> None:
    """Forward until the gate holds it, then backward until it does: the robot touches nothing.

    Then the emergency stop, while the model goes on talking; and the key is nowhere to be read.
    """
    server, peer = robot
    poses = peer.hear("/mock/pose", PoseStamped)
    safe = peer.hear("/drive_safe", AckermannDriveStamped)

    def x_m() -> float:
        return float(poses[-1].pose.position.x) if poses else 0.0

    def stands(at_least: int = 25) -> bool:
        """Whether the newest commands that passed the gate are all zero."""
        return len(safe) >= at_least and not any(each.drive.speed for each in safe[-at_least:])

    wait_until(lambda: x_m() > 0.7, "some way forward", DRIVE_S)
    wait_until(stands, "the gate to hold it before the box", DRIVE_S)
    forward_m = x_m()
    asked = len(server.exchanges)
    server.script = obeys(drive(-0.5))
    safe.clear()
    wait_until(lambda: x_m() < forward_m - 0.5, "some way back", DRIVE_S)
    wait_until(lambda: len(server.exchanges) > asked + 5, "more answers")
    wait_until(stands, "the gate to hold it before the wall", DRIVE_S)
    server.script = obeys(drive(0.5))
    here_m = x_m()
    wait_until(lambda: x_m() > here_m + 0.1, "forward again", DRIVE_S)
    told = peer.hear("/emergency_stop_state", DiagnosticArray)
    peer.say("/emergency_stop", Bool(data=True))

    def gate_stopped_ns() -> int:
        """When the gate first said that it obeys the stop; it may stand for other reasons."""
        obeyed = (
            stamp_ns(each)
            for each in told
            for one in each.status
            if one.name == "/safety_stop" and one.level == DiagnosticStatus.ERROR
        )
        return min(obeyed, default=0)

    stopped_ns = wait_until(gate_stopped_ns, "the stop")
    asked = len(server.exchanges)

    def since() -> list[float]:
        """What passed the gate from then on; what was sent before may be heard later."""
        return [each.drive.speed for each in safe if stamp_ns(each) > stopped_ns]

    wait_until(lambda: len(server.exchanges) > asked + 5, "a model that goes on")
    wait_until(lambda: len(since()) > 20, "a gate that goes on")
    assert not any(since())
    assert all(SPEED.allow(each.drive.speed) for each in safe)
    logs = "\n".join(deck("logs").lines)
    assert "ran into something" not in logs
    assert KEY not in logs
