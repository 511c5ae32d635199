"""`ros2 run tf2_ros static_transform_publisher`: says once where a frame is for good."""

from __future__ import annotations

import argparse
import random
import string
import sys

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args
from tf2_ros import StaticTransformBroadcaster

from ros2.ending import log, until_interrupted
from space.transform import quaternion_from_rpy

SPIN_S = 0.2
"""How late a signal may be noticed: the middleware does not wake up for it."""
MOVED, TURNED, ANGLES = ("x", "y", "z"), ("qx", "qy", "qz", "qw"), ("roll", "pitch", "yaw")
FRAMES = ("frame-id", "child-frame-id")
OLD_BY_ANGLES = (*MOVED, *reversed(ANGLES), *FRAMES)
OLD_BY_QUATERNION = (*MOVED, *TURNED, *FRAMES)
LONGEST_OLD = len(OLD_BY_QUATERNION)
ABOUT = """A command line utility for manually sending a static transform: translation in metres, rotation as
roll, pitch and yaw in radians, or as a quaternion; what is not given is that of the identity."""


def main(argv: list[str]) -> int:
    """Publish until interrupted; return the exit code."""
    found = read(remove_ros_args(argv)[1:])
    with until_interrupted():
        _publish(found, argv)
    return 0


def _publish(found: TransformStamped, argv: list[str]) -> None:
    rclpy.init(args=argv, signal_handler_options=SignalHandlerOptions.NO)
    # As the real one: several can run at a time.
    unique = "".join(random.choices(string.ascii_letters, k=16))
    node = rclpy.create_node(f"static_transform_publisher_{unique}")
    try:
        found.header.stamp = node.get_clock().now().to_msg()
        broadcaster = StaticTransformBroadcaster(node)
        broadcaster.sendTransform(found)
        node.get_logger().info(_words(found))
        while True:
            rclpy.spin_once(node, timeout_sec=SPIN_S)
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def read(words: list[str]) -> TransformStamped:
    """Return the transform that a command line of either style means; SystemExit if it makes no sense."""
    parser = argparse.ArgumentParser(prog="static_transform_publisher", description=ABOUT, allow_abbrev=False)
    if len(words) in {len(OLD_BY_ANGLES), LONGEST_OLD} and not any(word.startswith("--") for word in words):
        log("", "Old-style arguments are deprecated; see --help for new-style arguments", "WARN")
        style = OLD_BY_ANGLES if len(words) < LONGEST_OLD else OLD_BY_QUATERNION
        words = [part for name, word in zip(style, words, strict=True) for part in (f"--{name}", word)]
    for name in (*MOVED, *TURNED, *ANGLES):
        parser.add_argument(f"--{name}", type=float)
    for name in FRAMES:
        parser.add_argument(f"--{name}", required=True)
    given = vars(parser.parse_args(_joined(words)))
    angles, quaternion = ([given[name] for name in names] for names in (ANGLES, TURNED))
    if any(each is not None for each in angles) and any(each is not None for each in quaternion):
        parser.error("Cannot specify both quaternion and Euler rotations")
    found = TransformStamped()
    found.header.frame_id, found.child_frame_id = given["frame_id"], given["child_frame_id"]
    if not (found.header.frame_id and found.child_frame_id):
        parser.error("Frame id must not be empty")
    moved, turned = found.transform.translation, found.transform.rotation
    moved.x, moved.y, moved.z = (given[name] or 0.0 for name in MOVED)
    turned.x, turned.y, turned.z = (each or 0.0 for each in quaternion[:3])
    turned.w = 1.0 if quaternion[3] is None else quaternion[3]
    if any(each is not None for each in angles):
        turned.x, turned.y, turned.z, turned.w = quaternion_from_rpy(*(each or 0.0 for each in angles))
    return found


def _joined(words: list[str]) -> list[str]:
    """Return each option with its value in one word: argparse takes `-1e-3` and a frame `-a` for options."""
    rest = iter(words)
    return [f"{word}={next(rest, '')}" if word.startswith("--") and "=" not in word and word != "--help" else word
            for word in rest]  # fmt: skip


def _words(found: TransformStamped) -> str:
    moved, turned = found.transform.translation, found.transform.rotation
    return (
        "Spinning until stopped - publishing transform\n"
        f"translation: ('{moved.x:f}', '{moved.y:f}', '{moved.z:f}')\n"
        f"rotation: ('{turned.x:f}', '{turned.y:f}', '{turned.z:f}', '{turned.w:f}')\n"
        f"from '{found.header.frame_id}' to '{found.child_frame_id}'"
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv))
