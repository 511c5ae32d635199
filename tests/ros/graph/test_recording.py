"""A recorder, real publishers, and two independent readers of the bag."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
import yaml
from ackermann_msgs.msg import AckermannDriveStamped
from geometry_msgs.msg import TransformStamped
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.service_introspection import ServiceIntrospectionState
from rosbags.highlevel import AnyReader
from sensor_msgs.msg import Image
from std_msgs.msg import Bool, Float32, String
from std_srvs.srv import SetBool
from tf2_msgs.msg import TFMessage

from graph.bag.decoding import bag_decoder
from graph.bag.errors import BagError
from graph.bag.reading import open_bag
from graph.heavy_types import IMAGES
from graph.recording import disk_room as recording_room
from graph.recording import tap as recording_tap
from graph.recording.recorder import Recorder
from tests.ros.observing import Watcher, let_updates_come
from tests.ros.peer import LATCHED, Peer
from tests.ros.recorded import (
    messages_of,
    read_by_mcap,
    read_by_rosbags,
    row_of,
    wait_for_topic,
)
from tests.ros.told_actions import Served
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

ROOT = Path(__file__).parents[3]
DEEP = QoSProfile(depth=1000)
KEPT = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


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


def test_a_reader_of_foxgloves_decodes_by_the_definitions_in_the_bag(
    ros_domain: int, tmp_path: Path
) -> None:
    drive = AckermannDriveStamped()
    drive.header.frame_id = "base_link"
    drive.drive.speed = 0.25
    recorder = Recorder(ros_domain, "localhost", tmp_path / "bag")
    with Peer(ros_domain) as peer:
        peer.publisher("/drive", AckermannDriveStamped)
        peer.publisher("/camera", Image)
        recorder.start()
        wait_for_topic(recorder, "/drive")
        wait_for_topic(recorder, "/camera")
        peer.say("/drive", drive)
        peer.say("/camera", Image(width=2, height=1, encoding="mono8", step=2, data=[7, 8]))
        recorded(recorder, "/drive", 1)
        recorded(recorder, "/camera", 1)
        recorder.stop()

    with (tmp_path / "bag" / "bag.mcap").open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        decoded = {channel.topic: ros for _s, channel, _m, ros in reader.iter_decoded_messages()}
    assert decoded["/drive"].drive.speed == 0.25
    assert decoded["/drive"].header.frame_id == "base_link"
    assert bytes(decoded["/camera"].data) == b"\x07\x08"


def test_the_metadata_tell_types_hashes_and_offers(ros_domain: int, tmp_path: Path) -> None:
    best_effort = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    recorder = Recorder(ros_domain, "localhost", tmp_path / "bag")
    with Peer(ros_domain) as peer:
        peer.publisher("/drive", AckermannDriveStamped, best_effort)
        recorder.start()
        wait_for_topic(recorder, "/drive")
        peer.say("/drive", AckermannDriveStamped())
        recorded(recorder, "/drive", 1)
        (info,) = peer.node.get_publishers_info_by_topic("/drive")
        recorder.stop()

    text = (tmp_path / "bag" / "metadata.yaml").read_text()
    found = yaml.safe_load(text)["rosbag2_bagfile_information"]
    topics = found["topics_with_message_count"]
    (topic,) = (one for one in topics if one["topic_metadata"]["name"] == "/drive")
    assert found["storage_identifier"] == "mcap"
    assert found["message_count"] == topic["message_count"] == 1
    assert topic["topic_metadata"]["type"] == "ackermann_msgs/msg/AckermannDriveStamped"
    assert topic["topic_metadata"]["type_description_hash"] == str(info.topic_type_hash)
    assert topic["topic_metadata"]["offered_qos_profiles"][0]["reliability"] == "best_effort"


def test_latched_messages_of_before_are_recorded_and_later_topics_taken_up(
    ros_domain: int, tmp_path: Path
) -> None:
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


def test_all_is_ros_own_topics_too_and_no_hidden_ones(ros_domain: int, tmp_path: Path) -> None:
    plain = Recorder(ros_domain, "localhost", tmp_path / "plain", without=IMAGES)
    whole = Recorder(ros_domain, "localhost", tmp_path / "whole", hidden=True)
    with Peer(ros_domain) as peer:
        served = Served(peer.node, "/go", reject=False, refuse_cancel=False)
        feedback = served.kind.Impl.FeedbackMessage()
        feedback.feedback.distance = 1.5
        peer.publisher("/camera", Image)
        plain.start()
        whole.start()
        wait_for_topic(plain, "/rosout")
        wait_for_topic(plain, "/parameter_events")
        wait_for_topic(whole, "/camera")
        peer.node.get_logger().warning("too near")
        recorded(plain, "/rosout", 1)
        wait_for_topic(whole, "/go/_action/status")
        peer.say("/go/_action/feedback", feedback)
        recorded(whole, "/go/_action/feedback", 1)
        left_out, taken = plain.stop(), whole.stop()
        served.server.destroy()
    names = {row.name for row in left_out.topics}
    assert not [name for name in names if "_action" in name or name == "/camera"]
    assert not {name for name in taken.skipped if "_action" in name}
    with open_bag(tmp_path / "whole") as bag:
        found = [
            bag_decoder(topic.kind)(raw)
            for topic, _stamp, raw in bag.messages(names=["/go/_action/feedback"])
        ]
    assert [message["feedback"] for message in found] == [{"distance": 1.5}]
    with AnyReader([tmp_path / "whole"]) as reader:
        ((of, _stamp, raw),) = reader.messages(
            [one for one in reader.connections if one.topic == "/go/_action/feedback"]
        )
        other: Any = reader.deserialize(raw, of.msgtype)
    assert other.feedback.distance == 1.5


def test_the_calls_of_a_service_that_tells_of_them_are_recorded_with_the_hidden(
    ros_domain: int, tmp_path: Path
) -> None:
    recorder = Recorder(ros_domain, "localhost", tmp_path / "bag", hidden=True)
    with Peer(ros_domain) as peer:
        service = peer.node.create_service(SetBool, "/lamp", lambda _asked, answer: answer)
        service.configure_introspection(
            peer.node.get_clock(), KEPT, ServiceIntrospectionState.CONTENTS
        )
        recorder.start()
        wait_for_topic(recorder, "/lamp/_service_event")
        peer.ask("/lamp", SetBool, SetBool.Request(data=True))
        # Asked and answered.
        recorded(recorder, "/lamp/_service_event", 2)
        recorder.stop()
    with open_bag(tmp_path / "bag") as bag:
        found = [
            bag_decoder(topic.kind)(raw)
            for topic, _stamp, raw in bag.messages(names=["/lamp/_service_event"])
        ]
    assert found[0]["request"] == [{"data": True}]
    with AnyReader([tmp_path / "bag"]) as reader:
        assert "/lamp/_service_event" in reader.topics


def test_a_message_has_the_time_it_was_sent_beside_that_of_its_arrival(
    ros_domain: int, tmp_path: Path
) -> None:
    recorder = Recorder(ros_domain, "localhost", tmp_path / "bag")
    with Peer(ros_domain) as peer:
        sent_after_ns = time.time_ns()
        peer.publisher("/map_name", String, LATCHED).publish(String(data="kitchen"))
        begun_ns = time.time_ns()
        recorder.start()
        recorded(recorder, "/map_name", 1)
        recorder.stop()
    with (tmp_path / "bag" / "bag.mcap").open("rb") as file:
        ((_schema, _channel, message),) = make_reader(file).iter_messages()
    assert sent_after_ns <= message.publish_time <= begun_ns <= message.log_time


def test_only_the_chosen_topics_are_recorded_and_absent_ones_are_named(
    ros_domain: int, tmp_path: Path
) -> None:
    recorder = Recorder(ros_domain, "localhost", tmp_path / "bag", ("/a", "/never"))
    with Peer(ros_domain) as peer:
        for topic in ("/a", "/b"):
            peer.publisher(topic, String)
        recorder.start()
        wait_for_topic(recorder, "/a")
        peer.say("/a", String(data="x"))
        recorded(recorder, "/a", 1)
        status = recorder.stop()
    assert [row.name for row in status.topics] == ["/a"]
    assert status.absent == ("/never",)


def test_a_folder_that_is_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BagError, match=r"already exists.*choose another"):
        Recorder(1, "localhost", tmp_path).start()


RECORD = """
import resource, sys, time
from graph.recording import writer
from graph.recording.recorder import Recorder
from pathlib import Path
if sys.argv[3] != "0":
    writer.FLUSH_S = 3600.0  # Else the time, too, decides how much is in a chunk.
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[3]),) * 2)
recorder = Recorder(int(sys.argv[1]), "localhost", Path(sys.argv[2]))
recorder.start()
while not recorder.status.error:
    print(recorder.status.messages, flush=True)
    time.sleep(0.1)
