"""`ros2 topic`: lists, messages, rates, and publishing."""

from __future__ import annotations

import re
import sys
import time
from collections import deque
from functools import partial
from statistics import fmean, pstdev
from typing import TYPE_CHECKING, Any

from ros2 import filtering, naming, options, rows
from ros2.filling import filled, read
from ros2.joining import SPIN_S, joined
from ros2.printing import to_yaml
from ros2.verb import arg, either, flag, verb
from safety.topics import EMERGENCY_STOP
from text.plain import plain

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    from rclpy.publisher import Publisher
    from rclpy.qos import QoSProfile
    from rclpy.topic_endpoint_info import TopicEndpointInfo

    from ros2.joining import Guest

AGAIN_S = 0.1
OTHERS_S = 5.0
"""So long are a topic's other publishers waited for once there is one, while somebody is there who
has not told all: Fast DDS announces a participant each 3 s."""
LONGEST = 128
WINDOW = 10_000
EVERY_S = 1.0
LOOK_S = 0.1
LOOKS_A_LINE = 10
FOR_ALL = EMERGENCY_STOP
"""Goes out as soon as one listens, and once more when all who listen are found, up to 3 s later."""


ARRIVES_S = 1.0
"""So long is waited for those who have not confirmed it."""
HIDDEN = options.hidden("topics")
TYPES = flag("-t", "--show-types", help="Additionally show the topic type")


@verb(
    "topic list", "Output a list of available topics", options.of_graph, TYPES,
    flag("-c", "--count-topics", dest="count", help="Only display the number of topics discovered"), HIDDEN,
    flag("-v", "--verbose", help="List full details about each topic"),
)  # fmt: skip
def list_topics(args: argparse.Namespace) -> None:
    """Print their names, with types or numbers of endpoints if asked."""
    if args.count or not args.verbose:
        return rows.listed("topic", args)
    with joined(args, settled=True) as me:
        topics = naming.shown(rows.known("topic", me.node), hidden=args.hidden)
        if topics:
            _print_ends(topics, "Published", "publisher", me.node.count_publishers)
            _print_ends(topics, "Subscribed", "subscriber", me.node.count_subscribers)
    return None


def _print_ends(topics: list[tuple[str, list[str]]], title: str, what: str, count: Callable[[str], int]) -> None:
    print(f"{title} topics:")
    for name, types in topics:
        if ends := naming.count(name, count):
            plural = "s" if ends > 1 else ""
            print(f" * {name} [{', '.join(types)}] {ends} {what}{plural}")
    print()


verb(
    "topic find", "Output a list of available topics of a given type", options.of_graph,
    arg("type", metavar="topic_type", help="Name of the ROS topic type to filter for"),
    flag("-c", "--count-topics", dest="count", help="Only display the number found"), HIDDEN,
)(partial(rows.found, "topic"))  # fmt: skip
verb(
    "topic type", "Print a topic's type", options.of_graph,
    arg("name", metavar="topic_name", help="Name of the ROS topic to get type (e.g. '/x')"), HIDDEN,
)(partial(rows.types, "topic"))  # fmt: skip


@verb(
    "topic info", "Print information about a topic", options.of_graph,
    arg("topic_name", help="Name of the ROS topic to get info (e.g. '/chatter')"),
    flag(
        "--verbose", "-v",
        help="Prints detailed information like the node name, node namespace, topic type, "
        "topic type hash, GUID, and QoS Profile of the publishers and subscribers to this topic",
    ),
    HIDDEN,
)  # fmt: skip
def info(args: argparse.Namespace) -> int | str | None:
    """Print its type, how many publish it and hear it, and with `-v` each of them."""
    topic = args.topic_name
    with joined(args, settled=True) as me:
        types = naming.types_of_topic(topic, me.node)
        if not types:
            return f"Unknown topic '{topic}'"
        end = "\n\n" if args.verbose else "\n"
        print(f"Type: {plain(types[0]) if len(types) == 1 else types}", end=end)
        print(f"Publisher count: {me.node.count_publishers(topic)}", end=end)
        if args.verbose:
            for info in me.node.get_publishers_info_by_topic(topic):
                print(_named(info), end=end)
        print(f"Subscription count: {me.node.count_subscribers(topic)}", end=end)
        if args.verbose:
            for info in me.node.get_subscriptions_info_by_topic(topic):
                print(_named(info), end=end)
    return None


