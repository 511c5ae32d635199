"""The LLM's JSON: carried out in order when it is right, and not at all when it is not."""

from __future__ import annotations

import json
from itertools import count
from typing import TYPE_CHECKING, Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from example_interfaces.srv import AddTwoInts
from std_msgs.msg import String

from tests.ros.node_thread import NodeThread
from tests.ros.peer import Peer
from tests.waiting import comes, wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

DRIVE = {"action": "drive", "speed": 0.2, "steering": -0.3}
HEAD = {"action": "turn_head", "pan": -45, "tilt": 10}


class Parser:
    """The parser; the test plays the LLM, the chassis and the head."""

    def __init__(self, domain: int, *, lang: str, params: dict[str, object], head: bool) -> None:
        self.peer = Peer(domain)
        self.asked: list[tuple[int, int]] = []
        self.sum = 1
        if head:
            self.peer.node.create_service(AddTwoInts, "set_head_position", self._turn)
        self.drives = self.peer.hear("/drive", AckermannDriveStamped)
        self._results = self.peer.hear("/llm_result", String)
        self.process = NodeThread("nodes.llm_parser", domain, lang=lang, params=params)
        self._tries = count(1)
        self._head = head
        wait_until(self._answers, "an answer on every way")
        for heard in (self.drives, self._results, self.asked):
            heard.clear()

    def close(self) -> None:
        self.peer.close()
        self.process.close()

    def send(self, *commands: object, thought: str = "why") -> None:
        self.send_text(json.dumps({"thought": thought, "commands": commands}))

    def send_text(self, text: str) -> None:
        self.peer.say("/llm_raw_json", String(data=text))

    def results(self, count: int) -> list[dict[str, Any]]:
        wait_until(lambda: len(self._results) >= count, f"{count} results")
        return [json.loads(result.data) for result in self._results]

    def _answers(self) -> bool:
        """Send a response of its own number; whether all that it brings forth has come.

        The graph tells that its publishers are known here, not that it knows who listens here,
        and what it says before is lost.
        """
        number = next(self._tries)
        speed = number / 1000
        head = [{**HEAD, "pan": number}] if self._head else []
        self.send({**DRIVE, "speed": speed}, *head, thought="a try")

        def came() -> bool:
            told = [json.loads(result.data) for result in self._results]
            drove = any(one["event"] == "drive" and one["speed"] == speed for one in told)
            turned = any(one["event"] == "head" and one["pan"] == number for one in told)
            heard = any(abs(one.drive.speed - speed) < 1e-6 for one in self.drives)
            return drove and heard and turned == self._head

        return comes(came, within_s=1.0)

    def _turn(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        self.asked.append((request.a, request.b))
        response.sum = self.sum
        return response


@pytest.fixture
def parser(ros_domain: int, request: pytest.FixtureRequest) -> Iterator[Parser]:
    options = {"lang": "en", "params": {}, "head": True, **getattr(request, "param", {})}
    parser = Parser(ros_domain, **options)
    yield parser
    parser.close()


def test_the_course_s_example_turns_the_head_and_drives(parser: Parser) -> None:
    parser.send(HEAD, DRIVE, thought="Вижу тень справа.")
    results = parser.results(3)
    accepted = {"event": "accepted", "commands": 2, "thought": "Вижу тень справа."}
    assert results[0] == accepted
    assert {"event": "drive", "speed": 0.2, "steering": -0.3} in results
    assert {"event": "head", "pan": -45, "tilt": 10, "sum": 1} in results
    wait_until(lambda: parser.drives, "/drive")
    assert parser.drives[0].drive.speed == pytest.approx(0.2)
    assert parser.drives[0].drive.steering_angle == pytest.approx(-0.3)
    parser.process.wait_for_words('thinks: "Вижу тень справа."')


BAD_TEXTS = [
    json.dumps({"thought": "", "commands": [DRIVE, HEAD, {**DRIVE, "speed": 0.51}]}),
    json.dumps({"thought": "", "commands": [DRIVE, {"action": "fly"}]}),
    json.dumps({"thought": "", "commands": [DRIVE] * 33}),
    json.dumps({"thought": "", "commands": [DRIVE, {**DRIVE, "speed": float("nan")}]}),
    json.dumps({"thought": "x" * 70_000, "commands": [DRIVE]}),
    '{"thought": "", "commands": [',
    "[" * 50_000,
    "",
]


def test_one_bad_command_and_nothing_moves(parser: Parser) -> None:
    for number, text in enumerate(BAD_TEXTS, 1):
        parser.send_text(text)
        refused = parser.results(number)[-1]
        assert refused["event"] == "refused", text[:100]
        assert refused["problems"], text[:100]
        assert all({"field", "line", "column", "message"} <= set(p) for p in refused["problems"])
    parser.process.wait_for_words("[ERROR]", "Refused, nothing is done")
    # What comes through is the next response only.
    parser.send({**DRIVE, "speed": 0.05})
    wait_until(lambda: parser.drives, "/drive")
    assert [drive.drive.speed for drive in parser.drives] == [pytest.approx(0.05)]
    assert parser.asked == []


@pytest.mark.parametrize("parser", [{"head": False, "params": {"head_timeout": 3.0}}], indirect=True)
def test_a_head_that_never_answers_is_given_up_and_newer_commands_win(parser: Parser, ros_domain: int) -> None:
    with NodeThread("nodes.head_controller", ros_domain, params={"move_time": 30.0}) as slow:
        slow.wait_for_words("ready for set_head_position")
        parser.send(HEAD, {**HEAD, "pan": 5})
        slow.wait_for_words("pan -45")
        parser.send({**HEAD, "pan": 7})
        heads = [result for result in parser.results(5) if result["event"] == "head"]
    assert [head["pan"] for head in heads] == [5, -45, 7]
    assert "dropped for newer commands" in heads[0]["error"]
    assert "no answer from set_head_position for 3 s" in heads[1]["error"]
