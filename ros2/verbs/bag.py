"""`ros2 bag`: recordings that any `ros2 bag` reads; all of one is played, whoever else publishes the same topics."""

from __future__ import annotations

import argparse
import math
import os
import re
import threading
import time
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from graph.housekeeping import is_hidden
from graph.ros import PEERS, RANGE
from ros2 import naming, options
from ros2.ending import until_interrupted
from ros2.log_lines import log
from ros2.verb import arg, every, flag, verb

if TYPE_CHECKING:
    from collections.abc import Callable

    from graph.bag.reading import Bag, TopicInBag
    from graph.recording.recorder import Recorder
    from ros2.verb import Part

STORAGES = ("mcap", "sqlite3")
LONGEST = 600
"""Of what is said of a bag, in characters."""
EVENTS = "/_service_event"
EVENT_TYPE = "_Event"
NEXT = "\n" + " " * 19
UNITS = ("B", "KiB", "MiB", "GiB", "TiB")
STEP = 1024
LOOK_S = 0.1
INFO, PLAYER, RECORDER = "ros2bag", "rosbag2_player", "rosbag2_recorder"


class _Refused(argparse.Action):
    """An option of the real tool that is not here: better an error than another recording."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        _namespace: argparse.Namespace,
        _values: str | Sequence[Any] | None,
        option_string: str | None = None,
    ) -> None:
        parser.error(f"{option_string} is not in Deck's ros2")


def _refused(*names: str) -> Part:
    """Return options of the real tool that are not here."""
    return every(*(arg(*name.split(), action=_Refused, nargs="*", help=argparse.SUPPRESS) for name in names))


def _ignored(*names: str) -> Part:
    """Return options of the real tool, with a value, that change nothing here."""
    return every(*(arg(*name.split(), help=argparse.SUPPRESS) for name in names))


def _existing(text: str) -> Path:
    """Read the path of a bag."""
    if not os.path.exists(text):  # noqa: PTH110 - a name with a NUL is no error
        raise argparse.ArgumentTypeError(f"Bag path '{text}' does not exist!")
    return Path(text)


def _bag_path(doing: str) -> Part:
    """Return which bag to open."""
    return every(
        arg("bag_path", type=_existing, help=f"Bag to {doing}"),
        arg(
            "-s", "--storage", choices=STORAGES,
            help="Storage implementation of bag. By default attempts to detect automatically",
        ),
    )  # fmt: skip


def _place() -> tuple[int, str | tuple[str, ...]]:
    """Return the domain and the discovery that the environment asks for."""
    domain = os.environ.get("ROS_DOMAIN_ID") or "0"
    if not domain.isdecimal():
        raise RuntimeError(f"ROS_DOMAIN_ID is not an integral number: {domain}")
    peers = tuple(filter(None, os.environ.get(PEERS, "").split(";")))
    near = os.environ.get(RANGE, "").upper() == "LOCALHOST"
    return int(domain), peers or ("localhost" if near else "subnet")


def _opened(path: Path, node: str, use: Callable[[Bag], int | str | None]) -> int | str | None:
    """Use a bag, with a warning of what is missing in it; return the exit code, 1 for a bag that lacks messages."""
    from graph.bag.errors import BagError
    from graph.bag.reading import open_bag
    from text.i18n import localized
    from text.plain import plain

    def warn(words: str) -> None:
        log(node, plain(localized(words), LONGEST), "WARN")

    try:
        with open_bag(path) as bag:
            for words in bag.notes:
                warn(words)
            code = use(bag)
            if bag.damage is not None:
                warn(bag.damage)
            return code or int(bag.damage is not None or bag.is_incomplete) or None
    except BagError as error:
        return localized(error.words)


@verb(
    "bag info",
    "Print information about a bag to the screen",
    _bag_path("open"),
    flag("-t", "--topic-name", help="Only display topic names."),
    _refused("-v --verbose"),
)
def info(args: argparse.Namespace) -> int | str | None:
    def show(bag: Bag) -> None:
        topics = [topic for topic in bag.all_topics if not _is_event(topic)]
        print("\n".join(topic.recorded for topic in topics) if args.topic_name else _all_of(bag, topics))

    return _opened(args.bag_path, INFO, show)


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


@verb(
    "bag play",
    "Play back ROS data from a bag",
    _bag_path("play back"),
    arg(
        "-r", "--rate", type=options.positive_float, default=1.0,
        help="rate at which to play back messages. Valid range > 0.0.",
    ),
    arg("--topics", nargs="+", default=[], metavar="topic", help="Space-delimited list of topics"),
    arg("-e", "--regex", default="", help="Play only topics matching the regular expression"),
    arg("-x", "--exclude-regex", default="", help="regular expressions to exclude topics"),
    arg("--exclude-topics", nargs="+", default=[], metavar="topic"),
    flag("-l", "--loop", help="Enables loop playback when playing a bagfile"),
    arg("-m", "--remap", nargs="+", default=[], metavar="old:=new", help="topics to be remapped"),
    arg(
        "-d", "--delay", type=options.positive_float, default=0.0,
        help="Sleep duration before play (each loop), in seconds.",
    ),
    arg(
        "--playback-duration", type=float, default=-1.0,
        help="Playback duration, in seconds. Negative durations mark an infinite playback.",
    ),
    arg(
        "--start-offset", type=float, default=0.0,
        help="Start the playback player this many seconds into the bag file.",
    ),
    flag("--disable-keyboard-controls", help="There are none here."),
    flag("--disable-loan-message", help="Messages are never loaned here."),
    _ignored("--read-ahead-queue-size", "--wait-for-all-acked", "--log-level"),
    _refused(
        "--services", "--exclude-services", "--qos-profile-overrides-path",
        "--storage-config-file", "--clock", "--clock-topics", "--clock-topics-all",
        "--playback-until-sec", "--playback-until-nsec", "-p --start-paused",
        "--publish-service-requests", "--service-requests-source",
    ),
)  # fmt: skip
def play(args: argparse.Namespace) -> int | str | None:
    """Publish to the end, or until Ctrl-C."""
    from graph.bag.errors import nothing_to_publish
    from text.i18n import localized

    for rule in args.remap:
        if not re.fullmatch(r"[^:=]+:=[^:=]+", rule):
            return f"'{rule}' is not a remapping: write old_topic:=new_topic"

    def use(bag: Bag) -> int | None:
        if _play(bag, args):
            return None
        log(PLAYER, localized(nothing_to_publish(bag.path, bag.messages_count).words), "ERROR")
        return 2

    return _opened(args.bag_path, PLAYER, use)


def _play(bag: Bag, args: argparse.Namespace) -> bool:
    """Publish what is asked for; return whether the bag has anything that can be published."""
    from graph.bag.publishing import FOUND_WITHIN_S, BagPublisher
    from graph.ros import open_ros
    from text.i18n import localized

    ros = open_ros(*_place(), "player")
    stop = threading.Event()
    try:
        rules = (rule.split(":=") for rule in args.remap)
        names = {naming.absolute(old): naming.absolute(new) for old, new in rules}
        publisher = BagPublisher(bag, ros, lambda topic: _refusal(topic, args), names=names, gives_way=False)
        left_out = publisher.progress.left_out
        for name, reason in left_out.items():
            if reason:
                log(PLAYER, f"Ignoring topic '{name}': {localized(reason)}", "WARN")
        if not publisher.topics and (any(left_out.values()) or not left_out):
            return False
        log(PLAYER, f"Set rate to {args.rate:g}")
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


def _named(parser: Any) -> None:  # noqa: ANN401 - a parser
    named = parser.add_mutually_exclusive_group()
    named.add_argument("topics_positional", nargs="*", default=[], metavar="[Topic ...]")
    named.add_argument("--topics", nargs="+", default=[], metavar="Topic")


@verb(
    "bag record",
    "Record ROS data to a bag",
    arg(
        "-o", "--output",
        help="Destination of the bagfile to create, defaults to a timestamped folder in the current directory.",
    ),
    arg("-s", "--storage", default="mcap", choices=["mcap"], help="Storage identifier to be used"),
    _named,
    arg("--topic-types", nargs="+", default=[], metavar="TopicType"),
    flag("-a", "--all", help="Record all topics (Exclude hidden topic)."),
    flag("--all-topics", help="Record all topics (Exclude hidden topic)."),
    arg(
        "-e", "--regex", default="",
        help="Record only topics containing provided regular expression. "
        "Note: --all or --all-topics will override --regex.",
    ),
    arg("--exclude-regex", default="", help="Exclude topics containing the regular expression."),
    arg("--exclude-topic-types", nargs="+", default=[], metavar="ExcludeTopicTypes"),
    arg("--exclude-topics", nargs="+", default=[], metavar="Topic"),
    flag(
        "--include-hidden-topics",
        help="Discover and record hidden topics as well. These are topics used internally by ROS 2 implementation.",
    ),
    flag("--disable-keyboard-controls", help="There are none here."),
    _ignored("-p --polling-interval", "--max-cache-size", "--node-name", "--log-level"),
    _refused(
        "--services", "--all-services", "--exclude-services", "--no-discovery",
        "--include-unpublished-topics", "--ignore-leaf-topics", "--qos-profile-overrides-path",
        "-f --serialization-format", "-b --max-bag-size", "-d --max-bag-duration",
        "--start-paused", "--use-sim-time", "--custom-data", "--snapshot-mode",
        "--storage-preset-profile", "--storage-config-file", "--compression-queue-size",
        "--compression-threads", "--compression-mode", "--compression-format",
    ),
)  # fmt: skip
def record(args: argparse.Namespace) -> int | str | None:
    """Record until Ctrl-C."""
    from graph.bag.errors import BagError
    from graph.recording.recorder import Recorder
    from text.i18n import localized

    folder = Path(args.output or datetime.now().astimezone().strftime("rosbag2_%Y_%m_%d-%H_%M_%S"))
    args.topics = args.topics or args.topics_positional
    error = _fault(args, folder)
    if error:
        return f"[ERROR] [ros2bag]: {error}"
    recorder = Recorder(*_place(), folder, wanted=_wanted(args))
    try:
        recorder.start()
    except BagError as problem:
        return f"[ERROR] [ros2bag]: {localized(problem.words)}"
    with until_interrupted():
        log(RECORDER, "Listening for topics...")
        log(RECORDER, "Recording...")
        _tell(recorder)
    status = recorder.stop()
    log(RECORDER, "Recording stopped")
    return localized(status.error) if status.error else None


def _fault(args: argparse.Namespace, folder: Path) -> str:
    several = args.all or args.all_topics or args.topic_types or args.regex
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
    return f"Output folder '{folder}' already exists." if folder.is_dir() else ""


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
                log(RECORDER, f"Subscribed to topic '{topic.name}'")
        for name, reason in status.skipped.items():
            if name not in told:
                log(RECORDER, f"Topic '{name}' is not recorded: {localized(reason)}", "WARN")
        told |= {topic.name for topic in status.topics} | status.skipped.keys()
        if status.error or status.ended:
            return
        time.sleep(LOOK_S)
