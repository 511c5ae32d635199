"""`deck foxglove` and a client that speaks Foxglove's WebSocket protocol.

Source: https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md
"""

from __future__ import annotations

import json
import struct
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

import pytest
from rclpy.serialization import deserialize_message
from std_msgs.msg import Float32
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from tests.deck_process import DeckProcess
from tests.ros.peer import Peer
from tests.slowness import patient

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.nightly

PROTOCOL = Subprotocol("foxglove.sdk.v1")
ANSWER_S = 20.0
DATA = struct.Struct("<BIQ")
"""Opcode, number of the subscription, time in nanoseconds."""


@pytest.fixture
def served(ros_domain: int) -> Iterator[DeckProcess]:
    with ExitStack() as stack:
        process = DeckProcess("foxglove", "--domain", str(ros_domain), "--lang", "en")
        stack.callback(process.close)
        process.said("for Foxglove: ")
        yield process


def url_of(served: DeckProcess) -> str:
    line = served.said("for Foxglove: ")
    return line.partition("for Foxglove: ")[2].partition(";")[0]


def test_messages_arrive_as_they_were_published(served: DeckProcess, peer: Peer) -> None:
    peer.publisher("/distance", Float32)
    channel: dict[str, Any] = {}
    raw = b""
    with (
        connect(url_of(served), subprotocols=[PROTOCOL], max_size=None) as line,
        peer.saying("/distance", Float32(data=1.25)),
    ):
        while not raw:
            message = line.recv(timeout=patient(ANSWER_S))
            if isinstance(message, bytes):
                raw = message[DATA.size :]
                continue
            told = json.loads(message)
            if told["op"] == "advertise":
                known = {one["topic"]: one for one in told["channels"]}
                channel = known.get("/distance", channel)
            if channel:
                # Again and again: it announces a channel a little before it knows it.
                wanted = {"id": 7, "channelId": channel["id"]}
                line.send(json.dumps({"op": "subscribe", "subscriptions": [wanted]}))
    assert channel["encoding"] == "cdr"
    assert (channel["schemaName"], channel["schemaEncoding"]) == ("std_msgs/msg/Float32", "ros2msg")
    assert "float32 data" in channel["schema"]
    assert deserialize_message(raw, Float32).data == 1.25
