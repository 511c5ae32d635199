"""Two hundred moving frames at 50 Hz: `python -m bench.frames.load DOMAIN one|many`.

It publishes until stdin is closed. `one` is one publisher with all frames in a message, `many` are
twenty publishers with ten each. Delays are made up for, so the mean rates are exact.
"""

from __future__ import annotations

import struct
import sys
import threading
import time
from itertools import count

from geometry_msgs.msg import TransformStamped
from rclpy.context import Context
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.serialization import serialize_message
from tf2_msgs.msg import TFMessage

from bench.processes import watch_stdin

FRAMES = 200
HZ = 50.0
PUBLISHERS = {"one": 1, "many": 20}
STAMP = struct.Struct("<iI")
MARK = (0x5EA1, 0x5EA1)
"""A stamp that is found again in the bytes."""


class FrameMessage:
    """A serialized message, in which only the stamps change."""

    def __init__(self, numbers: range) -> None:
        """Make frames of these numbers, four in a row below `base_link`."""
        transforms = []
        for number in numbers:
            parent = "base_link" if number % 4 == 0 else f"frame_{number - 1:03}"
            made = TransformStamped(child_frame_id=f"frame_{number:03}")
            made.header.frame_id = parent
            made.header.stamp.sec, made.header.stamp.nanosec = MARK
            made.transform.translation.x = 0.01 * number
            transforms.append(made)
        self._bytes = bytearray(serialize_message(TFMessage(transforms=transforms)))
        mark, at = STAMP.pack(*MARK), -1
        self._places = []
        while (at := self._bytes.find(mark, at + 1)) >= 0:
            self._places.append(at)

    def now(self) -> bytes:
        seconds, rest = divmod(time.time_ns(), 10**9)
        for place in self._places:
            STAMP.pack_into(self._bytes, place, seconds, rest)
        return bytes(self._bytes)


def publish(lines: list[tuple[Publisher, FrameMessage]], ended: threading.Event) -> None:
    """Publish all lines at `HZ`, evenly spread."""
    per_s, begun_s = HZ * len(lines), time.monotonic()
    for number in count():
        while (wait_s := begun_s + number / per_s - time.monotonic()) > 0:
            time.sleep(wait_s)
        if ended.is_set():
            return
        publisher, message = lines[number % len(lines)]
        publisher.publish(message.now())


def main() -> None:
    """Publish until stdin is closed."""
    context = Context()
    context.init(args=[], domain_id=int(sys.argv[1]))
    publishers = PUBLISHERS[sys.argv[2]]
    each = FRAMES // publishers
    node = Node("frame_load", context=context, enable_rosout=False, start_parameter_services=False)
    lines = [
        (node.create_publisher(TFMessage, "/tf", 100), FrameMessage(range(each * number, each * (number + 1))))
        for number in range(publishers)
    ]
    ended = watch_stdin()
    print("ready", flush=True)
    publish(lines, ended)
    node.destroy_node()
    context.try_shutdown()


if __name__ == "__main__":
    main()
