"""A word or a response that is repeated for a gate: for how long, and what ends it."""

from __future__ import annotations

import itertools
import json
import signal
from typing import TYPE_CHECKING

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from std_msgs.msg import Bool, String

from tests.ros.node_process import NodeProcess
from tests.ros.peer import LATCHED, Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.nightly

LONG: dict[str, object] = {"repeat_for_s": 60.0}


@pytest.fixture
def peer(ros_domain: int) -> Iterator[Peer]:
    with Peer(ros_domain) as peer:
        yield peer


class Heard:
    """What is said on /drive."""

    def __init__(self, peer: Peer) -> None:
        self.drives: list[AckermannDriveStamped] = peer.hear("/drive", AckermannDriveStamped)

    @property
    def speeds(self) -> list[float]:
        return [round(message.drive.speed, 3) for message in self.drives]

    def again_and_again(self, speed: float) -> None:
        self.drives.clear()
        wait_until(lambda: self.speeds.count(speed) >= 5, f"{speed} m/s again and again")

    def stop(self) -> None:
        wait_until(lambda: self.speeds and self.speeds[-1] == 0.0, "a stop")
        assert self.speeds.count(0.0) == 1, "said once"


def test_a_word_lasts_so_long_and_ends_with_a_stop(peer: Peer, ros_domain: int) -> None:
    with NodeProcess("nodes.ai_driver", ros_domain, params={"repeat_for_s": 0.5}) as node:
        heard = Heard(peer)
        tries = itertools.count(1)

        def is_heard() -> bool:
            heard.drives.clear()
            peer.say("/ai_command", String(data="back"))
            number = next(tries)
            wait_until(lambda: node.output.count("repeated for 0.5 s: stop") == number, "an end")
            return bool(heard.drives)

        wait_until(is_heard, "a word on /drive")
        wait_until(lambda: heard.speeds[-1] == 0.0, "its stop")
        heard.drives.clear()
        peer.say("/ai_command", String(data="forward"))
        heard.stop()
        assert heard.speeds[0] == 0.5
        assert 2 <= heard.speeds.count(0.5) <= 7
        number = next(tries)
        wait_until(lambda: node.output.count("repeated for 0.5 s: stop") == number, "told")


def test_what_ends_a_word(peer: Peer, ros_domain: int) -> None:
    with NodeProcess("nodes.ai_driver", ros_domain, params=LONG) as node:
        heard = Heard(peer)
        for word in ("forward", "стоп"):
            peer.say("/ai_command", String(data=word))
            heard.again_and_again(0.5) if word == "forward" else heard.stop()
        peer.say("/ai_command", String(data="forward"))
        heard.again_and_again(0.5)
        peer.say("/ai_command", String(data="назад"))
        heard.again_and_again(-0.3)
        peer.say("/ai_command", String(data="whoa"))
        heard.stop()

        peer.say("/ai_command", String(data="forward"))
        heard.again_and_again(0.5)
        peer.say("/emergency_stop", Bool(data=True), qos=LATCHED)
        heard.stop()
        peer.say("/ai_command", String(data="back"))
        wait_until(lambda: heard.speeds[-1] == -0.3, "a word during the stop, said once")
        peer.say("/emergency_stop", Bool(data=False), qos=LATCHED)
        node.wait_for_words('Heard "back"')

        peer.say("/ai_command", String(data="forward"))
        heard.again_and_again(0.5)
        assert -0.3 not in heard.speeds
        node.send(signal.SIGTERM)
        assert node.wait() == 0
        heard.stop()


def test_a_response_lasts_until_the_next(peer: Peer, ros_domain: int) -> None:
    def send(*commands: object) -> None:
        text = json.dumps({"thought": "", "commands": commands})
        peer.say("/llm_raw_json", String(data=text))

    drive = {"action": "drive", "speed": 0.2, "steering": -0.3}
    with NodeProcess("nodes.llm_parser", ros_domain, params=LONG):
        heard = Heard(peer)
        send({**drive, "speed": 0.1}, drive)
        heard.again_and_again(0.2)
        assert heard.speeds.count(0.1) <= 1, "the last of a response is repeated"
        send()
        heard.stop()
        send(drive)
        heard.again_and_again(0.2)
        peer.say("/llm_raw_json", String(data="no JSON"))
        heard.stop()
