"""The load of the Topics screen: ten Float32 topics at 50 Hz and one 640x480 image at 30 Hz.

`python -m bench.load DOMAIN` publishes until stdin ends. Messages are serialized once, and late
ones are caught up: the mean rates are exact and the load itself is cheap.
"""

from __future__ import annotations

import heapq
import sys
import threading
import time

from rclpy.context import Context
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Image
from std_msgs.msg import Float32

FLOATS = tuple(f"/load/float_{number}" for number in range(10))
IMAGE = "/load/image"
RATES_HZ = {**dict.fromkeys(FLOATS, 50.0), IMAGE: 30.0}


def image() -> Image:
    """Return a bgr8 picture of 640x480."""
    picture = Image(width=640, height=480, encoding="bgr8", step=3 * 640)
    picture.data.frombytes(bytes(3 * 640 * 480))
    return picture


def publish(publishers: dict[str, tuple[Publisher, bytes]], ended: threading.Event) -> None:
    """Publish each at its rate until the end, the topics out of step with each other."""
    begun_s = time.monotonic()
    due = [(begun_s + 0.0017 * n, topic) for n, topic in enumerate(publishers)]
    heapq.heapify(due)
    while not ended.is_set():
        at_s, topic = due[0]
        wait_s = at_s - time.monotonic()
        if wait_s > 0:
            time.sleep(wait_s)
            continue
        publisher, raw = publishers[topic]
        publisher.publish(raw)
        heapq.heapreplace(due, (at_s + 1 / RATES_HZ[topic], topic))


def main() -> None:
    """Publish until stdin ends."""
    context = Context()
    context.init(args=[], domain_id=int(sys.argv[1]))
    node = Node("load", context=context, enable_rosout=False, start_parameter_services=False)
    messages = {**{topic: Float32(data=1.5) for topic in FLOATS}, IMAGE: image()}
    publishers = {
        topic: (node.create_publisher(type(message), topic, 10), serialize_message(message))
        for topic, message in messages.items()
    }
    ended = threading.Event()
    threading.Thread(target=lambda: (sys.stdin.read(), ended.set()), daemon=True).start()
    print("ready", flush=True)
    publish(publishers, ended)
    node.destroy_node()
    context.try_shutdown()


if __name__ == "__main__":
    main()
