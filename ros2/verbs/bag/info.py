"""`ros2 bag info`: what is in a recording."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from ros2 import bags
from ros2.log_lines import log

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence
    from pathlib import Path

    from graph.bag.reading import Bag, TopicInBag

SUMMARY = "Print information about a bag to the screen"
NODE = "ros2bag"
EVENTS = "/_service_event"
EVENT_TYPE = "_Event"
NEXT = "\n" + " " * 19
UNITS = ("B", "KiB", "MiB", "GiB", "TiB")
STEP = 1024


def arguments(parser: argparse.ArgumentParser) -> None:
    bags.bag_path(parser, "open")
    parser.add_argument("-t", "--topic-name", action="store_true", help="Only display topic names.")
    bags.refuse(parser, "-v --verbose")


def main(args: argparse.Namespace) -> int | str | None:
    from graph.bag.errors import BagError
    from graph.bag.reading import open_bag
    from text.i18n import localized

    try:
        with open_bag(args.bag_path) as bag:
            bags.tell(bag, _warn)
            topics = [topic for topic in bag.all_topics if not _is_event(topic)]
            if args.topic_name:
                for topic in topics:
                    print(topic.recorded)
            else:
                print(_all_of(bag, topics))
            return bags.verdict(bag, _warn)
    except BagError as error:
        return localized(error.words)


def _warn(words: str) -> None:
    log(NODE, words, "WARN")


def _is_event(topic: TopicInBag) -> bool:
    return topic.name.endswith(EVENTS) and topic.kind.name.endswith(EVENT_TYPE)


def _all_of(bag: Bag, topics: list[TopicInBag]) -> str:
    from graph.bag.files import storage_of_name

    start_ns = bag.start_ns if bag.messages_count else 0
    end_ns = bag.end_ns if bag.messages_count else 0
    events = [topic for topic in bag.all_topics if _is_event(topic)]
    services = (
        f"Service: {topic.recorded.removesuffix(EVENTS)} | "
        f"Type: {topic.kind.name.removesuffix(EVENT_TYPE)} | "
        f"Event Count: {topic.messages} | Serialization Format: {topic.encoding}\n"
        for topic in events
    )
    lines = (
        f"Topic: {topic.recorded} | Type: {topic.kind.name} | Count: {topic.messages} | "
        f"Serialization Format: {topic.encoding}"
        for topic in topics
    )
    return (
        f"\nFiles:             {NEXT.join(file.name for file in bag.files)}\n"
        f"Bag size:          {_size(bag.files)}\n"
        f"Storage id:        {storage_of_name(bag.files[0])}\n"
        f"ROS Distro:        {bag.distro or 'unknown'}\n"
        f"Duration:          {_seconds(end_ns - start_ns)}s\n"
        f"Start:             {_moment(start_ns)}\n"
        f"End:               {_moment(end_ns)}\n"
        f"Messages:          {sum(topic.messages for topic in topics)}\n"
        f"Topic information: {NEXT.join(lines)}\n"
        f"Service:           {len(events)}\n"
        f"Service information: {(' ' * 21).join(services)}"
    )


def _size(files: Sequence[Path]) -> str:
    size, unit = float(sum(file.stat().st_size for file in files)), 0
    while size >= STEP and unit < len(UNITS) - 1:
        size, unit = size / STEP, unit + 1
    return f"{size:.{1 if unit else 0}f} {UNITS[unit]}"


def _seconds(nanoseconds: int) -> str:
    return f"{nanoseconds // 10**9}.{nanoseconds % 10**9:09}"


def _moment(stamp_ns: int) -> str:
    there = time.localtime(stamp_ns // 10**9)
    fraction = f"{stamp_ns % 10**9:09}"
    return f"{time.strftime('%b %e %Y %H:%M:%S', there)}.{fraction} ({_seconds(stamp_ns)})"
