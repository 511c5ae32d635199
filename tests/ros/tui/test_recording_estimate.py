"""A recording without pictures, and its size beside what was said before it began."""

from __future__ import annotations

from pathlib import Path

import pytest
from rclpy.qos import QoSProfile
from rclpy.timer import Timer
from sensor_msgs.msg import CompressedImage, Image, PointCloud2
from std_msgs.msg import Float32

from graph.data import GraphUpdate
from graph.heavy_types import HEAVY_TYPES, IMAGE
from graph.observer.observer import Observer
from graph.recording.recorder import Recorder
from tests.ros.peer import Peer
from tests.ros.recorded import messages_of, read_by_rosbags, wait_for_topic
from tests.waiting import wait_until
from tui.bags.estimate import OTHERS, RecordingShare, shares, total_rate

pytestmark = pytest.mark.nightly

HZ = 20.0
WIDTH, HEIGHT = 64, 48
HEAVY = {"/camera": Image, "/camera/compressed": CompressedImage, "/cloud": PointCloud2}


def publish_all(peer: Peer) -> Timer:
    """Publish a picture, a compressed one, a cloud and a number, each `HZ` times a second."""
    qos = QoSProfile(depth=50)
    pixels = bytes(3 * WIDTH * HEIGHT)
    picture = Image(width=WIDTH, height=HEIGHT, step=3 * WIDTH, encoding="rgb8", data=pixels)
    messages = {
        "/camera": picture,
        "/camera/compressed": CompressedImage(format="jpeg", data=bytes(2000)),
        "/cloud": PointCloud2(width=100, height=1, point_step=12, row_step=1200, data=bytes(1200)),
        "/number": Float32(data=0.5),
    }
    for topic, message in messages.items():
        peer.publisher(topic, type(message), qos)

    def say() -> None:
        for topic, message in messages.items():
            peer.say(topic, message)

    return peer.node.create_timer(1.0 / HZ, say)


def measured(domain: int) -> tuple[RecordingShare, ...]:
    """Return the shares, once every topic has been measured for some seconds."""
    updates: list[GraphUpdate] = []
    observer = Observer(domain, "localhost")
    observer.measure(True)
    observer.start(updates.append)

    def is_known() -> bool:
        rows = {row.name: row for row in updates[-1].topics} if updates else {}
        return all(
            topic in rows and abs((rows[topic].hz or 0.0) - HZ) < HZ / 10
            for topic in (*HEAVY, "/number")
        )

    try:
        wait_until(is_known, "the rates of all topics")
        return shares(updates[-1].topics)
    finally:
        observer.stop()


def test_what_is_left_out_is_not_there_and_the_size_is_what_was_said(
    ros_domain: int, tmp_path: Path
) -> None:
    with Peer(ros_domain) as peer:
        timer = publish_all(peer)
        said = measured(ros_domain)
        assert {share.type_name: share.topics for share in said if share.type_name != OTHERS} == {
            kind: (topic,) for topic, kind in zip(HEAVY, HEAVY_TYPES, strict=True)
        }
        whole = Recorder(ros_domain, "localhost", tmp_path / "whole")
        light = Recorder(
            ros_domain, "localhost", tmp_path / "light", without=frozenset(HEAVY_TYPES)
        )
        no_pictures = Recorder(
            ros_domain, "localhost", tmp_path / "clouds", without=frozenset({IMAGE})
        )
        for recorder in (whole, light, no_pictures):
            recorder.start()
            wait_for_topic(recorder, "/number")
        wait_for_topic(whole, "/camera")
        wait_until(lambda: messages_of(whole, "/camera") >= 3 * HZ, "three seconds of pictures")
        timer.cancel()
        for recorder in (whole, light, no_pictures):
            recorder.stop()

    assert HEAVY.keys() <= read_by_rosbags(tmp_path / "whole").keys()
    assert HEAVY.keys().isdisjoint(read_by_rosbags(tmp_path / "light"))
    assert "/number" in read_by_rosbags(tmp_path / "light")
    assert HEAVY.keys() - read_by_rosbags(tmp_path / "clouds").keys() == {"/camera"}
    rate = total_rate(said, frozenset())
    assert rate is not None
    size = next((tmp_path / "whole").glob("*.mcap")).stat().st_size
    # By its messages, not by the clock: a busy machine publishes more slowly than was measured.
    seconds = len(read_by_rosbags(tmp_path / "whole")["/camera"]) / HZ
    assert 0.8 < size / (rate * seconds) < 1.3
