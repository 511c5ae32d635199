"""Where a frame is in another: in one process, and over the topics."""

from __future__ import annotations

import importlib
import math
from collections.abc import Iterator
from typing import Any

import pytest
import rclpy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.logging import LoggingSeverity, get_logger
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy
from rclpy.time import Time
from tf2_msgs.msg import TFMessage

from launcher.faults.crash import warning_in

MODULES = {
    "buffer": "Buffer",
    "buffer_client": "BufferClient",
    "buffer_interface": "BufferInterface",
    "static_transform_broadcaster": "StaticTransformBroadcaster",
    "transform_broadcaster": "TransformBroadcaster",
    "transform_listener": "TransformListener",
}
"""Of the package of that name in ROS."""
S = 1_000_000_000
NEWEST = Time()


def at(seconds: float) -> Time:
    return Time(nanoseconds=int(seconds * S))


def transform(parent: str, child: str, x: float = 0.0, *, yaw: float = 0.0, time: float = 0.0) -> Any:
    """Return where a frame is: so far ahead of its parent, and turned to the left."""
    found = TransformStamped(child_frame_id=child)
    found.header.frame_id = parent
    found.header.stamp = at(time).to_msg()
    found.transform.translation.x = x
    found.transform.rotation.z = math.sin(yaw / 2)
    found.transform.rotation.w = math.cos(yaw / 2)
    return found


def place(found: Any) -> tuple[float, float]:
    moved = found.transform.translation
    return round(moved.x, 6), round(moved.y, 6)


def yaw(found: Any) -> float:
    turned = found.transform.rotation
    return 2 * math.atan2(turned.z, turned.w)


@pytest.fixture
def buffer() -> tf2_ros.Buffer:
    """A robot that drives 1 m/s and turns 90 degrees in two seconds, with a camera on its front."""
    made = tf2_ros.Buffer()
    made.set_transform_static(transform("base_link", "camera_link", 0.15), "test")
    for second in (1, 2, 3):
        turn = math.radians(45) * (second - 1)
        made.set_transform(transform("odom", "base_link", second, yaw=turn, time=second), "test")
    return made


def test_time_0_is_the_newest_that_all_of_the_way_has(buffer: tf2_ros.Buffer) -> None:
    buffer.set_transform(transform("base_link", "arm", 1.0, time=1.5), "test")
    buffer.set_transform(transform("base_link", "arm", 2.0, time=2.5), "test")
    found = buffer.lookup_transform("odom", "arm", NEWEST)
    assert Time.from_msg(found.header.stamp).nanoseconds == 2.5 * S
    assert buffer.get_latest_common_time("odom", "arm").nanoseconds == 2.5 * S
    static = buffer.lookup_transform("base_link", "camera_link", NEWEST)
    assert Time.from_msg(static.header.stamp).nanoseconds == 0


@pytest.mark.parametrize(
    ("frames", "time", "kind", "words"),
    [
        (("odom", "kamera"), 0, tf2_ros.LookupException, '"kamera" .*does not exist'),
        (("odom", "map"), 0, tf2_ros.ConnectivityException, "unconnected trees"),
        (("odom", "camera_link"), 4, tf2_ros.ExtrapolationException, "into the future"),
        (("odom", "camera_link"), 0.5, tf2_ros.ExtrapolationException, "into the past"),
        (("odom", ""), 0, tf2_ros.InvalidArgumentException, "cannot be empty"),
        (("odom", "/base_link"), 0, tf2_ros.InvalidArgumentException, "cannot start with"),
    ],
)
def test_why_there_is_no_transform(
    buffer: tf2_ros.Buffer, frames: tuple[str, str], time: float, kind: type, words: str
) -> None:
    buffer.set_transform(transform("map", "house", time=2), "test")
    with pytest.raises(kind, match=words) as raised:
        buffer.lookup_transform(*frames, at(time))
    assert isinstance(raised.value, tf2_ros.TransformException)
    assert not buffer.can_transform(*frames, at(time))


