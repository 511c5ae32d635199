"""The head: takes its second without blocking, queues, refuses, and shows where it is."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any

import pytest
from example_interfaces.srv import AddTwoInts
from rcl_interfaces.srv import ListParameters
from sensor_msgs.msg import JointState

from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.nightly

SERVICE = "/set_head_position"


class Head:
    """The head in a process of its own, and somebody who asks it."""

    def __init__(self, domain: int, **params: object) -> None:
        self.process = NodeProcess("nodes.head_controller", domain, params=params)
        self.peer = Peer(domain)
        self.states = self.peer.hear("/head_state", JointState)
        self._client = self.peer.node.create_client(AddTwoInts, SERVICE)
        wait_until(self._client.service_is_ready, SERVICE)

    def close(self) -> None:
        self.peer.close()
        self.process.close()

    def turn(self, pan: int, tilt: int) -> Any:
        return self._client.call_async(AddTwoInts.Request(a=pan, b=tilt))

    def answer(self, future: Any) -> int:
        wait_until(future.done, "the head's answer")
        return int(future.result().sum)

    def turned(self, pan: int, tilt: int) -> int:
        """The answer, for which it may have to be asked twice, see `Peer.insist`."""
        return int(self.peer.insist(lambda: self.turn(pan, tilt), "the head's answer").sum)

    def pose(self) -> tuple[float, float]:
        """Newest pan and tilt, degrees."""
        return tuple(math.degrees(angle) for angle in self.states[-1].position)  # type: ignore[return-value]


@pytest.fixture
def head(ros_domain: int, request: pytest.FixtureRequest) -> Iterator[Head]:
    head = Head(ros_domain, **getattr(request, "param", {}))
    yield head
    head.close()


def test_the_head_arrives_after_its_second(head: Head) -> None:
    began = time.monotonic()
    assert head.turned(45, -15) == 1
    assert time.monotonic() - began >= 1.0
    wait_until(lambda: head.pose() == pytest.approx((45, -15)), "the pose")
    assert head.states[-1].name == ["pan_joint", "tilt_joint"]
    head.process.wait_for_words("Turning the head to pan 45°, tilt -15°", "is there")


def test_the_way_is_shown(head: Head) -> None:
    head.states.clear()
    assert head.turned(90, 0) == 1
    pans = [math.degrees(state.position[0]) for state in head.states]
    assert pans == sorted(pans)
    assert sum(5 < pan < 85 for pan in pans) >= 5


def test_out_of_range_is_refused_at_once_with_a_word(head: Head) -> None:
    for pan, tilt in ((91, 0), (-91, 0), (0, 91), (0, -91), (2**62, 0), (0, -(2**62))):
        assert head.turned(pan, tilt) == 0, (pan, tilt)
        head.process.wait_for_words(f"Refused: pan {pan}°, tilt {tilt}°")
    head.process.wait_for_words("[WARN]", "from -90° to 90°")
    assert "Turning" not in head.process.output


@pytest.mark.parametrize("head", [{"move_time": 0.0}], indirect=True)
def test_the_ends_of_the_range_are_inside(head: Head) -> None:
    assert head.turned(-90, 90) == 1
    assert head.turned(90, -90) == 1


def test_a_second_request_waits_for_its_turn(head: Head) -> None:
    first, second = head.turn(45, 0), head.turn(-45, 0)
    head.process.wait_for_words("pan -45°, tilt 0° waits for its turn")
    assert head.answer(first) == 1
    assert not second.done()
    assert head.answer(second) == 1
    wait_until(lambda: head.pose() == pytest.approx((-45, 0)), "the second pose")


@pytest.mark.parametrize("head", [{"queue": 0, "move_time": 5.0}], indirect=True)
def test_more_than_may_wait_are_refused(head: Head) -> None:
    head.turn(45, 0)
    head.process.wait_for_words("Turning")
    assert head.turned(-45, 0) == 0
    head.process.wait_for_words("Refused: pan -45°")


@pytest.mark.parametrize("head", [{"move_time": 30.0}], indirect=True)
def test_the_node_answers_others_while_the_head_moves(head: Head) -> None:
    head.turn(45, 0)
    head.process.wait_for_words("Turning")
    service, request = "/head_controller/list_parameters", ListParameters.Request()
    names = head.peer.ask(service, ListParameters, request).result.names
    assert "move_time" in names
    head.states.clear()
    wait_until(lambda: len(head.states) >= 3, "/head_state while it moves")
