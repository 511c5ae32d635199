"""The frames of a recording, shown as if its nodes were at work."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from rosbags.rosbag2 import StoragePlugin, Writer

from graph.data import FrameRow, GraphUpdate
from graph.replay.replay import Replay
from tests.unit.bags import BEGIN_NS, SECOND_NS, store
from tests.unit.transform_messages import Sent, cdr
from tests.waiting import wait_until

BEGIN_S = BEGIN_NS / SECOND_NS
TF_MESSAGE = "tf2_msgs/msg/TFMessage"


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """Ten seconds in which a robot drives 0.1 m every 0.1 s, and its camera is where it is."""
    types = store()
    with Writer(tmp_path / "drive", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        moving = writer.add_connection("/tf", TF_MESSAGE, typestore=types)
        static = writer.add_connection("/tf_static", TF_MESSAGE, typestore=types)
        image = writer.add_connection("/number", "sensor_msgs/msg/Range", typestore=types)
        writer.write(static, BEGIN_NS, cdr(Sent("base_link", "camera_link", BEGIN_S)))
        writer.write(static, BEGIN_NS, cdr(Sent("base_link", "sonar", BEGIN_S)))
        made = types.types
        header = made["std_msgs/msg/Header"](
            stamp=made["builtin_interfaces/msg/Time"](sec=0, nanosec=0), frame_id="sonar_fornt"
        )
        distance = made["sensor_msgs/msg/Range"](header, 0, 0.1, 0.1, 2.0, 1.0, 0.0)
        raw = types.serialize_cdr(distance, "sensor_msgs/msg/Range")
        writer.write(image, BEGIN_NS, bytes(raw))
        for turn in range(101):
            stamp_ns = BEGIN_NS + turn * SECOND_NS // 10
            sent = Sent("odom", "base_link", stamp_ns / SECOND_NS, (turn / 10, 0.0, 0.0))
            writer.write(moving, stamp_ns, cdr(sent))
    return tmp_path / "drive"


class Shown:
    """What a replay has handed over last."""

    def __init__(self, bag: Path) -> None:
        self.replay = Replay(bag)
        self.replay.period_s = 0.02
        self.update = GraphUpdate(0.0)

    def take(self, update: GraphUpdate) -> None:
        self.update = update

    def frame(self, child: str) -> FrameRow | None:
        return next((row for row in self.update.frames if row.newest.child == child), None)

    def see(self, child: str) -> FrameRow:
        return wait_until(lambda: self.frame(child), f"the frame {child}")


@pytest.fixture
def shown(bag: Path) -> Iterator[Shown]:
    made = Shown(bag)
    made.replay.start(made.take)
    made.replay.toggle()
    wait_until(lambda: made.replay.state.paused, "paused")
    yield made
    made.replay.stop()


def test_frames_come_with_the_playhead_also_when_it_jumps(shown: Shown) -> None:
    shown.replay.seek(5.0)
    wait_until(lambda: shown.replay.state.position_s == 5.0, "the middle")
    assert not shown.update.frames
    shown.replay.watch_frames(True)
    base = shown.see("base_link")
    assert base.newest.transform.translation == pytest.approx((5.0, 0.0, 0.0))
    assert base.hz == pytest.approx(10.0)
    assert base.delay_s == pytest.approx(0.0, abs=1e-5)
    assert base.publishers == ("/bag",)
    # Both were published once, long before: the second message must not hide the first.
    for child in ("camera_link", "sonar"):
        assert shown.see(child).is_static
    shown.replay.seek(1.0)
    wait_until(
        lambda: (row := shown.frame("base_link")) and row.newest.transform.translation[0] == 1.0,
        "where it was after a second",
    )
    shown.replay.watch_frames(False)
    wait_until(lambda: not shown.update.frames, "nothing once nobody looks")


def test_the_frame_that_a_message_names_is_told(shown: Shown) -> None:
    shown.replay.seek(1.0)
    wait_until(lambda: shown.update.topics and shown.replay.state.position_s == 1.0, "rows")
    named = {row.name: row.frame_id for row in shown.update.topics}
    assert named == {"/number": "sonar_fornt", "/tf": "", "/tf_static": ""}
