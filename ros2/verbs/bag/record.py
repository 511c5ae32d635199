"""`ros2 bag record`: topics into a folder that any `ros2 bag` reads."""

from __future__ import annotations

import re
import time
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from graph.housekeeping import is_hidden
from ros2 import bags, naming
from ros2.ending import until_interrupted
from ros2.log_lines import log

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Sequence

    from graph.recording.recorder import Recorder

SUMMARY = "Record ROS data to a bag"
NODE = "rosbag2_recorder"
LOOK_S = 0.1


def arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add(
        "-o",
        "--output",
        help="Destination of the bagfile to create, defaults to a timestamped folder in the current directory.",
    )
    add("-s", "--storage", default="mcap", choices=["mcap"], help="Storage identifier to be used")
    named = parser.add_mutually_exclusive_group()
    named.add_argument("topics_positional", nargs="*", default=[], metavar="[Topic ...]")
    named.add_argument("--topics", nargs="+", default=[], metavar="Topic")
    add("--topic-types", nargs="+", default=[], metavar="TopicType")
    add("-a", "--all", action="store_true", help="Record all topics (Exclude hidden topic).")
    add("--all-topics", action="store_true", help="Record all topics (Exclude hidden topic).")
    add(
        "-e",
        "--regex",
        default="",
        help="Record only topics containing provided regular expression. "
        "Note: --all or --all-topics will override --regex.",
    )
    add("--exclude-regex", default="", help="Exclude topics containing the regular expression.")
    add("--exclude-topic-types", nargs="+", default=[], metavar="ExcludeTopicTypes")
    add("--exclude-topics", nargs="+", default=[], metavar="Topic")
    add(
        "--include-hidden-topics",
        action="store_true",
        help="Discover and record hidden topics as well. These are topics used internally by ROS 2 implementation.",
    )
    add("--disable-keyboard-controls", action="store_true", help="There are none here.")
    bags.ignore(parser, "-p --polling-interval", "--max-cache-size", "--node-name", "--log-level")
    bags.refuse(
        parser, "--services", "--all-services", "--exclude-services", "--no-discovery",
        "--include-unpublished-topics", "--ignore-leaf-topics", "--qos-profile-overrides-path",
        "-f --serialization-format", "-b --max-bag-size", "-d --max-bag-duration",
        "--start-paused", "--use-sim-time", "--custom-data", "--snapshot-mode",
        "--storage-preset-profile", "--storage-config-file", "--compression-queue-size",
        "--compression-threads", "--compression-mode", "--compression-format",
    )  # fmt: skip


def main(args: argparse.Namespace) -> int | str | None:
    from graph.bag.errors import BagError
    from graph.recording.recorder import Recorder
    from text.i18n import localized

    folder = Path(args.output or datetime.now().astimezone().strftime("rosbag2_%Y_%m_%d-%H_%M_%S"))
    args.topics = args.topics or args.topics_positional
    error = _fault(args, folder)
    if error:
        return f"[ERROR] [ros2bag]: {error}"
    recorder = Recorder(*bags.place(), folder, wanted=_wanted(args))
    try:
        recorder.start()
    except BagError as problem:
        return f"[ERROR] [ros2bag]: {localized(problem.words)}"
    with until_interrupted():
        log(NODE, "Listening for topics...")
        log(NODE, "Recording...")
        _tell(recorder)
    status = recorder.stop()
    log(NODE, "Recording stopped")
    return localized(status.error) if status.error else None


def _fault(args: argparse.Namespace, folder: Path) -> str:
    everything = args.all or args.all_topics
    several = everything or args.topic_types or args.regex
    if not (several or args.topics):
        return (
            "Need to specify at least one option out of --all, --all-topics, "
            "--all-services, --services, --topics, --topic-types or --regex"
        )
    for name in ("exclude_regex", "exclude_topics", "exclude_topic_types"):
        if getattr(args, name) and not several:
            option = f"--{name.replace('_', '-')}"
            return f"{option} argument requires either --all, --all-topics, --topic-types or --regex"
    try:
        re.compile(args.regex)
        re.compile(args.exclude_regex)
    except re.error as error:
        return f"'{error.pattern!s}' is not a regular expression: {error}"
    if folder.is_dir():
        return f"Output folder '{folder}' already exists."
    return ""


def _wanted(args: argparse.Namespace) -> Callable[[str, Sequence[str]], bool]:
    """Return what decides on a topic by its name and types."""
    everything = args.all or args.all_topics
    named = frozenset(() if everything else map(naming.absolute, args.topics))
    left_out = frozenset(map(naming.absolute, args.exclude_topics))
    kept_types, kept_out = frozenset(args.topic_types), frozenset(args.exclude_topic_types)

    def wanted(name: str, types: Sequence[str]) -> bool:
        if name in named:
            return True
        if is_hidden(name) and not args.include_hidden_topics:
            return False
        if not everything and not ((args.regex and re.search(args.regex, name)) or not kept_types.isdisjoint(types)):
            return False
        if args.exclude_regex and re.search(args.exclude_regex, name):
            return False
        return name not in left_out and kept_out.isdisjoint(types)

    return wanted


def _tell(recorder: Recorder) -> None:
    """Say which topics are recorded, until there is an error."""
    from text.i18n import localized

    told: set[str] = set()
    while True:
        status = recorder.status
        for topic in status.topics:
            if topic.name not in told:
                log(NODE, f"Subscribed to topic '{topic.name}'")
        for name, reason in status.skipped.items():
            if name not in told:
                log(NODE, f"Topic '{name}' is not recorded: {localized(reason)}", "WARN")
        told |= {topic.name for topic in status.topics} | status.skipped.keys()
        if status.error or status.ended:
            return
        time.sleep(LOOK_S)
