"""The brain with a model: a real server's answer goes to the wheels, a broken one stops them."""

from __future__ import annotations

import json
import threading
from typing import TYPE_CHECKING, Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from std_msgs.msg import Bool, ByteMultiArray, Float32, String

from tests.model_server import KEY, ModelServer, hangs_up, obeys
from tests.model_settings import write_settings
from tests.ros.node_process import NodeProcess
from tests.ros.nodes.test_brain import text, voice
from tests.ros.peer import LATCHED, Peer
from tests.waiting import comes, wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.model_server import Exchange, Script

pytestmark = pytest.mark.nightly

DRIVE = {"action": "drive", "speed": 0.3, "steering": 0.1}


def answer(*commands: object, say: str = "I go.") -> str:
    return json.dumps({"thought": "clear", "commands": commands, "say": say})


GO = answer(DRIVE)


class Robot:
    """Brain and parser as processes of their own, the model as a server of the test."""

    def __init__(self, domain: int, server: ModelServer, **params: object) -> None:
        self.server = server
        given: dict[str, object] = {"backend": "llm", "stale_after_s": 60.0, **params}
        self.brain = NodeProcess("nodes.ai_brain", domain, params=given)
        self.parser = NodeProcess("nodes.llm_parser", domain, params={"repeat_for_s": 0.5})
        self.peer = Peer(domain)
        self.drives = self.peer.hear("/drive", AckermannDriveStamped)
        self.words = self.peer.hear("/ai_command", String)
        self.spoken = self.peer.hear("/audio/speaker_raw", ByteMultiArray)
        self.states = self.peer.hear("/brain_state", DiagnosticArray)
        self.asked = 0
        script, self.server.script = server.script, obeys(answer(say="Here I am."))
        wait_until(lambda: self._answers("Here I am"), "an answer on every way")
        self.server.script = script
        self.forget()

    def close(self) -> None:
        self.peer.close()
        self.brain.close()
        self.parser.close()

    def forget(self) -> None:
        for heard in (self.drives, self.words, self.spoken, self.states):
            heard.clear()

    def hear(self, words: str) -> None:
        self.peer.say("/audio/mic_raw", voice(words.encode()))

    @property
    def state(self) -> dict[str, str]:
        """The values of the newest /brain_state, its level and words; empty before the first."""
        if not self.states:
            return {"fault": "", "level": "", "words": ""}
        status: DiagnosticStatus = self.states[-1].status[0]
        values = {value.key: value.value for value in status.values}
        return {**values, "level": str(status.level[0]), "words": status.message}

    def said(self, words: str) -> bool:
        return any(words in text(message) for message in self.spoken)

    def speeds(self) -> list[float]:
        return [round(float(message.drive.speed), 3) for message in self.drives]

    def _answers(self, reply: str) -> bool:
        self.forget()
        self.hear("are you there?")
        everything = (self.spoken, self.states)
        if not comes(lambda: all(everything) and self.said(reply), within_s=2.0):
            return False
        self.hear("stop")
        return comes(lambda: self.drives and self.words, within_s=1.0)


@pytest.fixture
def server() -> Iterator[ModelServer]:
    with ModelServer(obeys(GO)) as server:
        yield server


@pytest.fixture
def robot(ros_domain: int, model_folder: Path, server: ModelServer) -> Iterator[Robot]:
    prices = {"input_per_million": 1.0, "output_per_million": 2.0}
    write_settings(model_folder, server.url, prices=prices, timeout_s=3.0, first_token_s=1.0)
    robot = Robot(ros_domain, server)
    yield robot
    said = robot.brain.output + robot.parser.output
    robot.close()
    assert KEY not in said
    assert "Traceback" not in said


def test_what_was_heard_becomes_motion_and_words(robot: Robot) -> None:
    """The model is told the distance and the words; its drive ends by itself, its reply is said."""
    robot.peer.say("/sensor/sonar_front", Float32(data=2.5))
    wait_until(
        lambda: _asks(robot, "go on") and "Distance ahead: 2.50 m" in _content(robot), "the distance in the question"
    )
    wait_until(lambda: 0.3 in robot.speeds(), "/drive by the model")
    wait_until(lambda: robot.speeds()[-1:] == [0.0], "the stop after the repetitions")
    wait_until(lambda: robot.said("I go."), "the reply")
    wait_until(lambda: robot.state.get("cost"), "what it took")
    state = robot.state
    assert (state["backend"], state["model"], state["fault"]) == ("llm", "m-1", "")
    assert (state["input_tokens"], state["output_tokens"]) == ("120", "40")
    assert float(state["cost"]) == pytest.approx(0.0002)
    assert 0 < float(state["first_token_s"]) <= float(state["total_s"])
    robot.brain.wait_for_words('The model thinks: "clear" (1 commands)', "m-1: 120 + 40 tokens")


