"""A lidar in a room: `python -m bench.space.load DOMAIN`.

It publishes a PointCloud2 of 300 000 points at 10 Hz until stdin is closed: floor, walls and
furniture with the noise of a sensor, and somebody who walks about. Messages are serialized in
advance, and each differs from the one before.
"""

from __future__ import annotations

import sys

import numpy as np
from numpy.typing import NDArray
from rclpy.context import Context
from rclpy.node import Node
from rclpy.serialization import serialize_message
from sensor_msgs.msg import PointCloud2, PointField

from bench.heavy_load import publish
from bench.processes import watch_stdin

TOPIC, HZ = "/lidar/points", 10.0
POINTS, WALKER = 300_000, 10_000
POINT_BYTES = 16
ROOM_M = (4.0, 3.0, 1.3)
"""Half of its length and width, and its height about the lidar."""
NOISE_M = 0.01
MESSAGES = 12


def room(rng: np.random.Generator) -> NDArray[np.float64]:
    """Return points on floor, walls and some boxes."""
    count = POINTS - WALKER
    points = rng.uniform(-1, 1, (count, 3)) * ROOM_M
    side = rng.integers(0, 5, count)
    points[side == 0, 2] = -ROOM_M[2] / 2
    for number, axis in ((1, 0), (2, 1)):
        chosen = side == number
        points[chosen, axis] = np.sign(points[chosen, axis]) * ROOM_M[axis]
    for number, middle in ((3, (2.0, 1.0, -0.4)), (4, (-2.0, -1.2, -0.3))):
        chosen = np.flatnonzero(side == number)
        box = rng.uniform(-0.4, 0.4, (len(chosen), 3))
        edge = rng.integers(0, 3, len(chosen))
        box[np.arange(len(chosen)), edge] = rng.choice([-0.4, 0.4], len(chosen))
        points[chosen] = box + middle
    return points


def messages() -> list[bytes]:
    """Return the room at several times, serialized."""
    rng = np.random.default_rng(1)
    still = room(rng)
    found = []
    for number in range(MESSAGES):
        turn = 2 * np.pi * number / MESSAGES
        walker = rng.normal(0, 1, (WALKER, 3)) * (0.1, 0.1, 0.35)
        walker += (1.2 * np.cos(turn), 1.2 * np.sin(turn), 0.0)
        points = np.concatenate([still, walker]) + rng.normal(0, NOISE_M, (POINTS, 3))
        columns = np.column_stack([points, rng.uniform(0, 255, POINTS)]).astype(np.float32)
        columns[:, 3] = 60 * (points[:, 2] + 1)
        made = PointCloud2(height=1, width=POINTS, point_step=POINT_BYTES, is_dense=True)
        made.fields = [
            PointField(name=name, offset=4 * place, datatype=PointField.FLOAT32, count=1)
            for place, name in enumerate(("x", "y", "z", "intensity"))
        ]
        made.header.frame_id = "lidar"
        made.row_step = POINTS * POINT_BYTES
        made.data.frombytes(columns.tobytes())
        found.append(serialize_message(made))
    return found


def main() -> None:
    """Publish until stdin is closed."""
    context = Context()
    context.init(args=[], domain_id=int(sys.argv[1]))
    node = Node("lidar", context=context, enable_rosout=False, start_parameter_services=False)
    line = (node.create_publisher(PointCloud2, TOPIC, 3), messages())
    ended = watch_stdin()
    print("ready", flush=True)
    publish([line], HZ, ended)
    node.destroy_node()
    context.try_shutdown()


if __name__ == "__main__":
    main()
