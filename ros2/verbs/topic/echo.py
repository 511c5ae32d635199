"""`ros2 topic echo`: the messages of a topic."""

from __future__ import annotations

import re
import time
from typing import TYPE_CHECKING, Any

from ros2 import filtering, listening, naming, options
from ros2.joining import SPIN_S, joined
from ros2.printing import Shape, to_csv, to_yaml

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

SUMMARY = "Output messages from a topic"
LONGEST = 128


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    add = parser.add_argument
    add("topic_name", help="Name of the ROS topic to listen to (e.g. '/chatter')")
    add("message_type", nargs="?", help="Type of the ROS message (e.g. 'std_msgs/msg/String')")
    options.qos(parser, "subscribe", "sensor_data")
    add(
        "--csv",
        action="store_true",
        help="Output all recursive fields separated by commas (e.g. for plotting). If "
        "--include-message-info is also passed, the following fields are prepended: "
        "source_timestamp, received_timestamp, publication_sequence_number, "
        "reception_sequence_number",
    )
    add(
        "--field",
        metavar="FIELD_NAME",
        help="Echo a selected field of a message. Use '.' to select sub-fields. For example, to "
        "echo the position field of a nav_msgs/msg/Odometry message: "
        "'ros2 topic echo /odom --field pose.pose.position'",
    )
    add(
        "-f",
        "--full-length",
        action="store_true",
        help="Output all elements for arrays, bytes, and string with a length > "
        "'--truncate-length', by default they are truncated after '--truncate-length' elements "
        "with '...''",
    )
    add(
        "--truncate-length",
        "-l",
        type=options.unsigned_int,
        default=LONGEST,
        help=f"The length to truncate arrays, bytes, and string to (default: {LONGEST})",
    )
    add("--no-arr", action="store_true", help="Don't print array fields of messages")
    add("--no-str", action="store_true", help="Don't print string fields of messages")
    add("--flow-style", action="store_true", help="Print collections in the block style")
    add("--lost-messages", action="store_true", help="DEPRECATED: Does nothing")
    add("--no-lost-messages", action="store_true", help="Don't report when a message is lost")
    add("--raw", action="store_true", help="Echo the raw binary representation")
    add(
        "--filter",
        dest="filter_expr",
        help="Python expression to filter messages that are printed. Expression can use Python "
        "builtins as well as m (the message).",
    )
    add("--once", action="store_true", help="Print the first message received and then exit.")
    add("--timeout", metavar="N", type=float, help="Wait for a message up to N seconds")
    add("--include-message-info", action="store_true", help="Shows the associated message info.")
    options.hidden_topics(parser)


def main(args: argparse.Namespace) -> int | str | None:
    """Print them as they come."""
    steps = [] if args.field is None else _steps(args.field)
    with joined(args) as me:
        if args.message_type is not None:
            cls: type[Any] | None = naming.message_class(args.message_type)
        else:
            cls = listening.type_of(me, args.topic_name)
        if cls is None:
            print(f"WARNING: topic [{args.topic_name}] does not appear to be published yet")
            raise RuntimeError("Could not determine the type for the passed topic")
        if options.asks_for_qos(args):
            from rclpy.qos import qos_profile_sensor_data

            qos = options.chosen_qos(args, qos_profile_sensor_data)
        else:
            qos = listening.matching_qos(me, args.topic_name)
        came: list[tuple[Any, Any]] = []

        def hear(message: Any, info: Any) -> None:  # noqa: ANN401 - generated
            came.append((message, info))

        me.node.create_subscription(cls, args.topic_name, hear, qos, raw=args.raw)  # type: ignore[arg-type]
        show = _shower(args, steps)
        end = None if args.timeout is None else time.monotonic() + args.timeout
        while end is None or time.monotonic() < end:
            me.spin_once(SPIN_S)
            for message, info in came:
                if show(message, info) and args.once:
                    return None
                end = None if args.timeout is None else time.monotonic() + args.timeout
            came.clear()
    return None


def _steps(field: str) -> list[str]:
    steps = [step for step in re.split(r"\.|(\[\d+\])", field) if step]
    if not steps:
        raise RuntimeError(f"Invalid field value '{field}'")
    return steps


def _shower(args: argparse.Namespace, steps: list[str]) -> Callable[[Any, Any], bool]:
    longest = None if args.full_length else args.truncate_length
    shape = Shape(longest, not args.no_arr, not args.no_str, args.flow_style)
    wanted = filtering.wanted(args.filter_expr)

    def show(message: Any, info: Any) -> bool:  # noqa: ANN401 - generated
        part = _part(message, steps)
        if not wanted(part):
            return False
        if not hasattr(part, "get_fields_and_field_types"):
            if args.include_message_info:
                print(f"---Got new message, message info:---\n{info}\n---Message data:---")
            print(part, end="\n---\n", flush=True)
        elif args.csv:
            told = [str(each) for each in info.values()] if args.include_message_info else []
            print(",".join([*told, to_csv(part, shape)]), flush=True)
        else:
            if args.include_message_info:
                print("".join(f"{key}: {info[key]}\n" for key in sorted(info)), end="---\n")
            print(to_yaml(part, shape), end="---\n", flush=True)
        return True

    return show


def _part(message: Any, steps: list[str]) -> Any:  # noqa: ANN401 - generated
    part = message
    try:
        for step in steps:
            part = part[int(step[1:-1])] if step.startswith("[") else getattr(part, step)
    except (AttributeError, IndexError, TypeError) as error:
        raise RuntimeError(f"Invalid field '{'.'.join(steps)}': {error}") from error
    return part
