"""`deck record` beside a real publisher, and `deck replay --publish` without what moves a robot."""

from __future__ import annotations

import re
import signal
from pathlib import Path

import pytest
from geometry_msgs.msg import Twist
from rosbags.rosbag2 import StoragePlugin, Writer
from std_msgs.msg import Bool, Float32, String

from tests.deck_process import DeckProcess, deck
from tests.middleware_words import own_words
from tests.ros.peer import Peer
from tests.ros.recorded import read_by_mcap
from tests.unit.bags import BEGIN_NS, SECOND_NS, store, write_bag
from tests.unit.odd_bags import write_mcap
from tests.waiting import wait_until


@pytest.fixture(autouse=True)
def _domain(ros_domain: int) -> int:
    return ros_domain


def publish_until_recorded(peer: Peer, run: DeckProcess, messages: str) -> None:
    """Go on publishing until the command tells of more `messages` than a node alone brings."""
    publisher = peer.publisher("/numbers", Float32)

    def said() -> bool:
        publisher.publish(Float32(data=1.0))
        return any(re.search(messages, line) for line in run.lines)

    wait_until(said, messages)


def test_it_records_until_ctrl_c_and_tells_each_second(ros_domain: int, tmp_path: Path) -> None:
    with Peer(ros_domain) as peer:
        run = DeckProcess("record", "-o", str(tmp_path / "bag"))
        run.said(f"recording domain {ros_domain} into")
        publish_until_recorded(peer, run, r"\d\d messages")
        run.signal(signal.SIGINT)
        assert run.finish() == 0
    assert own_words("\n".join(run.errors)) == ""
    assert any(line.startswith("/numbers") and "std_msgs/msg/Float32" in line for line in run.lines)
    assert run.lines[-1] == f"to see it: deck replay {tmp_path / 'bag'}"
    assert read_by_mcap(tmp_path / "bag")["/numbers"]


def test_when_nothing_came_it_says_so_and_fails(tmp_path: Path) -> None:
    run = deck("record", "-o", str(tmp_path / "bag"), "--for", "0.5")
    assert run.process.returncode == 1
    assert any("nothing was recorded" in line for line in run.lines)


@pytest.mark.parametrize("name", ["/a//b", "/1st", "/a/", "sönar"])
def test_what_is_no_topic_name_is_refused_before_anything_is_recorded(name: str, tmp_path: Path) -> None:
    run = deck("record", name, "-o", str(tmp_path / "bag"))
    assert run.process.returncode == 2
    assert f"'{name}' is not a valid topic name; write it as /sensor/sonar_front" in run.errors[0]
    assert not (tmp_path / "bag").exists()


# ---------------------------------------------------------------- replay


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
        put("/emergency_stop", "std_msgs/msg/Bool", types.types["std_msgs/msg/Bool"](data=False))
        put("/sensor/sonar_front", "std_msgs/msg/Float32", number(data=0.25))
    return folder


def test_messages_are_heard_in_their_order_and_latched_ones_too(ros_domain: int, tmp_path: Path) -> None:
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
    assert any(line.startswith("not published: /battery: ") and "other_msgs" in line for line in run.lines)
    assert run.lines[-1] == "published: 1 s of 1 s · 12 messages"
    assert own_words("\n".join(run.errors)) == ""


def test_what_moves_a_robot_is_left_out_by_default(ros_domain: int, tmp_path: Path) -> None:
    bag = write_drive(tmp_path / "drive", seconds=1)
    with Peer(ros_domain) as peer:
        moving = [peer.hear("/cmd_vel", Twist), peer.hear("/ai_command", String)]
        stops, distances = (peer.hear("/emergency_stop", Bool), peer.hear("/sensor/sonar_front", Float32))
        run = DeckProcess("replay", str(bag), "--publish")
        assert run.finish() == 0
        wait_until(lambda: len(distances) == 11, lambda: f"11 distances; there are {len(distances)}")
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


def test_from_the_middle_and_again(ros_domain: int, tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "walk", seconds=1.0)
    with Peer(ros_domain) as peer:
        numbers, names = peer.hear("/number", Float32), peer.hear("/map_name", String)
        run = DeckProcess("replay", str(bag), "--publish", "--start", "0.8", "--loop", "--rate", "4")
        wait_until(lambda: len(numbers) >= 6, "the second time round")
        run.signal(signal.SIGTERM)
        assert run.finish() == 0
    assert [message.data for message in numbers[:5]] == [8.0, 9.0, 10.0, 0.0, 1.0]
    # It was latched before the middle.
    assert names[0].data == "kitchen"


def test_a_topic_recorded_without_its_slash_is_published_as_ros_resolves_it(ros_domain: int, tmp_path: Path) -> None:
    write_mcap(tmp_path / "walk_0.mcap", topic="chatter")
    with Peer(ros_domain) as peer:
        heard = peer.hear("/chatter", String)
        run = DeckProcess("replay", str(tmp_path), "--publish", "--rate", "10")
        assert run.finish() == 0, run.errors
        wait_until(lambda: len(heard) == 20, "all messages")


def test_a_recording_of_which_nothing_can_be_published_is_refused(tmp_path: Path) -> None:
    for topic, count, words in (
        ("emergency_stop", 20, "none of its topics can be published"),
        ("/chatter", 0, "there are no messages in it"),
    ):
        write_mcap(tmp_path / "walk_0.mcap", count, topic=topic)
        run = DeckProcess("replay", str(tmp_path), "--publish")
        assert run.finish() == 2
        assert run.errors[-1] == f"{tmp_path}: {words}"
