"""Types that others' programs often have are known without a further package."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from rclpy.qos import DurabilityPolicy, QoSProfile

from graph.data import Value
from graph.messages.types import load_message, load_service
from tests.ros.observing import Watcher
from tests.ros.peer import Peer
from tests.waiting import wait_until

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture
def watcher(ros_domain: int) -> Iterator[Watcher]:
    watcher = Watcher(ros_domain)
    yield watcher
    watcher.close()


@pytest.fixture
def peer(ros_domain: int) -> Iterator[Peer]:
    with Peer(ros_domain, "others") as peer:
        yield peer


@pytest.mark.parametrize(
    ("type_name", "request_"),
    [("std_srvs/srv/Trigger", {}), ("std_srvs/srv/SetBool", {"data": True})],
)
def test_a_switch_of_somebody_elses_node_is_called(
    watcher: Watcher, peer: Peer, type_name: str, request_: dict[str, Value]
) -> None:
    def answer(asked: object, response: object) -> object:
        response.success = getattr(asked, "data", True)  # type: ignore[attr-defined]
        response.message = "done"  # type: ignore[attr-defined]
        return response

    peer.node.create_service(load_service(type_name), "/switch", answer)
    wait_until(lambda: watcher.serves("/switch"), "the service")
    result = watcher.observer.call("/switch", type_name, request_, timeout_s=30).result(40)
    assert result.response == {"success": True, "message": "done"}, result.error


def test_markers_are_shown(watcher: Watcher, peer: Peer) -> None:
    array = load_message("visualization_msgs/msg/MarkerArray")()
    array.markers.append(load_message("visualization_msgs/msg/Marker")(ns="goals", id=7))
    peer.publisher("/markers", type(array), LATCHED).publish(array)
    watcher.observer.watch(["/markers"])
    wait_until(lambda: watcher.samples.get("/markers"), "the markers")
    seen: Any = watcher.samples["/markers"][-1].value
    (marker,) = seen["markers"]
    assert (marker["ns"], marker["id"]) == ("goals", 7)


@pytest.mark.parametrize(
    "type_name",
    [
        "lifecycle_msgs/msg/TransitionEvent",
        "shape_msgs/msg/SolidPrimitive",
        "stereo_msgs/msg/DisparityImage",
        "trajectory_msgs/msg/JointTrajectory",
    ],
)
def test_the_type_is_known(type_name: str) -> None:
    assert load_message(type_name)() is not None