def _named(info: TopicEndpointInfo) -> TopicEndpointInfo:
    info.node_name = plain(info.node_name)
    info.node_namespace = plain(info.node_namespace)
    info.topic_type = plain(info.topic_type)
    return info


def type_of(me: Guest, topic: str) -> type[Any] | None:
    """Return the class of a topic's messages, None if the topic does not appear for a while."""
    full, found = naming.expanded(topic, me.node), list[str]()

    def there() -> bool:
        found[:] = naming.types_of_topic(full, me.node)
        return bool(found)

    if not me.await_until(there):
        return None
    if len(found) > 1:
        raise RuntimeError(f"Cannot echo topic '{topic}', as it contains more than one type: [{', '.join(found)}]")
    return naming.message_class(found[0])


def awaited_type(me: Guest, topic: str) -> type[Any]:
    """Return the class of a topic's messages, however long it takes the topic to appear."""
    cls = type_of(me, topic)
    if cls is None:
        print(f"WARNING: topic [{topic}] does not appear to be published yet", flush=True)
    while cls is None:
        time.sleep(AGAIN_S)
        cls = type_of(me, topic)
    return cls


def matching_qos(me: Guest, topic: str, *, words: bool = True) -> QoSProfile:
    """Return the strongest request that all publishers of a topic meet; `words`: say if not all."""
    import copy

    from rclpy.qos import DurabilityPolicy, ReliabilityPolicy, qos_profile_sensor_data

    full = naming.expanded(topic, me.node)
    if me.await_until(lambda: me.node.count_publishers(full) > 0):
        me.settle(OTHERS_S)
        me.forgive()
    profile = copy.copy(qos_profile_sensor_data)
    ends = me.node.get_publishers_info_by_topic(full)
    if not ends:
        return profile
    offers = [end.qos_profile for end in ends]
    for policy, strong, weak in (
        ("reliability", ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT),
        ("durability", DurabilityPolicy.TRANSIENT_LOCAL, DurabilityPolicy.VOLATILE),
    ):
        count = sum(getattr(offer, policy) == strong for offer in offers)
        if 0 < count < len(offers) and words:
            print(
                f'Some, but not all, publishers on topic "{topic}" are offering {strong!s}. '
                f"Falling back to {weak!s} as it will connect to all publishers",
                flush=True,
            )
        setattr(profile, policy, strong if count == len(offers) else weak)
    return profile


