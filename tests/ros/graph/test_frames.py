"""Frames of real publishers, and the reader of their messages against rclpy's own."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from typing import Any

import pytest
from geometry_msgs.msg import TransformStamped
from hypothesis import given, settings
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message
from tf2_msgs.msg import TFMessage

from graph.frames.around import surroundings
from graph.frames.book import MOST_FRAMES
from graph.frames.reading import TF_MESSAGE, TransformReader
from graph.messages.decoding import decoder
from tests.ros.frame_publishing import frames, latch, repeat, see, value
from tests.ros.observing import Peer, Watcher
from tests.unit.transform_messages import Sent, cdr
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly


@pytest.fixture(scope="module")
def peers(module_domain: int) -> Iterator[tuple[Peer, Peer]]:
    made = Peer("driver", module_domain), Peer("arm", module_domain)
    yield made
    for peer in made:
        peer.close()


@pytest.fixture
def watcher(module_watcher: Watcher) -> Iterator[Watcher]:
    module_watcher.observer.watch_frames(True)
    yield module_watcher
    module_watcher.observer.watch_frames(False)
    module_watcher.observer.measure(all_topics=False)
    wait_until(lambda: not module_watcher.update.frames, "no frames any more")


def test_two_publishers_on_both_topics_are_told_apart(
    peers: tuple[Peer, Peer], watcher: Watcher
) -> None:
    driver, arm = peers
    repeat(driver, 50, Sent("odom", "base_link", 5.0, (1.0, 2.0, 0.0)))
    latch(arm, Sent("base_link", "camera_link", 0.0, (0.15, 0.0, 0.25)))
    moving = see(
        watcher,
        "base_link",
        # After a pause of the machine several come at once.
        lambda row: row.hz == pytest.approx(50, rel=0.2) and row.publishers == (driver.name,),
        "is known with its rate",
    )
    assert moving.newest.transform.translation == (1.0, 2.0, 0.0)
    # Its stamp is of 1970.
    assert moving.delay_s > 1e9
    camera = see(watcher, "camera_link", lambda row: row.publishers == (arm.name,), "is known")
    assert camera.is_static
    assert camera.newest.transform.translation == (0.15, 0.0, 0.25)
    driver.withdraw("/tf")
    arm.withdraw("/tf_static")


def test_every_message_is_read_also_those_between_two_looks(
    peers: tuple[Peer, Peer], watcher: Watcher
) -> None:
    driver, arm = peers
    # Ten frames a message would be missed if only the newest were read: each is sent just once.
    for peer in (driver, arm):
        peer.advertise("/tf", type_name=TF_MESSAGE, depth=200)

    def both_are_heard() -> bool:
        # Whoever has looked before may still listen: more than once, until this one has heard it.
        for peer in (driver, arm):
            peer.publish("/tf", value=value(Sent("odom", peer.name)))
        return len(watcher.update.frames) == 2

    wait_until(both_are_heard, "both are heard")
    for number in range(50):
        driver.publish("/tf", value=value(Sent("odom", f"wheel_{number}")))
        arm.publish("/tf", value=value(Sent("odom", f"joint_{number}")))
    wait_until(lambda: len(watcher.update.frames) == 102, "all hundred")
    driver.withdraw("/tf")
    arm.withdraw("/tf")


def test_a_static_frame_is_shown_also_when_its_topic_was_measured_before(
    peers: tuple[Peer, Peer], module_watcher: Watcher
) -> None:
    latch(peers[0], Sent("base_link", "sonar"))
    module_watcher.observer.measure(all_topics=True)
    module_watcher.wait_for("/tf_static", lambda row: row.count, "is measured")
    module_watcher.observer.watch_frames(True)
    see(module_watcher, "sonar", lambda row: row.is_static, "is shown")
    module_watcher.observer.watch_frames(False)
    module_watcher.observer.measure(all_topics=False)
    wait_until(lambda: not module_watcher.update.frames, "nothing once nobody looks")
    peers[0].withdraw("/tf_static")


def test_what_is_latched_is_shown_also_beside_a_publisher_that_latches_nothing(
    peers: tuple[Peer, Peer], watcher: Watcher
) -> None:
    driver, arm = peers
    latch(driver, Sent("base_link", "gripper"))
    arm.advertise("/tf_static", type_name=TF_MESSAGE)
    watcher.wait_for("/tf_static", lambda row: row.publishers == 2, "both are found")
    see(watcher, "gripper", lambda row: row.is_static, "is shown")
    assert surroundings(watcher.update).volatile == (arm.name,)
    driver.withdraw("/tf_static")
    arm.withdraw("/tf_static")


def test_hostile_frames_are_said_to_be_wrong_and_good_ones_stay(
    peers: tuple[Peer, Peer], watcher: Watcher
) -> None:
    driver, arm = peers
    repeat(
        driver,
        20,
        Sent("a", "b"),
        Sent("b", "a"),
        Sent("/odom", "base_link"),
        Sent("odom", "broken", rotation=(math.nan,) * 4),
        Sent("odom", "\x1b[31mred"),
    )
    arm.advertise("/tf", type_name=TF_MESSAGE)
    wait_until(lambda: arm.listeners("/tf"), "is heard")

    def two_parents() -> bool:
        # Whoever has looked before may still listen: more than once, until this one has heard it.
        arm.publish_raw("/tf", cdr="00010000ffffffff")
        arm.publish("/tf", value=value(Sent("world", "base_link")))
        return len(frames(watcher, "base_link")) == 2

    assert "not finite" in see(watcher, "broken", lambda row: row.fault, "has a fault").fault
    wait_until(two_parents, "two parents")
    assert frames(watcher, "b")
    assert frames(watcher, "a")
    assert frames(watcher, "\x1b[31mred")
    driver.withdraw("/tf")
    arm.withdraw("/tf")


def test_two_publishers_of_one_frame_are_noticed(
    peers: tuple[Peer, Peer], watcher: Watcher
) -> None:
    driver, arm = peers
    repeat(driver, 20, Sent("odom", "base_link", 1.0))
    see(watcher, "base_link", lambda row: row.count > 5, "comes")
    assert not frames(watcher, "base_link")[0].contested
    repeat(arm, 20, Sent("odom", "base_link", 2.0))
    see(watcher, "base_link", lambda row: row.contested, "is contested")
    driver.withdraw("/tf")
    arm.withdraw("/tf")


def test_thousands_of_frames_are_limited(peers: tuple[Peer, Peer], watcher: Watcher) -> None:
    driver = peers[0]
    repeat(driver, 5, *(Sent("odom", f"frame_{number}") for number in range(3 * MOST_FRAMES)))
    wait_until(lambda: len(watcher.update.frames) == MOST_FRAMES, "as many as are kept")
    driver.withdraw("/tf")


NAMES = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=12)
NUMBERS = st.floats(width=64)


@st.composite
def messages(draw: st.DrawFn) -> TFMessage:
    transforms = []
    for _ in range(draw(st.integers(0, 6))):
        one = TransformStamped(child_frame_id=draw(NAMES))
        one.header.frame_id = draw(NAMES)
        one.header.stamp.sec = draw(st.integers(-(2**31), 2**31 - 1))
        one.header.stamp.nanosec = draw(st.integers(0, 2**32 - 1))
        for axis in "xyz":
            setattr(one.transform.translation, axis, draw(NUMBERS))
        for axis in "xyzw":
            setattr(one.transform.rotation, axis, draw(NUMBERS))
        transforms.append(one)
    return TFMessage(transforms=transforms)


def told(reader: TransformReader, raw: bytes) -> list[Any]:
    names, found = reader.read(raw)
    return [
        (*pair, *fields[:2], *map(repr, fields[4:]))
        for pair, fields in zip(names, found, strict=True)
    ]


def expected(message: TFMessage) -> list[Any]:
    return [
        (
            one.header.frame_id,
            one.child_frame_id,
            one.header.stamp.sec,
            one.header.stamp.nanosec,
            *(repr(getattr(one.transform.translation, axis)) for axis in "xyz"),
            *(repr(getattr(one.transform.rotation, axis)) for axis in "xyzw"),
        )
        for one in message.transforms
    ]


@settings(max_examples=150, deadline=None)
@given(st.lists(messages(), min_size=1, max_size=4))
def test_any_message_is_read_as_rclpy_reads_it(sent: list[TFMessage]) -> None:
    reader = TransformReader(decoder(TF_MESSAGE))
    for message in (*sent, *reversed(sent)):
        raw = bytes(serialize_message(message))
        assert (
            told(reader, raw) == expected(message) == expected(deserialize_message(raw, TFMessage))
        )


def test_big_endian_messages_are_read_too() -> None:
    names = struct.pack(">I2s2xI2s2x4x", 2, b"a\0", 2, b"b\0")
    body = struct.pack(">IiI", 1, 7, 9) + names + struct.pack(">7d", *range(1, 8))
    found = TransformReader(decoder(TF_MESSAGE)).read(b"\0\0\0\0" + body)
    assert found.names == (("a", "b"),)
    (fields,) = found.fields
    assert fields[:2] == (7, 9)
    assert fields[4:] == (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0)


@pytest.mark.parametrize("filler", [b"\0", b"\xff", b"a"])
def test_gaps_may_hold_anything(filler: bytes) -> None:
    reader = TransformReader(decoder(TF_MESSAGE))
    sent = Sent("odom", "base_link", 5.0, (1.0, 2.0, 3.0)), Sent("base_link", "x", 6.0)
    for one in (filler, b"\0"):
        names, found = reader.read(cdr(*sent, filler=one))
        assert names == (("odom", "base_link"), ("base_link", "x"))
        assert [fields[4:7] for fields in found] == [(1.0, 2.0, 3.0), (0.0, 0.0, 0.0)]
