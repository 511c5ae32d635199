"""`ros2 bag`: recordings that any `ros2 bag` reads; all of one is played, whoever else publishes the same topics."""

from __future__ import annotations

import os
import time
from argparse import ArgumentTypeError
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from graph.bag.errors import BagError, nothing_to_publish
from graph.bag.publishing import FOUND_WITHIN_S, BagPublisher
from graph.bag.reading import open_bag
from graph.recording.recorder import Recorder
from graph.ros import PEERS, RANGE, open_ros
from launcher.processes.ending import stop_by_signals
from ros2 import naming
from ros2.ending import log
from ros2.verb import arg, flag, positive_float, verb
from text.i18n import localized
from text.plain import plain

if TYPE_CHECKING:
    import argparse
    import threading
    from collections.abc import Callable, Sequence

    from graph.bag.reading import Bag, TopicInBag

LONGEST = 600
"""Of what is said of a bag, in characters."""
NEXT = "\n" + " " * 19
UNITS = ("B", "KiB", "MiB", "GiB", "TiB")
STEP = 1024
LOOK_S = 0.1
INFO, PLAYER, RECORDER = "ros2bag", "rosbag2_player", "rosbag2_recorder"


def _existing(text: str) -> Path:
    """Read the path of a bag."""
    if not os.path.exists(text):  # noqa: PTH110 - a name with a NUL is no error
        raise ArgumentTypeError(f"Bag path '{text}' does not exist!")
    return Path(text)


BAG = arg("bag_path", type=_existing, help="Bag to open")


def _place() -> tuple[int, str | tuple[str, ...]]:
    """Return the domain and the discovery that the environment asks for."""
    domain = os.environ.get("ROS_DOMAIN_ID") or "0"
    if not domain.isdecimal():
        raise RuntimeError(f"ROS_DOMAIN_ID is not an integral number: {domain}")
    peers = tuple(filter(None, os.environ.get(PEERS, "").split(";")))
    near = os.environ.get(RANGE, "").upper() == "LOCALHOST"
    return int(domain), peers or ("localhost" if near else "subnet")


def _opened(path: Path, node: str, use: Callable[[Bag], int | None]) -> int | str | None:
    """Use a bag, with a warning of what is missing in it; return the exit code, 1 for a bag that lacks messages."""
    try:
        with open_bag(path) as bag:
            for words in bag.notes:
                _warn(node, words)
            code = use(bag)
            if bag.damage is not None:
                _warn(node, bag.damage)
            return code or int(bag.damage is not None or bag.is_incomplete) or None
    except BagError as error:
        return localized(error.words)


def _warn(node: str, words: str) -> None:
    log(node, plain(localized(words), LONGEST), "WARN")


@verb("bag info", "Print information about a bag to the screen", BAG)
def info(args: argparse.Namespace) -> int | str | None:
    return _opened(args.bag_path, INFO, lambda bag: print(_all_of(bag)))


def _all_of(bag: Bag) -> str:
    from graph.bag.files import storage_of_name

    start_ns, end_ns = (bag.start_ns, bag.end_ns) if bag.messages_count else (0, 0)
    lines = (
        f"Topic: {topic.recorded} | Type: {topic.kind.name} | Count: {topic.messages} | "
        f"Serialization Format: {topic.encoding}"
        for topic in bag.all_topics
    )
    return (
        f"\nFiles:             {NEXT.join(file.name for file in bag.files)}\n"
        f"Bag size:          {_size(bag.files)}\n"
        f"Storage id:        {storage_of_name(bag.files[0])}\n"
        f"ROS Distro:        {bag.distro or 'unknown'}\n"
        f"Duration:          {_seconds(end_ns - start_ns)}s\n"
        f"Start:             {_moment(start_ns)}\n"
        f"End:               {_moment(end_ns)}\n"
        f"Messages:          {sum(topic.messages for topic in bag.all_topics)}\n"
        f"Topic information: {NEXT.join(lines)}"
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
    "bag play", "Play back ROS data from a bag", BAG,
    arg("-r", "--rate", type=positive_float, default=1.0, help="rate at which to play back messages"),
    arg("--topics", nargs="+", default=[], metavar="topic", help="play only these topics"),
    flag("-l", "--loop", help="Enables loop playback when playing a bagfile"),
    arg("--start-offset", type=float, default=0.0, metavar="S", help="begin this many seconds into the bag file"),
)  # fmt: skip
def play(args: argparse.Namespace) -> int | str | None:
    """Publish to the end, or until Ctrl-C."""
    stop = stop_by_signals()

    def use(bag: Bag) -> int | None:
        if _play(bag, args, stop):
            return None
        log(PLAYER, localized(nothing_to_publish(bag.path, bag.messages_count).words), "ERROR")
        return 2

    return _opened(args.bag_path, PLAYER, use)