@verb(
    "topic echo", "Output messages from a topic", options.of_graph,
    arg("topic_name", help="Name of the ROS topic to listen to (e.g. '/chatter')"),
    arg("message_type", nargs="?", help="Type of the ROS message (e.g. 'std_msgs/msg/String')"),
    options.qos("subscribe", "sensor_data"),
    arg(
        "--field", metavar="FIELD_NAME",
        help="Echo a selected field of a message. Use '.' to select sub-fields. For example, to "
        "echo the position field of a nav_msgs/msg/Odometry message: "
        "'ros2 topic echo /odom --field pose.pose.position'",
    ),
    flag(
        "-f", "--full-length",
        help="Output all elements for arrays, bytes, and string with a length > '--truncate-length', "
        "by default they are truncated after '--truncate-length' elements with '...''",
    ),
    arg(
        "--truncate-length", "-l", type=options.unsigned_int, default=LONGEST,
        help=f"The length to truncate arrays, bytes, and string to (default: {LONGEST})",
    ),
    flag("--flow-style", help="Print collections in the block style"),
    arg(
        "--filter", dest="filter_expr",
        help="Python expression to filter messages that are printed. Expression can use Python "
        "builtins as well as m (the message).",
    ),
    flag("--lost-messages", help="DEPRECATED: Does nothing"),
    flag("--no-lost-messages", help="Don't report when a message is lost"),
    flag("--raw", help="Echo the raw binary representation"),
    flag("--once", help="Print the first message received and then exit."),
    arg("--timeout", metavar="N", type=float, help="Wait for a message up to N seconds"),
    flag("--include-message-info", help="Shows the associated message info."),
    HIDDEN,
)  # fmt: skip
def echo(args: argparse.Namespace) -> int | str | None:
    """Print them as they come."""
    steps = [] if args.field is None else _steps(args.field)
    with joined(args) as me:
        if args.message_type is not None:
            cls: type[Any] | None = naming.message_class(args.message_type)
        else:
            cls = type_of(me, args.topic_name)
        if cls is None:
            print(f"WARNING: topic [{args.topic_name}] does not appear to be published yet")
            raise RuntimeError("Could not determine the type for the passed topic")
        if options.asks_for_qos(args):
            from rclpy.qos import qos_profile_sensor_data

            qos = options.chosen_qos(args, qos_profile_sensor_data)
        else:
            qos = matching_qos(me, args.topic_name)
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

    wanted = filtering.wanted(args.filter_expr)

    def show(message: Any, info: Any) -> bool:  # noqa: ANN401 - generated
        part = _part(message, steps)
        if not wanted(part):
            return False
        if not hasattr(part, "get_fields_and_field_types"):
            if args.include_message_info:
                print(f"---Got new message, message info:---\n{info}\n---Message data:---")
            print(part, end="\n---\n", flush=True)
        else:
            if args.include_message_info:
                print("".join(f"{key}: {info[key]}\n" for key in sorted(info)), end="---\n")
            print(to_yaml(part, longest, flow=args.flow_style), end="---\n", flush=True)
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
    "topic hz", "Print the average receiving rate to screen", options.of_node,
    arg("topic_name", help="Name of the ROS topic to listen to (e.g. '/chatter')"),
    arg(
        "--window", "-w", type=options.positive_int, default=WINDOW, metavar="WINDOW",
        help=f"window size, in # of messages, for calculating rate (default: {WINDOW})",
    ),
    flag(
        "--wall-time",
        help="calculates rate using wall time which can be helpful when clock is not published during simulation",
    ),
    options.qos("subscribe", "sensor_data"), HIDDEN,
)  # fmt: skip
def hz(args: argparse.Namespace) -> None:
    """Print the rate each second in which a message has come."""
    with joined(args) as me:
        cls = awaited_type(me, args.topic_name)
        qos = matching_qos(me, args.topic_name, words=False)
        if options.asks_for_qos(args):
            qos = options.chosen_qos(args, qos)
        gaps: deque[float] = deque(maxlen=args.window)
        last, printed = 0.0, 0.0
        clock = me.node.get_clock() if args.use_sim_time and not args.wall_time else None

        def hear(_message: bytes) -> None:
            nonlocal last
            now = time.monotonic() if clock is None else clock.now().nanoseconds / 1e9
            if last:
                gaps.append(now - last)
            last = now

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
    "topic pub", "Publish a message to a topic", options.of_node,
    arg("topic_name", help="Name of the ROS topic to publish to (e.g. '/chatter')"),
    arg("message_type", help="Type of the ROS message (e.g. 'std_msgs/String')"),
    either(
        arg(
            "values", nargs="?", default="{}",
            help="Values to fill the message with in YAML format (e.g. 'data: Hello World'), "
            "otherwise the message will be published with default values",
        ),
        flag("--stdin", help="Read values from standard input"),
    ),
    arg(
        "-r", "--rate", metavar="N", type=options.positive_float, default=1.0,
        help="Publishing rate in Hz (default: 1)",
    ),
    arg(
        "-p", "--print", metavar="N", type=int, default=1,
        help="Only print every N-th published message (default: 1)",
    ),
    either(
        flag("-1", "--once", help="Publish one message and exit"),
        arg(
            "-t", "--times", type=options.unsigned_int, default=0,
            help="Publish this number of times and then exit",
        ),
    ),
    arg(
        "-w", "--wait-matching-subscriptions", type=options.unsigned_int,
        help="Wait until finding the specified number of matching subscriptions. Defaults to 1 "
        "when using '-1'/'--once'/'--times', otherwise defaults to 0.",
    ),
    arg(
        "--max-wait-time-secs", type=options.positive_float,
        help="This sets the maximum wait time in seconds if --wait-matching-subscriptions is set.",
    ),
    arg(
        "--keep-alive", metavar="N", type=options.positive_float, default=0.1,
        help="Keep publishing node alive for N seconds after the last msg (default: 0.1)",
    ),
    arg("-n", "--node-name", default="", help="Name of the created publishing node"),
    options.qos("publish", "default"), HIDDEN,
)  # fmt: skip
def pub(args: argparse.Namespace) -> int | str | None:
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
