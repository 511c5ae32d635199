"""`ros2 topic`: lists, messages, rates, and publishing."""

from __future__ import annotations

import re
import time
from collections import deque
from functools import partial
from statistics import fmean, pstdev
from typing import TYPE_CHECKING, Any

from graph.qos import BEST_EFFORT, Qos, profile, to_hear
from graph.scan import publishers
from ros2 import naming
from ros2.joining import NETWORK_S, SPIN_S, joined
from ros2.messages import filled, load, read, to_yaml, wanted
from ros2.verb import OF_GRAPH, QOS, TYPES, arg, chosen_qos, flag, hidden, positive_float, positive_int, verb
from text.plain import plain
from text.ros_names import EMERGENCY_STOP

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    from rclpy.publisher import Publisher
    from rclpy.qos import QoSProfile
    from rclpy.topic_endpoint_info import TopicEndpointInfo

    from ros2.joining import Guest

AGAIN_S = 0.1
LONGEST, WINDOW, DEPTH = 128, 10_000, 5
EVERY_S = 1.0
LOOK_S = 0.1
LOOKS_A_LINE = 10
FOR_ALL = EMERGENCY_STOP
"""Goes out as soon as one listens, and once more when all who listen are found, up to 3 s later."""
ARRIVES_S = 1.0
"""So long is waited for those who have not confirmed it."""
KEPT_S = 0.1
HIDDEN = hidden("topics")
TOPIC = arg("topic_name", help="Name of the ROS topic (e.g. '/chatter')")


@verb(
    "topic list", "Output a list of available topics", OF_GRAPH, TYPES,
    flag("-c", "--count-topics", dest="count", help="Only display the number of topics discovered"), HIDDEN,
    flag("-v", "--verbose", help="List full details about each topic"),
)  # fmt: skip
def list_topics(args: argparse.Namespace) -> None:
    """Print their names, with types or numbers of endpoints if asked."""
    if args.count or not args.verbose:
        return naming.list_all("topic", args)
    with joined(args, settled=True) as me:
        topics = naming.shown(naming.known("topic", me.node), hidden=args.hidden)
        if topics:
            _print_ends(topics, "Published", "publisher", me.node.handle.get_count_publishers)
            _print_ends(topics, "Subscribed", "subscriber", me.node.handle.get_count_subscribers)
    return None


def _print_ends(topics: list[tuple[str, list[str]]], title: str, what: str, count: Callable[[str], int]) -> None:
    print(f"{title} topics:")
    for name, types in topics:
        if ends := count(name):
            print(f" * {name} [{', '.join(types)}] {ends} {what}{'s' if ends > 1 else ''}")
    print()


verb("topic type", "Print a topic's type", OF_GRAPH, arg("name", metavar="topic_name", help="Name of the ROS topic"))(
    partial(naming.print_types, "topic")
)


@verb(
    "topic info", "Print information about a topic", OF_GRAPH, TOPIC,
    flag("--verbose", "-v", help="Prints each publisher and subscription with its node, type and QoS, too"),
)  # fmt: skip
def info(args: argparse.Namespace) -> str | None:
    """Print its type, how many publish it and hear it, and with `-v` each of them."""
    topic = args.topic_name
    with joined(args, settled=True) as me:
        types = naming.types_of("topic", topic, me.node)
        if not types:
            return f"Unknown topic '{topic}'"
        end = "\n\n" if args.verbose else "\n"
        print(f"Type: {plain(types[0]) if len(types) == 1 else types}", end=end)
        for what, found in (
            ("Publisher", me.node.get_publishers_info_by_topic(topic)),
            ("Subscription", me.node.get_subscriptions_info_by_topic(topic)),
        ):
            print(f"{what} count: {len(found)}", end=end)
            for each in found if args.verbose else ():
                print(_in_lines(each), end=end)
    return None


def _in_lines(info: TopicEndpointInfo) -> TopicEndpointInfo:
    info.node_name = plain(info.node_name)
    info.node_namespace = plain(info.node_namespace)
    info.topic_type = plain(info.topic_type)
    return info


def _type_of(me: Guest, topic: str) -> type[Any] | None:
    """Return the class of a topic's messages, None if the topic does not appear for a while."""
    full, found = naming.expanded(topic, me.node), list[str]()

    def there() -> bool:
        found[:] = naming.types_of("topic", full, me.node)
        return bool(found)

    if not me.await_until(there):
        print(f"WARNING: topic [{topic}] does not appear to be published yet", flush=True)
        return None
    if len(found) > 1:
        raise RuntimeError(f"Cannot echo topic '{topic}', as it contains more than one type: [{', '.join(found)}]")
    return load(found[0], "msg")


def _matching_qos(me: Guest, topic: str) -> QoSProfile:
    """Return the strongest request that all publishers of a topic meet."""
    full = naming.expanded(topic, me.node)
    if me.await_until(lambda: me.node.count_publishers(full) > 0):
        me.settle()
    found = publishers(me.node, full)
    return profile(to_hear(found) if found else Qos(BEST_EFFORT), DEPTH)


