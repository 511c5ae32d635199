"""A recorder, real publishers, and two independent readers of the bag."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest
from geometry_msgs.msg import TransformStamped
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from std_msgs.msg import Bool, Float32, String
from tf2_msgs.msg import TFMessage

from graph.bag.reading import open_bag
from graph.recording import topics as recording_topics
from graph.recording.recorder import Recorder
from tests.ros.observing import Watcher, let_updates_come
from tests.ros.peer import LATCHED, Peer
from tests.ros.recorded import messages_of, read_by_mcap, read_by_rosbags, row_of, wait_for_topic
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

ROOT = Path(__file__).parents[3]
DEEP = QoSProfile(depth=1000)


def recorded(recorder: Recorder, topic: str, count: int) -> None:
    wait_until(lambda: messages_of(recorder, topic) >= count, f"{count} messages of {topic}")


def test_what_is_published_is_in_the_bag_byte_for_byte(ros_domain: int, tmp_path: Path) -> None:
    recorder = Recorder(ros_domain, "localhost", tmp_path / "bag")
    sent = [Float32(data=0.5 * n) for n in range(300)]
    with Peer(ros_domain) as peer:
        peer.publisher("/numbers", Float32, DEEP)
        recorder.start()
        wait_for_topic(recorder, "/numbers")
        for message in sent:
            peer.say("/numbers", message)
        recorded(recorder, "/numbers", len(sent))
        status = recorder.stop()

    assert (status.messages, status.lost, status.error) == (300, 0, "")
    raw = [serialize_message(message) for message in sent]
    assert read_by_mcap(tmp_path / "bag") == {"/numbers": raw}
    assert read_by_rosbags(tmp_path / "bag") == {"/numbers": raw}


def test_latched_messages_of_before_are_recorded_and_later_topics_taken_up(ros_domain: int, tmp_path: Path) -> None:
    recorder = Recorder(ros_domain, "localhost", tmp_path / "bag")
    with Peer(ros_domain) as peer:
        peer.publisher("/tf_static", TFMessage, LATCHED).publish(
            TFMessage(transforms=[TransformStamped(child_frame_id="camera")])
        )
        recorder.start()
        recorded(recorder, "/tf_static", 1)
        peer.publisher("/late", String)
        wait_for_topic(recorder, "/late")
        peer.say("/late", String(data="here"))
        recorded(recorder, "/late", 1)
        status = recorder.stop()
    assert {"/tf_static", "/late"} <= {row.name for row in status.topics}
    assert set(read_by_mcap(tmp_path / "bag")) == {"/tf_static", "/late"}


RECORD = """
import sys, time
from graph.recording.recorder import Recorder
from pathlib import Path
recorder = Recorder(int(sys.argv[1]), "localhost", Path(sys.argv[2]))
recorder.start()
while not recorder.status.error:
    print(recorder.status.messages, flush=True)
    time.sleep(0.1)
"""


def recording(domain: int, folder: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", RECORD, str(domain), str(folder)],
        cwd=ROOT,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )


def test_after_a_kill_all_but_the_last_moments_can_be_read(ros_domain: int, tmp_path: Path) -> None:
    process = recording(ros_domain, tmp_path / "bag")
    assert process.stdin is not None
    assert process.stdout is not None
    with Peer(ros_domain) as peer:
        for number in range(40):
            peer.say("/text", String(data=f"number {number}"))
        file = tmp_path / "bag" / "bag.mcap"
        wait_until(lambda: b"number 39" in file.read_bytes(), "the forty on the disk")
        peer.say("/text", String(data="one more"))
        process.send_signal(signal.SIGKILL)
        process.wait()
        process.stdin.close()
        process.stdout.close()
    with open_bag(tmp_path / "bag") as bag:
        found = [raw for _topic, _stamp, raw in bag.messages()]
        assert "was cut short" in " ".join(bag.notes)
    said = [deserialize_message(raw, String).data for raw in found]
    assert said[:40] == [f"number {number}" for number in range(40)]


def test_a_recorder_does_not_pass_for_somebody_who_obeys(ros_domain: int, tmp_path: Path) -> None:
    recorder = Recorder(ros_domain, "localhost", tmp_path / "bag")
    watcher = Watcher(ros_domain)
    with Peer(ros_domain) as peer:
        watcher.want(all_topics=True)
        peer.publisher("/emergency_stop", Bool, LATCHED).publish(Bool(data=True))
        recorder.start()
        recorded(recorder, "/emergency_stop", 1)
        let_updates_come(watcher, 10)
        row = watcher.wait_for("/emergency_stop", lambda row: row.count, "a message")
        assert (row.publishers, row.subscribers) == (1, 0)
        recorder.stop()
    watcher.close()


def test_lost_messages_are_counted(ros_domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # A publisher on a busy machine may be too slow to fill the whole queue between two turns.
    monkeypatch.setattr(recording_topics, "DEEP", 5)
    recorder = Recorder(ros_domain, "localhost", tmp_path / "bag")
    shallow = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    with Peer(ros_domain) as peer:
        publisher = peer.publisher("/fast", Float32, shallow)
        recorder.start()
        wait_for_topic(recorder, "/fast")

        def tell() -> int:
            # What follows a gap is what tells of it.
            publisher.publish(Float32())
            row = row_of(recorder, "/fast")
            return row.messages + row.lost if row else 0

        wait_until(tell, "the first message")
        for number in range(1000):
            publisher.publish(Float32(data=float(number)))
        wait_until(lambda: tell() > 1000, "every message recorded or counted as lost")
        status = recorder.stop()
    assert 0 < status.lost < 1000
