"""From a word to wheel speeds: the translator and the electronic differential."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, String

from robot.limits import RIM_M_S
from tests.ros.gate import BEYOND, STAMPS, drive, stamped
from tests.ros.node_thread import NodeThread
from tests.ros.peer import LATCHED, Peer
from tests.waiting import comes, wait_until

if TYPE_CHECKING:
    pass

RADIUS = 0.0325


@pytest.fixture
def heard(peer: Peer) -> list[JointState]:
    return peer.hear("/wheel_commands", JointState)


def rims(message: JointState) -> tuple[float, float]:
    """Speeds of the rear wheels at their rims, m/s."""
    return message.velocity[0] * RADIUS, message.velocity[1] * RADIUS


def wait_for_rims(heard: list[Any], left: float, right: float) -> JointState:
    heard.clear()
    wait_until(
        lambda: heard and rims(heard[-1]) == pytest.approx((left, right), abs=5e-5),
        f"wheels at {left} and {right} m/s",
    )
    return heard[-1]


# ---------------------------------------------------------------- words


def drives(peer: Peer, heard: list[Any], word: str, speed: float, steering: float) -> bool:
    """Say it, and tell whether its command comes; the first are lost if nobody is known to listen.

    That the node's publisher is known here does not tell that it knows who listens here.
    """

    def came() -> bool:
        wanted = (pytest.approx(speed), pytest.approx(steering))
        return any((one.drive.speed, one.drive.steering_angle) == wanted for one in heard)

    peer.say("/ai_command", String(data=word))
    return comes(came, within_s=1.0)


@pytest.mark.parametrize("lang", ["en", "ru"])
def test_words_of_both_languages_drive(peer: Peer, ros_domain: int, lang: str) -> None:
    with NodeThread("nodes.ai_driver", ros_domain, lang=lang) as node:
        heard = peer.hear("/drive", AckermannDriveStamped)
        node.wait_for_words("[ai_driver_translator]")
        expected = [(0.5, 0.0), (0.3, 0.5), (0.3, -0.5), (-0.3, 0.0), (0.0, 0.0)]
        for word, (speed, steering) in zip(("ВПЕРЁД ", "left", "направо", "back", "Стоп!"), expected, strict=True):
            heard.clear()
            wait_until(
                lambda word=word, way=(speed, steering): drives(peer, heard, word, *way),  # type: ignore[misc]
                f"/drive for {word}",
            )
            assert heard[-1].header.stamp.sec > 0


# ---------------------------------------------------------------- wheels


def test_the_course_s_left_turn_reaches_the_wheels(peer: Peer, heard: list[JointState], ros_domain: int) -> None:
    with NodeThread("nodes.electronic_differential", ros_domain) as node:
        peer.say("/drive", drive(0.3, 0.5))
        message = wait_for_rims(heard, 0.2508, 0.3492)
        assert message.name == ["rear_left_wheel_joint", "rear_right_wheel_joint", "steering_joint"]
        assert message.position[2] == pytest.approx(0.5)
        assert all(math.isnan(message.position[wheel]) for wheel in (0, 1))
        assert math.isnan(message.velocity[2])
        node.wait_for_words("Turning left: 0.30 m/s, steering 0.50 rad -> left 0.25, right 0.35")


def test_too_much_is_limited_with_a_word(peer: Peer, heard: list[JointState], ros_domain: int) -> None:
    params: dict[str, object] = {"max_speed": 0.2, "max_steering": 0.1}
    with NodeThread("nodes.electronic_differential", ros_domain, params=params) as node:
        peer.say("/drive", drive(-0.4, 0.4))
        wait_until(lambda: heard and heard[-1].velocity[0] != 0, "wheels")
        left, right = rims(heard[-1])
        assert (left + right) / 2 == pytest.approx(-0.2)
        assert heard[-1].position[2] == pytest.approx(0.1)
        node.wait_for_words("limited to 0.2 m/s and 0.1 rad")


def test_what_is_beyond_the_limits_or_old_stops_the_wheels(
    peer: Peer, heard: list[JointState], ros_domain: int
) -> None:
    with NodeThread("nodes.electronic_differential", ros_domain) as node:
        for speed, steering, words in BEYOND:
            peer.say("/drive", drive(0.3))
            wait_for_rims(heard, 0.3, 0.3)
            # Again and again: what is refused is told once a second.
            with peer.saying("/drive", drive(speed, steering)):
                wait_for_rims(heard, 0.0, 0.0)
                node.wait_for_words(f"/drive asks for {words.partition(',')[0]}")
        node.wait_for_words("[ERROR]", "refused")
        heard.clear()
        for since_s, words in STAMPS:
            with peer.saying("/drive", stamped(drive(0.3), since_s)):
                node.wait_for_words(words)
        assert max(abs(rim) for message in heard for rim in rims(message)) == 0.0
        peer.say("/drive", stamped(drive(0.1), 0.0))
        wait_for_rims(heard, 0.1, 0.1)


@pytest.mark.parametrize("params", [{}, {"track": 0.4}, {"wheelbase": 0.1}], ids=str)
def test_the_outer_wheel_of_a_tight_curve_stays_within_its_limit(
    peer: Peer, heard: list[JointState], ros_domain: int, params: dict[str, object]
) -> None:
    with NodeThread("nodes.electronic_differential", ros_domain, params=params) as node:
        peer.say("/drive", drive(0.5, 0.5))
        wait_until(lambda: heard and any(heard[-1].velocity[:2]), "turning wheels")
        left, right = rims(heard[-1])
        assert right == pytest.approx(RIM_M_S)
        share = float(str(params.get("track", 0.15))) / 2 * math.tan(0.5)
        share /= float(str(params.get("wheelbase", 0.25)))
        assert left / right == pytest.approx((1 - share) / (1 + share))
        if params:
            node.wait_for_words("both are slowed")


@pytest.mark.parametrize("qos", [LATCHED, 10], ids=["latched", "volatile"])
def test_the_emergency_stop_holds_the_wheels(peer: Peer, heard: list[JointState], ros_domain: int, qos: Any) -> None:
    with NodeThread("nodes.electronic_differential", ros_domain, params={"rate": 20}) as node:
        peer.say("/drive", drive(0.3))
        wait_for_rims(heard, 0.3, 0.3)
        peer.say("/emergency_stop", Bool(data=True), qos=qos)
        wait_for_rims(heard, 0.0, 0.0)
        heard.clear()
        peer.say("/drive", drive(0.3))
        wait_until(lambda: len(heard) > 10, "wheels during the stop")
        assert {rims(message) for message in heard} == {(0.0, 0.0)}
        peer.say("/emergency_stop", Bool(data=False), qos=qos)
        node.wait_for_words("released")
        peer.say("/drive", drive(0.2))
        wait_for_rims(heard, 0.2, 0.2)


def test_a_command_that_is_not_renewed_becomes_a_stop(peer: Peer, heard: list[JointState], ros_domain: int) -> None:
    params: dict[str, object] = {"max_age_s": 0.3, "rate": 20}
    with NodeThread("nodes.electronic_differential", ros_domain, params=params) as node:
        wait_until(lambda: heard, "standing wheels, before they turn for a moment")
        peer.say("/drive", drive(0.3))
        wait_until(lambda: any(rims(m)[0] > 0 for m in heard), "moving wheels")
        wait_for_rims(heard, 0.0, 0.0)
        node.wait_for_words("No command for 0.3 s")


# ---------------------------------------------------------------- repeated for a gate


LONG: dict[str, object] = {"repeat_for_s": 60.0}


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


def test_what_ends_a_word(peer: Peer, ros_domain: int) -> None:
    with NodeThread("nodes.ai_driver", ros_domain, params=LONG) as node:
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
        node.close()
        heard.stop()


def test_a_response_lasts_until_the_next(peer: Peer, ros_domain: int) -> None:
    def send(*commands: object) -> None:
        text = json.dumps({"thought": "", "commands": commands})
        peer.say("/llm_raw_json", String(data=text))

    drive = {"action": "drive", "speed": 0.2, "steering": -0.3}
    with NodeThread("nodes.llm_parser", ros_domain, params=LONG):
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
