"""The load of the Topics screen: ten Float32 topics at 50 Hz and one 640x480 image at 30 Hz.

`python -m bench.load DOMAIN` publishes until stdin is closed. No message equals the previous one; a
few serialized messages are sent in turn, and delays are made up for, so the mean rates are exact
and the load itself is cheap.
"""

from __future__ import annotations

import heapq
import sys
import threading
import time
from collections.abc import Iterator
from itertools import cycle

from rclpy.context import Context
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Image
from std_msgs.msg import Float32

from bench.processes import watch_stdin

FLOATS = tuple(f"/load/float_{number}" for number in range(10))
IMAGE = "/load/image"
RATES_HZ = {**dict.fromkeys(FLOATS, 50.0), IMAGE: 30.0}


def image(grey: int) -> Image:
    """Return a bgr8 picture of 640x480."""
    picture = Image(width=640, height=480, encoding="bgr8", step=3 * 640)
    picture.data.frombytes(bytes([grey]) * (3 * 640 * 480))
    return picture


def publish(publishers: dict[str, tuple[Publisher, Iterator[bytes]]], ended: threading.Event) -> None:
    """Publish each topic at its rate until the end, with different phases."""
    begun_s = time.monotonic()
    due = [(begun_s + 0.0017 * n, topic) for n, topic in enumerate(publishers)]
    heapq.heapify(due)
    while not ended.is_set():
        at_s, topic = due[0]
        wait_s = at_s - time.monotonic()
        if wait_s > 0:
            time.sleep(wait_s)
            continue
        publisher, messages = publishers[topic]
        publisher.publish(next(messages))
        heapq.heapreplace(due, (at_s + 1 / RATES_HZ[topic], topic))


def main() -> None:
    """Publish until stdin is closed."""
    context = Context()
    context.init(args=[], domain_id=int(sys.argv[1]))
    node = Node("load", context=context, enable_rosout=False, start_parameter_services=False)
    numbers = [serialize_message(Float32(data=0.01 * n)) for n in range(997)]
    pictures = [serialize_message(image(grey)) for grey in range(0, 250, 25)]
    publishers: dict[str, tuple[Publisher, Iterator[bytes]]] = {
        **{topic: (node.create_publisher(Float32, topic, 10), cycle(numbers)) for topic in FLOATS},
        IMAGE: (node.create_publisher(Image, IMAGE, 10), cycle(pictures)),
    }
    ended = watch_stdin()
    print("ready", flush=True)
    publish(publishers, ended)
    node.destroy_node()
    context.try_shutdown()


if __name__ == "__main__":
    main()
