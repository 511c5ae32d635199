"""`ros2 topic pub`: publishes a message, once or at a rate."""

from __future__ import annotations

import argparse
import sys
import time
from typing import TYPE_CHECKING, Any

from ros2 import naming, options
from ros2.filling import filled, read
from ros2.joining import joined
from text.ros_names import EMERGENCY_STOP

if TYPE_CHECKING:
    from rclpy.publisher import Publisher

    from ros2.joining import Guest

SUMMARY = "Publish a message to a topic"
LOOK_S = 0.1
LOOKS_A_LINE = 10
FOR_ALL = EMERGENCY_STOP
"""Goes out as soon as one listens, and once more when all who listen are found, up to 3 s later."""
ARRIVES_S = 1.0
"""So long is waited for those who have not confirmed it."""


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_node(parser)
    add = parser.add_argument
    add("topic_name", help="Name of the ROS topic to publish to (e.g. '/chatter')")
    add("message_type", help="Type of the ROS message (e.g. 'std_msgs/String')")
    values = parser.add_mutually_exclusive_group()
    values.add_argument(
        "values",
        nargs="?",
        default="{}",
        help="Values to fill the message with in YAML format (e.g. 'data: Hello World'), "
        "otherwise the message will be published with default values",
    )
    values.add_argument("--stdin", action="store_true", help="Read values from standard input")
    add(
        "-r",
        "--rate",
        metavar="N",
        type=options.positive_float,
        default=1.0,
        help="Publishing rate in Hz (default: 1)",
    )
    add(
        "-p", "--print", metavar="N", type=int, default=1, help="Only print every N-th published message (default: 1)"
    )
    times = parser.add_mutually_exclusive_group()
    times.add_argument("-1", "--once", action="store_true", help="Publish one message and exit")
    times.add_argument(
        "-t", "--times", type=options.unsigned_int, default=0, help="Publish this number of times and then exit"
    )
    add(
        "-w",
        "--wait-matching-subscriptions",
        type=options.unsigned_int,
        default=None,
        help="Wait until finding the specified number of matching subscriptions. Defaults to 1 "
        "when using '-1'/'--once'/'--times', otherwise defaults to 0.",
    )
    add(
        "--max-wait-time-secs",
        type=options.positive_float,
        default=None,
        help="This sets the maximum wait time in seconds if --wait-matching-subscriptions is set.",
    )
    add(
        "--keep-alive",
        metavar="N",
        type=options.positive_float,
        default=0.1,
        help="Keep publishing node alive for N seconds after the last msg (default: 0.1)",
    )
    add("-n", "--node-name", default="", help="Name of the created publishing node")
    options.qos(parser, "publish", "default")
    options.hidden_topics(parser)


def main(args: argparse.Namespace) -> int | str | None:
    """Publish until told to stop, or as often as asked."""
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    kind = naming.message_class(args.message_type)
    values = read(sys.stdin.read() if args.stdin else args.values)
    if values is None:
        return "The passed value needs to be a dictionary in YAML format"
    draft = filled(kind, values)
    default = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    times, arrives = 1 if args.once else args.times, Duration(seconds=ARRIVES_S)
    with joined(args, args.node_name) as me:
        publisher = me.node.create_publisher(kind, args.topic_name, options.chosen_qos(args, default))
        if trouble := _await_subscriptions(args, publisher, times):
            return trouble
        print("publisher: beginning loop", flush=True)
        due, count = time.monotonic(), 0
        while True:
            count += 1
            message = draft.dated(me.node.get_clock().now().nanoseconds)
            if args.print and count % args.print == 0:
                print(f"publishing #{count}: {message!r}\n", flush=True)
            reached = publisher.get_subscription_count()
            publisher.publish(message)
            if times and count >= times:
                break
            if times and count == 1:
                # Who has been found may not have found this publisher yet.
                publisher.wait_for_all_acked(arrives)
            due += 1 / args.rate
            while (left := due - time.monotonic()) > 0:
                me.spin_once(min(left, LOOK_S))
        if publisher.topic_name == FOR_ALL:
            _reach_the_rest(me, publisher, message, reached)
        publisher.wait_for_all_acked(arrives)
        time.sleep(args.keep_alive)
    return None


def _reach_the_rest(me: Guest, publisher: Publisher, message: Any, reached: int) -> None:  # noqa: ANN401 - any type of message
    """Publish it again for those who were not found yet."""
    me.settle()
    if publisher.get_subscription_count() > reached:
        publisher.publish(message)


def _await_subscriptions(args: argparse.Namespace, publisher: Publisher, times: int) -> str:
    wanted = args.wait_matching_subscriptions
    if wanted is None:
        wanted = 1 if times else 0
    start, looks = time.monotonic(), 0
    while (found := publisher.get_subscription_count()) < wanted:
        waited = time.monotonic() - start
        if args.max_wait_time_secs is not None and waited >= args.max_wait_time_secs:
            return f"Timed out waiting for subscribers: Expected {wanted} subcribers but only got {found} subscribers"
        if looks % LOOKS_A_LINE == 0:
            print(f"Waiting for at least {wanted} matching subscription(s)...", flush=True)
        looks += 1
        time.sleep(LOOK_S)
    return ""
