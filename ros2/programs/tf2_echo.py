"""`ros2 run tf2_ros tf2_echo`: prints, again and again, where one frame is in another."""

from __future__ import annotations

import math
import signal
import sys
import time

import rclpy
from geometry_msgs.msg import Transform
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.time import Time
from rclpy.utilities import remove_ros_args
from tf2_ros import Buffer, TransformException, TransformListener

from ros2.ending import until_interrupted
from text.output import harmless_output

FIRST_WITHIN_S = 1.0
SPIN_S = 0.1
WORDS = (2, 3)
USAGE = """\
Usage: tf2_echo source_frame target_frame [echo_rate]

This will echo the transform from the coordinate frame of the source_frame
to the coordinate frame of the target_frame.
Note: This is the transform to get data from target_frame into the source_frame.
Default echo rate is 1 if echo_rate is not given."""


def main(argv: list[str]) -> int:
    """Print until interrupted; return the exit code."""
    # As in `tf2_echo a b | head`: it ends with its reader.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    words = remove_ros_args(argv)[1:]
    rate = _rate(words)
    if rate is None:
        print(USAGE)
        return 1
    with until_interrupted(), harmless_output():
        rclpy.init(args=argv, signal_handler_options=SignalHandlerOptions.NO)
        node = rclpy.create_node("tf2_echo")
        try:
            _echo(node, words[0], words[1], rate)
        finally:
            node.destroy_node()
            rclpy.try_shutdown()
    return 0


def _rate(words: list[str]) -> float | None:
    """Return how often a second; None if the command line makes no sense."""
    if len(words) not in WORDS:
        return None
    try:
        rate = float(words[2]) if len(words) == max(WORDS) else 1.0
    except ValueError:
        return None
    return rate if rate > 0 else None


def _echo(node: Node, source: str, target: str, rate: float) -> None:
    buffer = Buffer()
    # Kept: it ends with its last reference.
    _listener = TransformListener(buffer, node)
    end = time.monotonic() + FIRST_WITHIN_S
    while not buffer.can_transform(source, target, Time()) and time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=SPIN_S)
    found, why = buffer.can_transform(source, target, Time(), return_debug_tuple=True)
    if not found:
        node.get_logger().info(f"Waiting for transform {source} ->  {target}: {why}")
    due = time.monotonic()
    while True:
        _print(node, buffer, source, target)
        due += 1.0 / rate
        while (left := due - time.monotonic()) > 0:
            rclpy.spin_once(node, timeout_sec=min(left, SPIN_S))


def _print(node: Node, buffer: Buffer, source: str, target: str) -> None:
    try:
        found = buffer.lookup_transform(source, target, Time())
    except TransformException as error:
        now = node.get_clock().now().nanoseconds / 1e9
        frames = buffer.all_frames_as_string()
        print(f"Failure at {now:f}\nException thrown:{error}")
        print(f"The current list of frames is:\n{frames}", flush=True)
        return
    stamp = found.header.stamp
    print(f"At time {stamp.sec}.{stamp.nanosec}\n{described(found.transform)}", flush=True)


def described(transform: Transform) -> str:
    """Return a transform in the lines of the real program."""
    moved, turned = transform.translation, transform.rotation
    matrix = _matrix(turned.x, turned.y, turned.z, turned.w)
    angles = _angles(matrix)
    rows = zip(matrix, (moved.x, moved.y, moved.z), strict=True)
    return "\n".join(
        (
            f"- Translation: {_list(moved.x, moved.y, moved.z)}",
            f"- Rotation: in Quaternion (xyzw) {_list(turned.x, turned.y, turned.z, turned.w)}",
            f"- Rotation: in RPY (radian) {_list(*angles)}",
            f"- Rotation: in RPY (degree) {_list(*map(math.degrees, angles))}",
            "- Matrix:",
            *(_row(*row, end) for row, end in rows),
            _row(0.0, 0.0, 0.0, 1.0),
        )
    )


def _list(*numbers: float) -> str:
    return f"[{', '.join(f'{number:.3f}' for number in numbers)}]"


def _row(*numbers: float) -> str:
    return "".join(f" {number:6.3f}" for number in numbers)


def _matrix(x: float, y: float, z: float, w: float) -> tuple[tuple[float, float, float], ...]:
    double = 2.0 / (x * x + y * y + z * z + w * w)
    return (
        (1 - double * (y * y + z * z), double * (x * y - z * w), double * (x * z + y * w)),
        (double * (x * y + z * w), 1 - double * (x * x + z * z), double * (y * z - x * w)),
        (double * (x * z - y * w), double * (y * z + x * w), 1 - double * (x * x + y * y)),
    )


def _angles(matrix: tuple[tuple[float, float, float], ...]) -> tuple[float, float, float]:
    """Return roll, pitch and yaw in radians."""
    down = min(max(matrix[2][0], -1.0), 1.0)
    if abs(down) == 1.0:
        return math.atan2(-down * matrix[0][1], -down * matrix[0][2]), -math.asin(down), 0.0
    roll = math.atan2(matrix[2][1], matrix[2][2])
    return roll, -math.asin(down), math.atan2(matrix[1][0], matrix[0][0])


if __name__ == "__main__":
    sys.exit(main(sys.argv))
