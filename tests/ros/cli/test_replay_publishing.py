"""`deck replay --publish`: a recording onto the graph, and nothing that moves a robot."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import Log
from rosbags.rosbag2 import StoragePlugin, Writer
from std_msgs.msg import Bool, Float32, String

from tests.deck_process import DeckProcess
from tests.middleware_words import own_words
from tests.ros.observing import Peer as ProcessPeer
from tests.ros.peer import Peer
from tests.unit.bags import BEGIN_NS, SECOND_NS, store, write_bag, write_robot_bag
from tests.unit.odd_bags import NUMBERED_QOS, write_mcap, write_metadata
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly


@pytest.fixture(autouse=True)
def _domain(ros_domain: int) -> int:
    return ros_domain


def write_drive(folder: Path, seconds: int) -> Path:
    """A bag of a robot that drives: /drive, /ai_command, /emergency_stop and a distance."""
    types = store()
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:

        def put(topic: str, kind: str, message: object) -> None:
            channel = writer.add_connection(topic, kind, typestore=types)
            for tenth in range(seconds * 10 + 1):
                at_ns = BEGIN_NS + tenth * SECOND_NS // 10
                writer.write(channel, at_ns, bytes(types.serialize_cdr(message, kind)))

        text, number = types.types["std_msgs/msg/String"], types.types["std_msgs/msg/Float32"]
        header = types.types["std_msgs/msg/Header"]
        time = types.types["builtin_interfaces/msg/Time"]
        twist, vector = (types.types[f"geometry_msgs/msg/{name}"] for name in ("Twist", "Vector3"))
        stamped = types.types["geometry_msgs/msg/TwistStamped"]
        ahead = twist(linear=vector(x=0.5, y=0.0, z=0.0), angular=vector(x=0.0, y=0.0, z=0.0))
        put("/ai_command", "std_msgs/msg/String", text(data="forward"))
        put("/cmd_vel", "geometry_msgs/msg/Twist", ahead)
        put(
            "/cmd_vel_stamped",
            "geometry_msgs/msg/TwistStamped",
            stamped(header=header(stamp=time(sec=0, nanosec=0), frame_id=""), twist=ahead),
        )
        put(
            "/emergency_stop",
            "std_msgs/msg/Bool",
            types.types["std_msgs/msg/Bool"](data=False),
        )
        put("/sensor/sonar_front", "std_msgs/msg/Float32", number(data=0.25))
    return folder


def test_messages_are_heard_in_their_order_and_latched_ones_too(
    ros_domain: int, tmp_path: Path
) -> None:
    bag = write_bag(tmp_path / "walk", seconds=1.0)
    with Peer(ros_domain) as peer:
        numbers, names = peer.hear("/number", Float32), peer.hear("/map_name", String)
        run = DeckProcess("replay", str(bag), "--publish")
        assert run.finish() == 0
        wait_until(
            lambda: len(numbers) == 11 and len(names) == 1,
            lambda: f"all messages; there are {len(numbers)} and {len(names)}",
        )
    assert [message.data for message in numbers] == [float(count) for count in range(11)]
    assert names[0].data == "kitchen"
    assert f"publishing walk in domain {ros_domain}: 2 topics, 1 s" in run.lines[0]
    assert any(
        line.startswith("not published: /battery: ") and "other_msgs" in line for line in run.lines
    )
    assert run.lines[-1] == "published: 1 s of 1 s · 12 messages"
    assert own_words("\n".join(run.errors)) == ""


NO_SETTINGS = """\
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <participant profile_name="its_own" is_default_profile="true"><rtps/></participant>
</profiles>
"""


def test_nodes_that_answer_late_miss_nothing(ros_domain: int, tmp_path: Path) -> None:
    """Without Deck's settings a node answers a new one with its next announcement, in up to 3 s."""
    bag = write_bag(tmp_path / "walk", seconds=1.0)
    settings = tmp_path / "fastdds.xml"
    settings.write_text(NO_SETTINGS)
    # Half of such nodes answer at once, for one reason or another: seldom are all six in time.
    strangers = [ProcessPeer(f"n{n}", ros_domain, fast_dds=settings) for n in range(6)]
    try:
        for one in strangers:
            one.listen("/number", type_name="std_msgs/msg/Float32")
        run = DeckProcess("replay", str(bag), "--publish")
        assert run.finish() == 0
        for one in strangers:
            wait_until(
                lambda: one.heard.get("/number", []) == [str(float(n)) for n in range(11)],  # noqa: B023
                lambda: f"all messages: {one.name} has {one.heard}",  # noqa: B023
            )
    finally:
        for one in strangers:
            one.close()