sys.stdin.readline()  # It goes on hearing until it is told that all was said.
print("error", recorder.status.error, recorder.stop().dropped, flush=True)
"""


def recording(domain: int, folder: Path, limit: int = 0) -> subprocess.Popen[str]:
    """A recorder in a process of its own, that may write files of `limit` bytes."""
    return subprocess.Popen(
        [sys.executable, "-c", RECORD, str(domain), str(folder), str(limit)],
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


def test_a_full_disk_leaves_a_whole_bag_and_a_word(ros_domain: int, tmp_path: Path) -> None:
    process = recording(ros_domain, tmp_path / "bag", limit=3_000_000)
    assert process.stdin is not None
    assert process.stdout is not None
    big = String(data="x" * 100_000)
    with Peer(ros_domain) as peer:
        publisher = peer.publisher("/big", String, DEEP)
        wait_until(publisher.get_subscription_count, "the recorder")
        for _ in range(50):
            publisher.publish(big)
        assert publisher.wait_for_all_acked(Duration(seconds=30))
        process.stdin.close()
        lines = list(process.stdout)
    process.stdout.close()
    assert process.wait() == 0
    assert "cannot be written (File too large)" in lines[-1]
    raw = serialize_message(big)
    kept = read_by_mcap(tmp_path / "bag")["/big"]
    assert kept == [raw] * len(kept)
    assert len(kept) >= 20
    assert kept == read_by_rosbags(tmp_path / "bag")["/big"]
    dropped = int(lines[-1].split()[-1])
    assert len(kept) + dropped == 50


def test_before_the_disk_is_full_it_ends_by_itself_with_a_whole_bag(
    ros_domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    free = [600_000_000]
    monkeypatch.setattr(recording_room, "free_bytes", lambda _: free[0])
    recorder = Recorder(ros_domain, "localhost", tmp_path / "bag")
    recorder.start()
    try:
        with Peer(ros_domain) as peer, peer.saying("/text", String(data="still here")):
            recorded(recorder, "/text", 3)
            wait_until(lambda: recorder.status.bytes_per_s > 0, "the rate")
            assert recorder.status.left_s is not None
            free[0] = 499_000_000
            wait_until(lambda: recorder.status.ended, "the end")
    finally:
        status = recorder.stop()
    assert "499 MB are free on the disk of" in status.error
    assert status.dropped == 0
    kept = read_by_mcap(tmp_path / "bag")["/text"]
    (row,) = (row for row in status.topics if row.name == "/text")
    assert len(kept) == row.messages >= 3
    with open_bag(tmp_path / "bag") as bag:
        assert not bag.is_cut


def test_a_recorder_does_not_pass_for_somebody_who_obeys(ros_domain: int, tmp_path: Path) -> None:
    recorder = Recorder(ros_domain, "localhost", tmp_path / "bag")
    watcher = Watcher(ros_domain)
    with Peer(ros_domain) as peer:
        watcher.observer.measure(all_topics=True)
        peer.publisher("/emergency_stop", Bool, LATCHED).publish(Bool(data=True))
        recorder.start()
        recorded(recorder, "/emergency_stop", 1)
        let_updates_come(watcher, 10)
        row = watcher.wait_for("/emergency_stop", lambda row: row.count, "a message")
        assert (row.publishers, row.subscribers) == (1, 0)
        recorder.stop()
    watcher.close()


def test_one_who_begins_anew_makes_no_loss_of_anothers(ros_domain: int, tmp_path: Path) -> None:
    recorder = Recorder(ros_domain, "localhost", tmp_path / "bag")
    with Peer(ros_domain) as peer:
        recorder.start()
        said = 0
        for name, count in (("first", 3), ("second", 5), ("third", 2)):
            with Peer(ros_domain, name) as other:
                for number in range(count):
                    peer.say("/word", String(data=f"peer {number}"))
                    other.say("/word", String(data=f"{name} {number}"))
                said += 2 * count
                # Who goes at once takes along what has not arrived yet.
                recorded(recorder, "/word", said)
        status = recorder.stop()
    assert status.lost == 0


def test_lost_messages_are_counted(
    ros_domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A publisher on a busy machine may be too slow to fill the whole queue between two turns.
    monkeypatch.setattr(recording_tap, "DEEP", 5)
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
