"""From a word to wheel speeds: the translator and the electronic differential."""

from __future__ import annotations

import math
import signal
from typing import TYPE_CHECKING, Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, String

from tests.ros.node_process import NodeProcess
from tests.ros.peer import LATCHED, Peer
from tests.waiting import comes, wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.nightly

RADIUS = 0.0325


@pytest.fixture
def peer(ros_domain: int) -> Iterator[Peer]:
    with Peer(ros_domain) as peer:
        yield peer


def drive(speed: float, steering: float = 0.0) -> AckermannDriveStamped:
    message = AckermannDriveStamped()
    message.drive.speed = speed
    message.drive.steering_angle = steering
    return message


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
    with NodeProcess("nodes.ai_driver", ros_domain, lang=lang) as node:
        heard = peer.hear("/drive", AckermannDriveStamped)
        node.wait_for_words("[ai_driver_translator]")
        expected = [(0.5, 0.0), (0.3, 0.5), (0.3, -0.5), (-0.3, 0.0), (0.0, 0.0)]
        for word, (speed, steering) in zip(
            ("ВПЕРЁД ", "left", "направо", "back", "Стоп!"), expected, strict=True
        ):
            heard.clear()
            wait_until(
                lambda word=word, way=(speed, steering): drives(peer, heard, word, *way),  # type: ignore[misc]
                f"/drive for {word}",
            )
            assert heard[-1].header.stamp.sec > 0


def test_an_unknown_or_empty_word_is_told_and_moves_nothing(peer: Peer, ros_domain: int) -> None:
    with NodeProcess("nodes.ai_driver", ros_domain, lang="ru") as node:
        heard = peer.hear("/drive", AckermannDriveStamped)
        wait_until(lambda: drives(peer, heard, "right", 0.3, -0.5), "/drive of a known word")
        peer.say("/ai_command", String(data="прыжок\x1b[31m"))
        node.wait_for_words("[WARN]", "Неизвестная команда «прыжок␛[31m»", "вперед, налево")
        peer.say("/ai_command", String(data=""))
        node.wait_for_words("«»")
        wait_until(lambda: drives(peer, heard, "left", 0.3, 0.5), "/drive of another one")
        steered = {round(one.drive.steering_angle, 3) for one in heard}
        assert steered == {-0.5, 0.5}, "nothing but what was known"


# ---------------------------------------------------------------- wheels


def test_the_course_s_left_turn_reaches_the_wheels(peer: Peer, ros_domain: int) -> None:
    with NodeProcess("nodes.electronic_differential", ros_domain) as node:
        heard = peer.hear("/wheel_commands", JointState)
        peer.say("/drive", drive(0.3, 0.5))
        message = wait_for_rims(heard, 0.2508, 0.3492)
        assert message.name == ["rear_left_wheel_joint", "rear_right_wheel_joint", "steering_joint"]
        assert message.position[2] == pytest.approx(0.5)
        assert all(math.isnan(message.position[wheel]) for wheel in (0, 1))
        assert math.isnan(message.velocity[2])
        node.wait_for_words("Turning left: 0.30 m/s, steering 0.50 rad -> left 0.25, right 0.35")


def test_who_comes_late_sees_the_command_of_the_moment(peer: Peer, ros_domain: int) -> None:
    with NodeProcess("nodes.electronic_differential", ros_domain):
        peer.say("/drive", drive(-0.3))
        wait_for_rims(peer.hear("/wheel_commands", JointState), -0.3, -0.3)


def test_another_chassis_is_a_matter_of_parameters(peer: Peer, ros_domain: int) -> None:
    mini: dict[str, object] = {"wheelbase": 0.144, "track": 0.162, "drive_topic": "/drive_safe"}
    with NodeProcess("nodes.electronic_differential", ros_domain, params=mini):
        heard = peer.hear("/wheel_commands", JointState)
        peer.say("/drive_safe", drive(0.4, 0.3903))
        wait_for_rims(heard, 0.4 * 0.7686, 0.4 * 1.2314)


def test_too_much_is_limited_with_a_word(peer: Peer, ros_domain: int) -> None:
    params: dict[str, object] = {"max_speed": 0.2, "max_steering": 0.1}
    with NodeProcess("nodes.electronic_differential", ros_domain, params=params) as node:
        heard = peer.hear("/wheel_commands", JointState)
        peer.say("/drive", drive(-0.4, 0.4))
        wait_until(lambda: heard and heard[-1].velocity[0] != 0, "wheels")
        left, right = rims(heard[-1])
        assert (left + right) / 2 == pytest.approx(-0.2)
        assert heard[-1].position[2] == pytest.approx(0.1)
        node.wait_for_words("limited to 0.2 m/s and 0.1 rad")


def test_a_command_that_is_no_number_stops_the_wheels(peer: Peer, ros_domain: int) -> None:
    with NodeProcess("nodes.electronic_differential", ros_domain) as node:
        heard = peer.hear("/wheel_commands", JointState)
        for bad in ((math.nan, 0.0), (0.3, math.nan), (math.inf, 0.0)):
            peer.say("/drive", drive(0.3))
            wait_for_rims(heard, 0.3, 0.3)
            peer.say("/drive", drive(*bad))
            wait_for_rims(heard, 0.0, 0.0)
        node.wait_for_words("not a number")


@pytest.mark.parametrize("qos", [LATCHED, 10], ids=["latched", "volatile"])
def test_the_emergency_stop_holds_the_wheels(peer: Peer, ros_domain: int, qos: Any) -> None:
    with NodeProcess("nodes.electronic_differential", ros_domain, params={"rate": 20}) as node:
        heard = peer.hear("/wheel_commands", JointState)
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


def test_a_command_that_is_not_renewed_becomes_a_stop(peer: Peer, ros_domain: int) -> None:
    params: dict[str, object] = {"max_age_s": 0.3, "rate": 20}
    with NodeProcess("nodes.electronic_differential", ros_domain, params=params) as node:
        heard = peer.hear("/wheel_commands", JointState)
        wait_until(lambda: heard, "standing wheels, before they turn for a moment")
        peer.say("/drive", drive(0.3))
        wait_until(lambda: any(rims(m)[0] > 0 for m in heard), "moving wheels")
        wait_for_rims(heard, 0.0, 0.0)
        node.wait_for_words("No command for 0.3 s")


def test_the_wheels_stand_when_the_node_has_ended(peer: Peer, ros_domain: int) -> None:
    with NodeProcess("nodes.electronic_differential", ros_domain) as node:
        heard = peer.hear("/wheel_commands", JointState)
        peer.say("/drive", drive(0.3))
        wait_for_rims(heard, 0.3, 0.3)
        node.send(signal.SIGTERM)
        assert node.wait() == 0
        wait_until(lambda: rims(heard[-1]) == (0.0, 0.0), "a last stop")


def test_slowing_down_by_little_steps_does_not_fill_the_log(peer: Peer, ros_domain: int) -> None:
    with NodeProcess("nodes.electronic_differential", ros_domain) as node:
        heard = peer.hear("/wheel_commands", JointState)
        for hundredths in range(20, 10, -1):
            peer.say("/drive", drive(hundredths / 100))
            wait_for_rims(heard, hundredths / 100, hundredths / 100)
        peer.say("/drive", drive(0.0))
        node.wait_for_words("Standing")
        assert 2 <= node.output.count("Straight") <= 3