def test_what_moves_a_robot_is_left_out_by_default(ros_domain: int, tmp_path: Path) -> None:
    bag = write_drive(tmp_path / "drive", seconds=1)
    with Peer(ros_domain) as peer:
        moving = [peer.hear("/cmd_vel", Twist), peer.hear("/ai_command", String)]
        stops, distances = (
            peer.hear("/emergency_stop", Bool),
            peer.hear("/sensor/sonar_front", Float32),
        )
        run = DeckProcess("replay", str(bag), "--publish")
        assert run.finish() == 0
        wait_until(
            lambda: len(distances) == 11, lambda: f"11 distances; there are {len(distances)}"
        )
        assert [len(heard) for heard in (*moving, stops)] == [0, 0, 0]
    left_out = [line.split(": ")[1] for line in run.lines if line.startswith("not published")]
    assert left_out == ["/ai_command", "/cmd_vel", "/cmd_vel_stamped", "/emergency_stop"]
    assert any("/cmd_vel: moves the robot; --motion publishes it too" in x for x in run.lines)


def test_asked_for_it_moves_and_stops_when_it_is_stopped(ros_domain: int, tmp_path: Path) -> None:
    bag = write_drive(tmp_path / "drive", seconds=60)
    with Peer(ros_domain) as peer:
        moving, stops = peer.hear("/cmd_vel", Twist), peer.hear("/emergency_stop", Bool)
        run = DeckProcess("replay", str(bag), "--publish", "--motion")
        wait_until(lambda: len(moving) > 3, "a command")
        run.signal(signal.SIGINT)
        assert run.finish() == 0
        wait_until(lambda: moving[-1].linear.x == 0.0, "the stop")
        assert {message.linear.x for message in moving[:-1]} == {0.5}
        assert stops == []


def test_a_topic_is_left_to_whoever_publishes_it(ros_domain: int, tmp_path: Path) -> None:
    bag = write_drive(tmp_path / "drive", seconds=60)
    with Peer(ros_domain) as peer, Peer(ros_domain, "late") as late:
        peer.publisher("/sensor/sonar_front", Float32)
        run = DeckProcess("replay", str(bag), "--publish", "--motion")
        run.said("not published: /sensor/sonar_front: /peer publishes it")
        # And so it is with one who comes later.
        run.said(" messages")
        late.publisher("/ai_command", String)
        run.said("not published: /ai_command: /late publishes it")
        run.signal(signal.SIGINT)
        assert run.finish() == 0


def test_logs_are_published_beside_those_of_others(ros_domain: int, tmp_path: Path) -> None:
    bag = write_robot_bag(tmp_path / "drive")
    with Peer(ros_domain) as peer:
        logs = peer.hear("/rosout", Log)
        run = DeckProcess("replay", str(bag), "--publish", "--rate", "10")
        assert run.finish() == 0
        wait_until(lambda: "too near" in {log.msg for log in logs}, "the recorded log")