def _play(bag: Bag, args: argparse.Namespace, stop: threading.Event) -> bool:
    """Publish what is asked for; return whether the bag has anything that can be published."""
    chosen = frozenset(map(naming.absolute, args.topics))

    def refusal(topic: TopicInBag) -> str | None:
        return None if not chosen or topic.name in chosen else ""

    ros = open_ros(*_place(), "player")
    try:
        publisher = BagPublisher(bag, ros, refusal, gives_way=False)
        left_out = publisher.progress.left_out
        for name, reason in left_out.items():
            if reason:
                _warn(PLAYER, f"Ignoring topic '{name}': {localized(reason)}")
        if not publisher.topics and (any(left_out.values()) or not left_out):
            return False
        log(PLAYER, f"Set rate to {args.rate:g}")
        # The real one takes as long to load, and who listens already has found it by then.
        publisher.find_others(stop, FOUND_WITHIN_S)
        publisher.play(stop, lambda _progress: None, rate=args.rate, start_s=args.start_offset, loop=args.loop)
        return True
    finally:
        ros.close()


@verb(
    "bag record", "Record ROS data to a bag",
    arg("-o", "--output", help="folder to create, by default one named after the time in the current directory"),
    arg("topics", nargs="*", metavar="Topic", help="topics to record"),
    arg("--topics", nargs="+", dest="others", default=[], metavar="Topic", help="the same"),
    flag("-a", "--all", "--all-topics", help="Record all topics, but no hidden ones"),
    flag("--include-hidden-topics", help="With --all: hidden topics as well, such as those of actions"),
)  # fmt: skip
def record(args: argparse.Namespace) -> str | None:
    """Record until Ctrl-C."""
    folder = Path(args.output or datetime.now().astimezone().strftime("rosbag2_%Y_%m_%d-%H_%M_%S"))
    topics = [*map(naming.absolute, (*args.topics, *args.others))]
    if not (args.all or topics):
        return "[ERROR] [ros2bag]: Need to specify topics, or --all"
    recorder = Recorder(*_place(), folder, None if args.all else topics, hidden=args.include_hidden_topics)
    stop = stop_by_signals()
    try:
        recorder.start()
    except BagError as problem:
        return f"[ERROR] [ros2bag]: {localized(problem.words)}"
    log(RECORDER, "Recording...")
    _tell(recorder, stop)
    status = recorder.stop()
    log(RECORDER, "Recording stopped")
    return localized(status.error) if status.error else None


def _tell(recorder: Recorder, stop: threading.Event) -> None:
    """Say which topics are recorded, until it is stopped or there is an error."""
    told: set[str] = set()
    while not stop.wait(LOOK_S):
        status = recorder.status
        for topic in status.topics:
            if topic.name not in told:
                log(RECORDER, f"Subscribed to topic '{topic.name}'")
        for name, reason in status.skipped.items():
            if name not in told:
                _warn(RECORDER, f"Topic '{name}' is not recorded: {localized(reason)}")
        told |= {topic.name for topic in status.topics} | status.skipped.keys()
        if status.error or status.ended:
            return
