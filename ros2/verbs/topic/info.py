"""`ros2 topic info`: type and endpoints of a topic."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import naming, options
from ros2.joining import joined
from text.plain import plain

if TYPE_CHECKING:
    import argparse

    from rclpy.topic_endpoint_info import TopicEndpointInfo

SUMMARY = "Print information about a topic"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    add = parser.add_argument
    add("topic_name", help="Name of the ROS topic to get info (e.g. '/chatter')")
    add(
        "--verbose",
        "-v",
        action="store_true",
        help="Prints detailed information like the node name, node namespace, topic type, "
        "topic type hash, GUID, and QoS Profile of the publishers and subscribers to this topic",
    )
    options.hidden_topics(parser)


def main(args: argparse.Namespace) -> int | str | None:
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
