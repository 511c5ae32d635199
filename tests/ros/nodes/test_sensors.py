"""Sensors of others, whose drivers publish by best effort, as most of ROS 2 do, or reliably."""

from __future__ import annotations

from array import array

import pytest
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image
from std_msgs.msg import ByteMultiArray, Float32

from tests.ros.gate import FRONT, REAR, Gate, values
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until

CAMERA = "/camera/color/image_raw"


@pytest.mark.parametrize("place", ["front", "rear"])
def test_the_gate_hears_sonars_that_publish_by_best_effort(ros_domain: int, place: str) -> None:
    with Gate(ros_domain, rear_topic=REAR) as gate:
        topic = FRONT if place == "front" else REAR
        gate.peer.publisher(topic, Float32, qos_profile_sensor_data)
        gate.see(1.25, place)


def test_a_reliable_sonar_is_heard_beside_and_after_one_of_best_effort(ros_domain: int) -> None:
    with Gate(ros_domain) as gate:
        gate.see(2.0)
        with Peer(ros_domain, "other") as other:
            quick = other.publisher(FRONT, Float32, qos_profile_sensor_data)
            with other.saying(FRONT, Float32(data=1.5)):
                wait_until(quick.get_subscription_count, "the gate by best effort")
                gate.see(0.75)
        gate.see(2.5)


def test_a_camera_that_publishes_by_best_effort_is_seen(peer: Peer, ros_domain: int) -> None:
    peer.publisher(CAMERA, Image, qos_profile_sensor_data)
    picture = Image(encoding="bgr8", width=4, height=2, step=12, data=array("B", bytes(24)))
    with (
        NodeProcess("nodes.vlm_agent_stub", ros_domain, params={"period": 0.2}) as node,
        peer.saying(CAMERA, picture),
    ):
        node.wait_for_words("Picture 4x2 -> JPEG")


def test_the_brain_hears_sensors_that_publish_by_best_effort(peer: Peer, ros_domain: int) -> None:
    peer.publisher(FRONT, Float32, qos_profile_sensor_data)
    word = ByteMultiArray(data=[b"s", b"t", b"o", b"p"])
    with (
        NodeProcess("nodes.ai_brain", ros_domain) as node,
        peer.saying(FRONT, Float32(data=1.25)),
        peer.saying("/audio/mic_raw", word, 0.5),
    ):
        node.wait_for_words("1.25 m ahead")


def test_of_two_sonars_the_one_that_speaks_too_rarely_is_named(ros_domain: int) -> None:
    """A forgotten mock at 0.7 Hz came beside the real sonar: not the front sonar is silent."""
    with (
        Gate(ros_domain, stale_after_s=0.5) as gate,
        gate.peer.saying(FRONT, Float32(data=2.0), 0.05),
    ):
        gate.wait_for_state("free")
        gate.states.clear()
        wait_until(lambda: len(gate.states) > 3, "that it has been alone for a while")
        with (
            Peer(ros_domain, "forgotten") as forgotten,
            forgotten.saying(FRONT, Float32(data=9.0), 1.4),
        ):
            wait_until(
                lambda: values(gate.states[-1])["front_too_rare"] == "/forgotten", "its name"
            )
            gate.wait_for_state("blocked_forward")
            gate.process.wait_for_words("/forgotten speaks too rarely")