def breaks(exchange: Exchange) -> None:
    exchange.begins()
    exchange.piece({"content": GO[:40]})
    raise OSError


def endless(exchange: Exchange) -> None:
    exchange.begins()
    for _ in range(10 * (1 << 20) // 4096):
        exchange.piece({"content": "x" * 4096})


@pytest.mark.parametrize(
    ("script", "fault", "words"),
    [
        (breaks, "cut", "in the middle of the answer"),
        (hangs_up, "cut", "closed the connection without an answer"),
        (lambda exchange: exchange.fails(401, KEY), "key", "does not take the key"),
        (lambda exchange: exchange.fails(404), "model", "does not know the model m-1"),
        (lambda exchange: exchange.fails(429, Retry_After="1"), "busy", "too many requests"),
        (lambda exchange: exchange.fails(500), "server", "failed (500)"),
        (lambda exchange: exchange.says(""), "empty", "is empty"),
        (endless, "too long", "has no end"),
        (lambda exchange: exchange.fails(200, "<html>", "text/html"), "not an API", "not the address"),
        (obeys(answer({**DRIVE, "speed": 9})), "shape", "nor is the second"),
        (obeys(answer({**DRIVE, "action": "fly"})), "shape", "nor is the second"),
        (obeys(GO[:-20]), "shape", "nor is the second"),
    ],
)
def test_whatever_a_server_does_wrong_the_robot_stands(robot: Robot, script: Script, fault: str, words: str) -> None:
    """Each has its own words, on the log and on /brain_state, and no wheel moves."""
    robot.server.script = script
    wait_until(lambda: _fails(robot), "the failure")
    assert robot.state["fault"] == fault
    assert words in robot.state["words"]
    robot.brain.wait_for_words("No answer: ", words)
    wait_until(lambda: robot.said("I cannot think just now"), "the reply")
    wait_until(robot.speeds, "the stop")
    assert set(robot.speeds()) == {0.0}


@pytest.mark.parametrize("said", ["stop", "Стоп, машина!", "emergency stop", "stop of another"])
def test_a_stop_does_not_wait_for_the_model(robot: Robot, said: str) -> None:
    """Neither the word nor the emergency stop; what the model answers afterwards is not done."""
    stopped = threading.Event()

    def slow(exchange: Exchange) -> None:
        exchange.begins()
        exchange.piece({"content": GO[:9]})
        stopped.wait(20)
        exchange.piece({"content": GO[9:]})
        exchange.ends()

    robot.server.script = slow
    robot.forget()
    wait_until(lambda: _asks(robot, "go on"), "the question")
    by_topic = "stop of another", "emergency stop"
    if said == "emergency stop":
        robot.peer.say("/emergency_stop", Bool(data=True))
    elif said == "stop of another":
        # Heard by a node that obeys, and not by this one.
        values = [KeyValue(key="engaged", value="true"), KeyValue(key="stops", value="7.1")]
        status = DiagnosticStatus(name="/safety_stop", values=values)
        robot.peer.say("/emergency_stop_state", DiagnosticArray(status=[status]), qos=LATCHED)
    else:
        robot.hear(said)
        wait_until(robot.speeds, "the stop on /drive")
    wait_until(lambda: "waits for a voice" in robot.state["words"], "no more thinking")
    stopped.set()
    robot.server.script = obeys(answer(say="Another one."))
    if said not in by_topic:
        wait_until(lambda: _asks(robot, "and now?") and robot.said("Another one"), "the next answer")
    assert not any(robot.speeds())


def _content(robot: Robot) -> Any:
    """What the newest question says of the situation."""
    return robot.server.exchanges[-1].request["messages"][-1]["content"]


def _asks(robot: Robot, words: str) -> bool:
    """Say something; whether the server is asked about it."""
    before = len(robot.server.exchanges)
    robot.hear(words)
    return comes(lambda: any(words in str(each.request) for each in robot.server.exchanges[before:]), 2.0)


def _fails(robot: Robot) -> bool:
    """Say something; whether that ends in a fault."""
    robot.forget()
    robot.hear("go on")
    return comes(lambda: robot.states and robot.state["fault"], within_s=4.0)
