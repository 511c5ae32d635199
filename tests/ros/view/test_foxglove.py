"""`deck foxglove` and a client that speaks Foxglove's WebSocket protocol.

Source: https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md
"""

from __future__ import annotations

import json
import signal
import struct
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

import psutil
import pytest
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Float32, String
from websockets.sync.client import connect
from websockets.sync.connection import Connection
from websockets.typing import Subprotocol

from tests.deck_process import DeckProcess
from tests.ros.peer import LATCHED, Peer
from tests.ros.view.conftest import CAMERA
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.nightly

PROTOCOL = Subprotocol("foxglove.sdk.v1")
ANSWER_S = 20.0
UNKNOWN = "Unknown channel ID"
DATA = struct.Struct("<BIQ")
"""Opcode, number of the subscription, time in nanoseconds."""


@pytest.fixture
def served(ros_domain: int) -> Iterator[DeckProcess]:
    """The server in the test's own domain."""
    with ExitStack() as stack:
        process = DeckProcess("foxglove", "--domain", str(ros_domain), "--lang", "en")
        stack.callback(process.close)
        process.said("for Foxglove: ")
        yield process


def url_of(served: DeckProcess) -> str:
    line = served.said("for Foxglove: ")
    return line.partition("for Foxglove: ")[2].partition(";")[0]


class Client:
    """One client, who knows what is advertised."""

    def __init__(self, line: Connection) -> None:
        self.line = line
        self.info: dict[str, Any] = {}
        self.channels: dict[str, dict[str, Any]] = {}
        self.data: list[tuple[int, bytes]] = []
        self.said: list[dict[str, Any]] = []
        self.wanted: dict[int, str] = {}

    def hear(self) -> None:
        """Take one message of the server's."""
        message = self.line.recv(timeout=ANSWER_S)
        if isinstance(message, bytes):
            _opcode, number, _stamp = DATA.unpack_from(message)
            self.data.append((number, message[DATA.size :]))
            return
        told = json.loads(message)
        self.said.append(told)
        if told["op"] == "serverInfo":
            self.info = told
        if told["op"] == "advertise":
            self.channels |= {channel["topic"]: channel for channel in told["channels"]}
        if UNKNOWN in told.get("message", ""):
            # It announces a channel a little before it knows it.
            for number, topic in self.wanted.items():
                self.subscribe(number, topic)

    def until_advertised(self, topic: str) -> dict[str, Any]:
        """Wait until a topic has a channel."""
        while topic not in self.channels:
            self.hear()
        return self.channels[topic]

    def subscribe(self, number: int, topic: str) -> None:
        """Begin to listen to a topic that is advertised."""
        self.wanted[number] = topic
        wanted = {"id": number, "channelId": self.channels[topic]["id"]}
        self.line.send(json.dumps({"op": "subscribe", "subscriptions": [wanted]}))

    def until_heard(self, number: int) -> bytes:
        """Wait for a message; return it as it was published."""
        while True:
            found = [raw for one, raw in self.data if one == number]
            if found:
                return found[-1]
            self.hear()


@pytest.fixture
def client(served: DeckProcess) -> Iterator[Client]:
    with connect(url_of(served), subprotocols=[PROTOCOL], max_size=None) as line:
        yield Client(line)


def test_messages_arrive_as_they_were_published(client: Client, peer: Peer) -> None:
    peer.publisher("/distance", Float32)
    channel = client.until_advertised("/distance")
    assert channel["encoding"] == "cdr"
    assert (channel["schemaName"], channel["schemaEncoding"]) == ("std_msgs/msg/Float32", "ros2msg")
    assert "float32 data" in channel["schema"]
    client.subscribe(7, "/distance")
    with peer.saying("/distance", Float32(data=1.25)):
        raw = client.until_heard(7)
    assert deserialize_message(raw, Float32).data == 1.25


def test_a_client_that_comes_late_hears_what_is_latched(served: DeckProcess, peer: Peer) -> None:
    publisher = peer.publisher("/robot_description", String, LATCHED)
    publisher.publish(String(data="<robot/>"))
    for _ in range(2):
        with connect(url_of(served), subprotocols=[PROTOCOL], max_size=None) as line:
            client = Client(line)
            client.until_advertised("/robot_description")
            client.subscribe(1, "/robot_description")
            raw = client.until_heard(1)
        assert deserialize_message(raw, String).data == "<robot/>"


def test_a_camera_is_subscribed_to_only_while_a_client_listens(client: Client, peer: Peer) -> None:
    """Also what Deck's own relay offers of it, which is small, and hidden elsewhere."""
    small = f"{CAMERA}/_deck/compressed"
    cameras = [peer.publisher(CAMERA, Image), peer.publisher(small, CompressedImage)]
    told = peer.publisher("/told", String)
    for topic in (CAMERA, small, "/told"):
        client.until_advertised(topic)
    wait_until(lambda: told.get_subscription_count() == 1, "what is light is heard", 30)
    assert [one.get_subscription_count() for one in cameras] == [0, 0]
    client.subscribe(3, small)
    with peer.saying(small, CompressedImage(format="jpeg")):
        assert deserialize_message(client.until_heard(3), CompressedImage).format == "jpeg"
    assert cameras[0].get_subscription_count() == 0
    client.line.send(json.dumps({"op": "unsubscribe", "subscriptionIds": [3]}))
    wait_until(lambda: cameras[1].get_subscription_count() == 0, "nobody listens any more", 30)


def test_no_client_can_publish(client: Client, peer: Peer) -> None:
    heard = peer.hear("/drive", String)
    peer.publisher("/drive_was_asked", String)
    client.until_advertised("/drive_was_asked")
    assert client.info["capabilities"] == []
    channel = {"id": 1, "topic": "/drive", "encoding": "cdr", "schemaName": "std_msgs/msg/String"}
    client.line.send(json.dumps({"op": "advertise", "channels": [channel]}))
    client.line.send(b"\x01" + struct.pack("<I", 1) + b"\x00\x01\x00\x00\x02\x00\x00\x00a\x00")
    while not any(one["op"] == "status" for one in client.said):
        client.hear()
    refused = next(one for one in client.said if one["op"] == "status")
    assert refused["level"] == 2
    assert peer.node.count_publishers("/drive") == 0
    assert heard == []


def test_it_listens_on_this_machine_only_and_ends_by_ctrl_c(served: DeckProcess) -> None:
    found = psutil.Process(served.process.pid).net_connections("tcp")
    assert {one.laddr.ip for one in found if one.status == psutil.CONN_LISTEN} == {"127.0.0.1"}
    served.signal(signal.SIGINT)
    assert served.finish() == 0
