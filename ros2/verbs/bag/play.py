"""`ros2 bag play`: publishes a recording; all of it, whoever else publishes the same topics."""

from __future__ import annotations

import math
import re
import threading
import time
from typing import TYPE_CHECKING

from ros2 import bags, naming, options
from ros2.ending import until_interrupted
from ros2.log_lines import log

if TYPE_CHECKING:
    import argparse

    from graph.bag.reading import Bag, TopicInBag

SUMMARY = "Play back ROS data from a bag"
NODE = "rosbag2_player"


def arguments(parser: argparse.ArgumentParser) -> None:
    bags.bag_path(parser, "play back")
    add = parser.add_argument
    add(
        "-r",
        "--rate",
        type=options.positive_float,
        default=1.0,
        help="rate at which to play back messages. Valid range > 0.0.",
    )
    add("--topics", nargs="+", default=[], metavar="topic", help="Space-delimited list of topics")
    add("-e", "--regex", default="", help="Play only topics matching the regular expression")
    add("-x", "--exclude-regex", default="", help="regular expressions to exclude topics")
    add("--exclude-topics", nargs="+", default=[], metavar="topic")
    add("-l", "--loop", action="store_true", help="Enables loop playback when playing a bagfile")
    add("-m", "--remap", nargs="+", default=[], metavar="old:=new", help="topics to be remapped")
    add(
        "-d",
        "--delay",
        type=options.positive_float,
        default=0.0,
        help="Sleep duration before play (each loop), in seconds.",
    )
    add(
        "--playback-duration",
        type=float,
        default=-1.0,
        help="Playback duration, in seconds. Negative durations mark an infinite playback.",
    )
    add(
        "--start-offset",
        type=float,
        default=0.0,
        help="Start the playback player this many seconds into the bag file.",
    )
    add("--disable-keyboard-controls", action="store_true", help="There are none here.")
    add("--disable-loan-message", action="store_true", help="Messages are never loaned here.")
    bags.ignore(parser, "--read-ahead-queue-size", "--wait-for-all-acked", "--log-level")
    bags.refuse(
        parser, "--services", "--exclude-services", "--qos-profile-overrides-path",
        "--storage-config-file", "--clock", "--clock-topics", "--clock-topics-all",
        "--playback-until-sec", "--playback-until-nsec", "-p --start-paused",
        "--publish-service-requests", "--service-requests-source",
    )  # fmt: skip


def main(args: argparse.Namespace) -> int | str | None:
    """Publish to the end, or until Ctrl-C."""
    from graph.bag.errors import BagError, nothing_to_publish
    from graph.bag.reading import open_bag
    from text.i18n import localized

    for rule in args.remap:
        if not re.fullmatch(r"[^:=]+:=[^:=]+", rule):
            return f"'{rule}' is not a remapping: write old_topic:=new_topic"
    try:
        with open_bag(args.bag_path) as bag:
            bags.tell(bag, _warn)
            if not _play(bag, args):
                error = nothing_to_publish(bag.path, bag.messages_count)
                log(NODE, localized(error.words), "ERROR")
                return 2
            return bags.verdict(bag, _warn)
    except BagError as error:
        return localized(error.words)


def _warn(words: str) -> None:
    log(NODE, words, "WARN")


def _play(bag: Bag, args: argparse.Namespace) -> bool:
    """Publish what is asked for; return whether the bag has anything that can be published."""
    from graph.bag.publishing import FOUND_WITHIN_S, BagPublisher
    from graph.ros import open_ros
    from text.i18n import localized

    ros = open_ros(*bags.place(), "player")
    stop = threading.Event()
    try:
        rules = (rule.split(":=") for rule in args.remap)
        names = {naming.absolute(old): naming.absolute(new) for old, new in rules}
        publisher = BagPublisher(bag, ros, lambda topic: _refusal(topic, args), names=names, gives_way=False)
        left_out = publisher.progress.left_out
        for name, reason in left_out.items():
            if reason:
                log(NODE, f"Ignoring topic '{name}': {localized(reason)}", "WARN")
        if not publisher.topics and (any(left_out.values()) or not left_out):
            return False
        log(NODE, f"Set rate to {args.rate:g}")
        length_s = args.playback_duration
        until_s = args.start_offset + length_s if length_s >= 0 else math.inf
        with until_interrupted():
            # The real one takes as long to load, and who listens already has found it by then.
            publisher.find_others(stop, FOUND_WITHIN_S)
            while True:
                time.sleep(args.delay)
                publisher.play(
                    stop, lambda _progress: None, rate=args.rate, start_s=args.start_offset, until_s=until_s
                )
                if not args.loop:
                    break
        return True
    finally:
        ros.close()


def _refusal(topic: TopicInBag, args: argparse.Namespace) -> str | None:
    """Return an empty reason for a topic that is not asked for."""
    chosen = not args.topics and not args.regex
    chosen = chosen or topic.name in map(naming.absolute, args.topics)
    chosen = chosen or bool(args.regex and re.fullmatch(args.regex, topic.name))
    if args.exclude_regex and re.fullmatch(args.exclude_regex, topic.name):
        chosen = False
    if topic.name in map(naming.absolute, args.exclude_topics):
        chosen = False
    return None if chosen else ""