@verb(
    "topic echo", "Output messages from a topic", OF_GRAPH, TOPIC,
    arg("message_type", nargs="?", help="Type of the ROS message (e.g. 'std_msgs/msg/String')"), QOS,
    arg("--field", metavar="FIELD_NAME", help="Echo a selected field, such as 'pose.pose.position' of an Odometry"),
    flag("-f", "--full-length", help="Output all elements of arrays and all of a text"),
    arg(
        "--truncate-length", "-l", type=positive_int, default=LONGEST,
        help="The length to truncate arrays and texts to (default: %(default)s)",
    ),
    arg("--filter", dest="filter_expr", help="Print only messages m that fit, such as 'm.data > 0.5'"),
    flag("--once", help="Print the first message received and then exit."),
    arg("--timeout", metavar="N", type=float, help="Wait for a message up to N seconds"),
)  # fmt: skip
def echo(args: argparse.Namespace) -> None:
    """Print them as they come."""
    show = _shower(args)
    with joined(args) as me:
        cls = load(args.message_type, "msg") if args.message_type else _type_of(me, args.topic_name)
        if cls is None:
            raise RuntimeError("Could not determine the type for the passed topic")
        came: list[Any] = []
        qos = chosen_qos(args, partial(_matching_qos, me, args.topic_name))
        me.node.create_subscription(cls, args.topic_name, came.append, qos)
        begun = time.monotonic()
        while args.timeout is None or time.monotonic() < begun + args.timeout:
            me.spin_once(SPIN_S)
            for message in came:
                begun = time.monotonic()
                if show(message) and args.once:
                    return
            came.clear()


def _shower(args: argparse.Namespace) -> Callable[[Any], bool]:
    """Return what prints a message, or the chosen part of it, if it is wanted, and tells whether it was."""
    steps = [step for step in re.split(r"\.|(\[\d+\])", args.field or "") if step]
    if args.field is not None and not steps:
        raise RuntimeError(f"Invalid field value '{args.field}'")
    is_wanted, longest = wanted(args.filter_expr), None if args.full_length else args.truncate_length

    def show(message: Any) -> bool:  # noqa: ANN401 - generated
        part = _part(message, steps)
        if not is_wanted(part):
            return False
        is_message = hasattr(part, "get_fields_and_field_types")
        print(to_yaml(part, longest) if is_message else f"{part}\n", end="---\n", flush=True)
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


@verb(
    "topic hz", "Print the average receiving rate to screen", OF_GRAPH, TOPIC,
    arg(
        "--window", "-w", type=positive_int, default=WINDOW, metavar="WINDOW",
        help="window size, in # of messages, for calculating rate (default: %(default)s)",
    ),
    QOS,
)  # fmt: skip
def hz(args: argparse.Namespace) -> None:
    """Print the rate each second in which a message has come."""
    with joined(args) as me:
        while (cls := _type_of(me, args.topic_name)) is None:
            time.sleep(AGAIN_S)
        gaps: deque[float] = deque(maxlen=args.window)
        last, printed = 0.0, 0.0

        def hear(_message: bytes) -> None:
            nonlocal last
            now = time.monotonic()
            if last:
                gaps.append(now - last)
            last = now

        qos = chosen_qos(args, partial(_matching_qos, me, args.topic_name))
        me.node.create_subscription(cls, args.topic_name, hear, qos, raw=True)
        while True:
            me.spin_once()
            if gaps and not printed:
                printed = last
            elif gaps and last >= printed + EVERY_S:
                printed, mean = last, fmean(gaps)
                print(
                    f"average rate: {1 / mean if mean > 0 else 0:.3f}\n\tmin: {min(gaps):.3f}s max: {max(gaps):.3f}s "
                    f"std dev: {pstdev(gaps):.5f}s window: {len(gaps)}",
                    flush=True,
                )


@verb(
    "topic pub", "Publish a message to a topic", OF_GRAPH, TOPIC,
    arg("message_type", help="Type of the ROS message (e.g. 'std_msgs/String')"),
    arg("values", nargs="?", default="{}", help="Values to fill the message with in YAML (e.g. 'data: Hello World')"),
    arg("-r", "--rate", metavar="N", type=positive_float, default=1.0, help="Publishing rate in Hz (default: 1)"),
    flag("-1", "--once", help="Publish one message and exit"),
    arg("-t", "--times", type=positive_int, default=0, help="Publish this number of times and then exit"),
    arg(
        "-w", "--wait-matching-subscriptions", dest="listeners", metavar="N", type=int,
        help="Wait until finding that many subscriptions; by default 1 with '--once' or '--times', otherwise 0.",
    ),
    QOS,
)  # fmt: skip
def pub(args: argparse.Namespace) -> None:
    """Publish until told to stop, or as often as asked."""
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    def latched() -> QoSProfile:
        return QoSProfile(
            depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL
        )

    kind = load(args.message_type, "msg")
    draft = filled(kind, read(args.values))
    times, arrives = 1 if args.once else args.times, Duration(seconds=ARRIVES_S)
    with joined(args) as me:
        publisher = me.node.create_publisher(kind, args.topic_name, chosen_qos(args, latched))
        _await_listeners(publisher, min(times, 1) if args.listeners is None else args.listeners)
        print("publisher: beginning loop", flush=True)
        due, count = time.monotonic(), 0
        while True:
            count += 1
            message = draft.dated()
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
            me.settle(NETWORK_S)
            if publisher.get_subscription_count() > reached:
                publisher.publish(message)
        publisher.wait_for_all_acked(arrives)
        time.sleep(KEPT_S)


def _await_listeners(publisher: Publisher, wanted: int) -> None:
    looks = 0
    while publisher.get_subscription_count() < wanted:
        if looks % LOOKS_A_LINE == 0:
            print(f"Waiting for at least {wanted} matching subscription(s)...", flush=True)
        looks += 1
        time.sleep(LOOK_S)
