"""A heavier load than a lesson: `python -m bench.heavy_load DOMAIN many|cloud`.

It publishes until stdin is closed. `many` is a hundred Float32 topics at 100 Hz, `cloud` a
PointCloud2 of 5 MB and a number, both at 10 Hz. Messages are serialized in advance, and delays are
made up for, so the mean rates are exact.
"""

from __future__ import annotations

import sys
import threading
import time
from itertools import count

import numpy as np
from rclpy.context import Context
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.serialization import serialize_message
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Float32

from bench.processes import watch_stdin

MANY = tuple(f"/many/float_{number:02}" for number in range(100))
MANY_HZ = 100.0
CLOUD, NUMBER = "/large/cloud", "/large/number"
CLOUD_HZ = 10.0
POINTS = 312_500
POINT_BYTES = 16
"""x, y, z and intensity: 5 000 000 bytes in all."""


def cloud() -> PointCloud2:
    """Return a cloud of random points within ten metres."""
    fields = [
        PointField(name=name, offset=4 * place, datatype=PointField.FLOAT32, count=1)
        for place, name in enumerate(("x", "y", "z", "intensity"))
    ]
    made = PointCloud2(height=1, width=POINTS, fields=fields, point_step=POINT_BYTES, is_dense=True)
    made.header.frame_id = "lidar"
    made.row_step = POINTS * POINT_BYTES
    places = np.random.default_rng(1).uniform(-10, 10, (POINTS, 4)).astype(np.float32)
    made.data.frombytes(places.tobytes())
    return made


def publish(lines: list[tuple[Publisher, list[bytes]]], per_s: float, ended: threading.Event) -> None:
    """Publish the lines in turn, `per_s` messages per second in total."""
    begun_s = time.monotonic()
    for number in count():
        while (wait_s := begun_s + number / per_s - time.monotonic()) > 0:
            time.sleep(wait_s)
        if ended.is_set():
            return
        publisher, messages = lines[number % len(lines)]
        publisher.publish(messages[number // len(lines) % len(messages)])


def main() -> None:
    """Publish until stdin is closed."""
    context = Context()
    context.init(args=[], domain_id=int(sys.argv[1]))
    node = Node("heavy_load", context=context, enable_rosout=False, start_parameter_services=False)
    numbers = [serialize_message(Float32(data=0.01 * n)) for n in range(997)]
    if sys.argv[2] == "many":
        lines = [(node.create_publisher(Float32, topic, 10), numbers) for topic in MANY]
        per_s = MANY_HZ * len(MANY)
    else:
        clouds = node.create_publisher(PointCloud2, CLOUD, 3)
        lines = [(clouds, [serialize_message(cloud())]), (node.create_publisher(Float32, NUMBER, 10), numbers)]
        per_s = CLOUD_HZ * len(lines)
    ended = watch_stdin()
    print("ready", flush=True)
    publish(lines, per_s, ended)
    node.destroy_node()
    context.try_shutdown()


if __name__ == "__main__":
    main()
