"""`ros2 run tf2_ros static_transform_publisher`: says once where a frame is for good."""

from __future__ import annotations

import random
import string
import sys

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args
from tf2_ros import StaticTransformBroadcaster

from ros2.ending import until_interrupted
from ros2.log_lines import log
from space.transform import quaternion_from_rpy

SPIN_S = 0.2
"""How late a signal may be noticed: the middleware does not wake up for it."""
NUMBERS = ("x", "y", "z", "qx", "qy", "qz", "qw", "roll", "pitch", "yaw")
MOVED, TURNED, ANGLES = NUMBERS[:3], NUMBERS[3:7], NUMBERS[7:]
FRAMES = ("frame-id", "child-frame-id")
OLD_BY_ANGLES = ("x", "y", "z", "yaw", "pitch", "roll", *FRAMES)
OLD_BY_QUATERNION = ("x", "y", "z", "qx", "qy", "qz", "qw", *FRAMES)
USAGE = """\
usage: static_transform_publisher [--x X] [--y Y] [--z Z] [--qx QX] [--qy QY] [--qz QZ] [--qw QW] \
[--roll ROLL] [--pitch PITCH] [--yaw YAW] --frame-id FRAME_ID --child-frame-id CHILD_FRAME_ID

A command line utility for manually sending a static transform.

If no translation or orientation is provided, the identity transform will be published.

The translation offsets are in meters.

The rotation may be provided with roll, pitch, yaw euler angles in radians, or as a quaternion.

required arguments:
  --frame-id FRAME_ID parent frame
  --child-frame-id CHILD_FRAME_ID child frame id

optional arguments:
  --x X                 x component of translation
  --y Y                 y component of translation
  --z Z                 z component of translation
  --qx QX               x component of quaternion rotation
  --qy QY               y component of quaternion rotation
  --qz QZ               z component of quaternion rotation
  --qw QW               w component of quaternion rotation
  --roll ROLL           roll component Euler rotation
  --pitch PITCH         pitch component Euler rotation
  --yaw YAW             yaw component Euler rotation"""


class ArgumentsError(Exception):
    """The command line makes no sense; the text says why, in the real program's words."""


def main(argv: list[str]) -> int:
    """Publish until interrupted; return the exit code."""
    words = remove_ros_args(argv)[1:]
    if "--help" in words or "-h" in words:
        print(USAGE)
        return 0
    try:
        found = read(words)
    except ArgumentsError as error:
        log("", f"error parsing command line arguments: {error}", "ERROR")
        print(USAGE)
        return 1
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
    """Return the transform that a command line of either style means; raises ArgumentsError."""
    given, others = _options(words)
    if {*ANGLES} & given.keys() and {*TURNED} & given.keys():
        raise ArgumentsError("Cannot specify both quaternion and Euler rotations")
    if len(others) in (len(OLD_BY_ANGLES), len(OLD_BY_QUATERNION)):
        log("", "Old-style arguments are deprecated; see --help for new-style arguments", "WARN")
        if {*MOVED, *TURNED, *FRAMES} & given.keys():
            raise ArgumentsError("Cannot specify both new-style (flags) and old-style (arguments)")
        style = OLD_BY_ANGLES if len(others) == len(OLD_BY_ANGLES) else OLD_BY_QUATERNION
        given = dict(zip(style, others, strict=True))
    elif others:
        raise ArgumentsError("Extra unparsed arguments on command-line")
    return _transform(given)


def _options(words: list[str]) -> tuple[dict[str, str], list[str]]:
    given: dict[str, str] = {}
    others = []
    rest = iter(words)
    for word in rest:
        name = word.removeprefix("--")
        if word == name or name not in (*NUMBERS, *FRAMES):
            others.append(word)
        else:
            value = next(rest, None)
            if value is None:
                raise ArgumentsError(f"Not enough arguments for {word}")
            if name in NUMBERS:
                _number(word, value)
            given[name] = value
    return given, others


def _number(name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise ArgumentsError(f"Failed to parse {name} argument as float") from error


def _transform(given: dict[str, str]) -> TransformStamped:
    for name, words in zip(FRAMES, ("Frame id", "Child frame id"), strict=True):
        if not given.get(name):
            raise ArgumentsError(f"{words} must not be empty")
    number = {name: _number(name, given[name]) for name in NUMBERS if name in given}
    found = TransformStamped()
    found.header.frame_id, found.child_frame_id = (given[name] for name in FRAMES)
    moved, turned = found.transform.translation, found.transform.rotation
    moved.x, moved.y, moved.z = (number.get(name, 0.0) for name in MOVED)
    if {*ANGLES} & number.keys():
        angles = (number.get(name, 0.0) for name in ANGLES)
        turned.x, turned.y, turned.z, turned.w = quaternion_from_rpy(*angles)
    else:
        turned.x, turned.y, turned.z = (number.get(name, 0.0) for name in TURNED[:3])
        turned.w = number.get("qw", 1.0)
    return found


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
