"""10 MB/s for a recorder: one topic with messages of 80 kB and ten with 2 kB, all at 100 Hz.

For each line on stdin, `python -m bench.recorders.load DOMAIN` waits until every topic has a
subscriber, publishes for ten seconds, and answers with the number of messages.
"""

from __future__ import annotations

import sys
import time

from rclpy.context import Context
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from std_msgs.msg import UInt8MultiArray

LARGE = "/load/large"
SIZES = {LARGE: 80_000, **{f"/load/small_{number}": 2_000 for number in range(10)}}
"""Topic to the size of its messages in bytes."""
HZ = 100
SECONDS = 10


def main() -> None:
    """Publish until stdin is closed."""
    context = Context()
    context.init(args=[], domain_id=int(sys.argv[1]))
    node = Node("load", context=context, enable_rosout=False, start_parameter_services=False)
    publishers = [
        (
            node.create_publisher(UInt8MultiArray, topic, QoSProfile(depth=200)),
            serialize_message(UInt8MultiArray(data=bytes(size))),
        )
        for topic, size in SIZES.items()
    ]
    print("ready", flush=True)
    for _line in sys.stdin:
        while not all(publisher.get_subscription_count() for publisher, _raw in publishers):
            time.sleep(0.05)
        begun_s = time.monotonic()
        for turn in range(HZ * SECONDS):
            time.sleep(max(0.0, begun_s + turn / HZ - time.monotonic()))
            for publisher, raw in publishers:
                publisher.publish(raw)
        print(HZ * SECONDS * len(publishers), flush=True)
    node.destroy_node()
    context.try_shutdown()


if __name__ == "__main__":
    main()