@pytest.fixture
def nodes(ros_domain: int) -> Iterator[tuple[Node, Node]]:
    context = Context()
    rclpy.init(context=context, domain_id=ros_domain)
    made = (Node("teller", context=context), Node("listener", context=context))
    yield made
    for node in made:
        node.destroy_node()
    context.try_shutdown()


def test_over_the_topics(nodes: tuple[Node, Node]) -> None:
    """Static frames reach a listener that comes later, all of them; moving ones a later one not."""
    teller, listener = nodes
    fixed = tf2_ros.StaticTransformBroadcaster(teller)
    fixed.sendTransform(transform("base_link", "camera_link", 0.15))
    fixed.sendTransform([transform("base_link", "sonar_link", 0.2)])
    moving = tf2_ros.TransformBroadcaster(teller)
    buffer = tf2_ros.Buffer(node=listener)
    heard = tf2_ros.TransformListener(buffer, listener)
    executor = SingleThreadedExecutor(context=listener.context)
    executor.add_node(listener)
    for target in ("camera_link", "sonar_link"):
        waiting = buffer.wait_for_transform_async("base_link", target, NEWEST)
        executor.spin_until_future_complete(waiting, 20.0)
        assert waiting.done(), target
    waiting = buffer.wait_for_transform_async("odom", "camera_link", NEWEST)
    for _ in range(200):
        moving.sendTransform(transform("odom", "base_link", 2.0, time=7))
        executor.spin_until_future_complete(waiting, 0.1)
        if waiting.done():
            break
    assert place(waiting.result()) == (2.15, 0.0)
    (static,) = teller.get_publishers_info_by_topic("/tf_static")
    assert static.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
    (plain,) = teller.get_publishers_info_by_topic("/tf")
    assert plain.qos_profile.durability is DurabilityPolicy.VOLATILE
    assert heard.tf_sub.msg_type is TFMessage
    heard.unregister()


def test_a_listener_can_have_a_thread_of_its_own(nodes: tuple[Node, Node]) -> None:
    teller, listener = nodes
    fixed = tf2_ros.StaticTransformBroadcaster(teller)
    fixed.sendTransform(transform("base_link", "camera_link", 0.15))
    buffer = tf2_ros.Buffer()
    heard = tf2_ros.TransformListener(buffer, listener, spin_thread=True)
    found = buffer.lookup_transform("base_link", "camera_link", NEWEST, Duration(seconds=20))
    assert place(found) == (0.15, 0.0)
    listener.context.try_shutdown()
    heard.dedicated_listener_thread.join(20)
    assert not heard.dedicated_listener_thread.is_alive()


@pytest.mark.parametrize("module", MODULES)
def test_each_class_is_in_the_module_that_has_it_in_ros(module: str) -> None:
    found = getattr(importlib.import_module(f"tf2_ros.{module}"), MODULES[module])
    assert found is getattr(tf2_ros, MODULES[module])


def test_a_buffer_client_says_what_to_take_instead() -> None:
    with pytest.raises(NotImplementedError, match="take a Buffer and a TransformListener"):
        tf2_ros.BufferClient(None, "server")  # type: ignore[arg-type]


def test_a_buffer_that_nothing_fills_says_which_line_asks_it(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("tf2_ros.buffer.UNHEARD_S", 0.0)
    # An observer of Deck's in this process silences all without a level of their own.
    get_logger("tf2_buffer").set_level(LoggingSeverity.INFO)
    alone, filled = tf2_ros.Buffer(), tf2_ros.Buffer()
    filled.set_transform(transform("map", "odom"), "test")
    for each in (alone, alone, filled):
        assert not each.can_transform("base_link", "tool", NEWEST)
    told = [line for line in capfd.readouterr().err.splitlines() if "[tf2_buffer]" in line]
    assert len(told) == 1
    fault = warning_in(told[0].partition("]: ")[2], "/nowhere")
    assert fault is not None
    assert (fault.file, fault.source_line) == (__file__, 'assert not each.can_transform("base_link", "tool", NEWEST)')
    assert "TransformListener(self.buffer, self)" in fault.meaning
