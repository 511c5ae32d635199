"""`ros2 run tf2_ros tf2_echo`: prints, again and again, where one frame is in another."""

from __future__ import annotations

import argparse
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
from ros2.verb import positive_float
from space.transform import Transform as Place
from text.output import harmless_output

FIRST_WITHIN_S = 1.0
SPIN_S = 0.1
ABOUT = "Echoes where target_frame is in source_frame: the transform that gets data from the one into the other."


def main(argv: list[str]) -> int:
    """Print until interrupted; return the exit code."""
    # As in `tf2_echo a b | head`: it ends with its reader.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    parser = argparse.ArgumentParser(prog="tf2_echo", description=ABOUT)
    parser.add_argument("source_frame")
    parser.add_argument("target_frame")
    parser.add_argument("echo_rate", type=positive_float, nargs="?", default=1.0, help="how often a second")
    args = parser.parse_args(remove_ros_args(argv)[1:])
    with until_interrupted(), harmless_output():
        rclpy.init(args=argv, signal_handler_options=SignalHandlerOptions.NO)
        node = rclpy.create_node("tf2_echo")
        try:
            _echo(node, args.source_frame, args.target_frame, args.echo_rate)
        finally:
            node.destroy_node()
            rclpy.try_shutdown()
    return 0


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
    place = Place.of((moved.x, moved.y, moved.z), (turned.x, turned.y, turned.z, turned.w))
    rows = ("".join(f" {number:6.3f}" for number in row) for row in place.matrix().tolist())
    return "\n".join(
        (
            f"- Translation: {_list(*place.translation)}",
            f"- Rotation: in Quaternion (xyzw) {_list(turned.x, turned.y, turned.z, turned.w)}",
            f"- Rotation: in RPY (radian) {_list(*place.rpy_rad)}",
            f"- Rotation: in RPY (degree) {_list(*map(math.degrees, place.rpy_rad))}",
            "- Matrix:",
            *rows,
        )
    )


def _list(*numbers: float) -> str:
    return f"[{', '.join(f'{number:.3f}' for number in numbers)}]"


if __name__ == "__main__":
    sys.exit(main(sys.argv))