def test_a_name_that_is_none_of_a_topic_is_left_out_and_told(tmp_path: Path) -> None:
    types, kind = store(), "std_msgs/msg/Float32"
    with Writer(tmp_path / "odd", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        for topic in ("/number", "camera-2", "/two words"):
            raw = types.serialize_cdr(types.types[kind](data=1.0), kind)
            writer.write(writer.add_connection(topic, kind, typestore=types), BEGIN_NS, bytes(raw))
    run = DeckProcess("replay", str(tmp_path / "odd"), "--publish")
    assert run.finish() == 0
    assert [line for line in run.lines if line.startswith("not published")] == [
        "not published: /camera-2: not a valid name of a ROS topic",
        "not published: /two words: not a valid name of a ROS topic",
    ]
    assert run.lines[-1] == "published: 0 s of 0 s · 1 message"


def test_what_is_damaged_is_told_at_the_end(tmp_path: Path) -> None:
    file = write_bag(tmp_path / "walk", seconds=1.0) / "walk.mcap"
    wrong = bytearray(file.read_bytes())
    place = wrong.index(b"kitchen")
    wrong[place : place + 200] = b"\xff" * 200
    file.write_bytes(wrong)
    run = DeckProcess("replay", str(tmp_path / "walk"), "--publish")
    assert run.finish() == 1
    assert any("walk is damaged: messages lost: 13, " in line for line in run.lines)


def test_qos_that_the_metadata_have_otherwise_costs_no_message(
    ros_domain: int, tmp_path: Path
) -> None:
    reliable = NUMBERED_QOS.replace("reliability: 2", "reliability: 1")
    write_mcap(tmp_path / "walk" / "walk_0.mcap", qos=reliable)
    write_metadata(tmp_path / "walk", ["walk_0.mcap"])
    with Peer(ros_domain) as peer:
        heard = peer.hear("/chatter", String)
        run = DeckProcess("replay", str(tmp_path / "walk"), "--publish")
        assert run.finish() == 0
        wait_until(lambda: len(heard) == 20, lambda: f"20 texts; there are {len(heard)}")
    assert run.lines[-1] == "published: 1 s of 1 s · 20 messages"


def test_what_is_missing_is_told_and_the_exit_code_says_so(tmp_path: Path) -> None:
    write_mcap(tmp_path / "walk" / "walk_0.mcap", foreign=("json", "Log", "jsonschema"))
    write_metadata(tmp_path / "walk", ["walk_0.mcap", "walk_1.mcap"], 40)
    run = DeckProcess("replay", str(tmp_path / "walk"), "--publish")
    assert run.finish() == 1
    assert run.lines[1:4] == [
        "metadata.yaml names walk_1.mcap, which is not there",
        "metadata.yaml counts 40 messages, the files hold 20: /chatter 40 → 20",
        "left out, since their serialization format is not ROS 2's: /extra (json: 20)",
    ]
    assert run.lines[-1] == "published: 1 s of 1 s · 20 messages"


def test_with_nothing_left_to_publish_it_fails(tmp_path: Path, ros_domain: int) -> None:
    bag = write_drive(tmp_path / "drive", seconds=1)
    with Peer(ros_domain) as peer:
        peer.publisher("/sensor/sonar_front", Float32)
        run = DeckProcess("replay", str(bag), "--publish")
        assert run.finish() == 1
    assert "nothing is left to publish" in run.errors[-1]


def test_a_topic_recorded_without_its_slash_is_published_as_ros_resolves_it(
    ros_domain: int, tmp_path: Path
) -> None:
    write_mcap(tmp_path / "walk_0.mcap", topic="chatter")
    with Peer(ros_domain) as peer:
        heard = peer.hear("/chatter", String)
        run = DeckProcess("replay", str(tmp_path), "--publish", "--rate", "10")
        assert run.finish() == 0, run.errors
        wait_until(lambda: len(heard) == 20, "all messages")


@pytest.mark.parametrize(
    ("topic", "count", "words"),
    [
        ("camera image", 20, "none of its topics can be published"),
        ("emergency_stop", 20, "none of its topics can be published"),
        ("/chatter", 0, "there are no messages in it"),
    ],
)
def test_a_recording_of_which_nothing_can_be_published_is_refused(
    tmp_path: Path, topic: str, count: int, words: str
) -> None:
    write_mcap(tmp_path / "walk_0.mcap", count, topic=topic)
    run = DeckProcess("replay", str(tmp_path), "--publish")
    assert run.finish() == 2
    assert run.errors[-1] == f"{tmp_path}: {words}"


def test_from_the_middle_and_again(ros_domain: int, tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "walk", seconds=1.0)
    with Peer(ros_domain) as peer:
        numbers, names = peer.hear("/number", Float32), peer.hear("/map_name", String)
        run = DeckProcess(
            "replay", str(bag), "--publish", "--start", "0.8", "--loop", "--rate", "4"
        )
        wait_until(lambda: len(numbers) >= 6, "the second time round")
        run.signal(signal.SIGTERM)
        assert run.finish() == 0
    assert [message.data for message in numbers[:5]] == [8.0, 9.0, 10.0, 0.0, 1.0]
    # It was latched before the middle.
    assert names[0].data == "kitchen"


def test_what_is_no_bag_is_told_with_exit_code_two(tmp_path: Path) -> None:
    run = DeckProcess("replay", str(tmp_path), "--publish")
    assert run.finish() == 2
    assert "is not a bag" in run.errors[0]
