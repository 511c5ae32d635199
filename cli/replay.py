"""`deck replay`: show a recording on the screen, without robot or ROS, publish it, or list recordings.

Of a recording that is published, topics that move a robot are left out unless requested, and so is every topic that
another node publishes: with a recorded distance beside a measured one a robot would drive into obstacles.
"""

from __future__ import annotations

import sys
import time
from argparse import Namespace
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from cli.commands import Parser, command
from cli.domains import running_domain
from cli.options import add_graph, add_screen, rate, seconds
from cli.screen import has_terminal
from graph.bag.errors import BagError, nothing_to_publish
from graph.bag.listing import ListedBag, bags_in
from launcher.errors import UsageError
from launcher.processes.ending import stop_by_signals
from launcher.rundir import recordings_path
from safety.moving_topics import STOPPED_BY_ZEROS, moves
from safety.topics import EMERGENCY_STOP
from text.i18n import _, localized, ngettext
from text.output import BOLD, YELLOW, Paint, keep_stdout_to_ourselves, say_error, table, write
from text.plain import plain
from text.sentences import say
from text.suggestions import did_you_mean
from tui.recording.words import BETWEEN, length_words, size_words
from tui.session.requests import OpenRequest, ReplayRequest

if TYPE_CHECKING:
    from graph.bag.publishing import BagPublisher, PublishingProgress
    from graph.bag.reading import Bag, TopicInBag


def _replay_options(parser: Parser) -> None:
    parser.add_argument(
        "bag",
        nargs="?",
        metavar=_("BAG"),
        help=_("name, folder with metadata.yaml, or .mcap file; without it, list the recordings"),
    )
    parser.add_argument("--rate", metavar="R", type=rate, default=1.0, help=_("speed factor, 0.1 to 10"))
    parser.add_argument("--loop", action="store_true", help=_("start again at the end"))
    parser.add_argument(
        "--start", metavar="S", type=seconds, default=0.0, help=_("start S seconds after the first message")
    )
    parser.add_argument(
        "--publish",
        action="store_true",
        help=_("publish to the ROS graph instead of opening a screen, but nothing that moves a robot"),
    )
    parser.add_argument("--motion", action="store_true", help=_("with --publish: also what moves a robot"))
    add_graph(parser, _("with --publish: ROS domain; by default that of the running robot"))


@command("replay", _replay_options, add_screen)
def replay_command(options: Namespace) -> int:
    """Show a bag on the screen until the user quits, or publish it; return 2 if it is not a bag."""
    if (options.motion or options.domain is not None) and not options.publish:
        raise UsageError(say("--motion and --domain only work with --publish"))
    if options.bag is None:
        return _list_recordings()
    from graph.bag.files import files_of

    path = _find_recording(options.bag)
    try:
        if options.publish:
            return _publish_bag(path, options)
        if has_terminal():
            # A fault of its contents is told by the screen itself.
            files_of(path)
        else:
            from graph.bag.reading import open_bag

            with open_bag(path) as bag:
                for words in filter(None, (*bag.notes, bag.damage)):
                    say_error(localized(words))
    except BagError as error:
        raise UsageError(error.words) from error
    if not has_terminal():
        say_error(_("replay needs a terminal; `deck replay --publish` works without one"))
        return 2
    from tui.live import run_live

    order = ReplayRequest(path, options.rate, options.loop, options.start)
    return run_live(OpenRequest(replay=order, wall=options.wall), options.lang, options.bandwidth, options.pixels)


def _list_recordings() -> int:
    """Show the recordings in the default folder, newest first."""
    folder = recordings_path()
    bags = bags_in(folder)
    if not bags:
        words = _("no recordings in {folder}: F6 on the screen or `deck record` makes one")
        write(words.format(folder=plain(str(folder))))
        return 0
    paint = Paint(sys.stdout)
    head = (_("NAME"), _("ENDED"), _("LENGTH"), _("TOPICS"), _("MESSAGES"), _("SIZE"))
    first, *rows = table(head, [_row(bag) for bag in bags])
    write(paint(first, BOLD))
    for row, bag in zip(rows, bags, strict=True):
        write(row)
        if bag.trouble:
            write(paint(f"  {localized(bag.trouble)}", YELLOW))
    write(_("recordings are in {folder}; to open one: deck replay NAME").format(folder=plain(str(folder))))
    return 0


def _find_recording(named: str) -> Path:
    """Return the path of a recording, given by its path or by its name in the default folder; else UsageError."""
    path, folder = Path(named), recordings_path()
    if path.exists() or len(path.parts) != 1:
        return path
    if (folder / named).exists():
        return folder / named
    names = [bag.name for bag in bags_in(folder)]
    longer = [name for name in names if name.startswith(named)][:1]
    near = did_you_mean(longer[0] if longer else named, names)
    raise UsageError(
        say(
            "{name}: there is no such file or folder here or in {folder}{near}; `deck replay` alone"
            " lists the recordings",
            name=named,
            folder=folder,
            near=say("; {hint}", hint=near) if near else "",
        )
    )


def _row(bag: ListedBag) -> tuple[str, ...]:
    ended = time.strftime("%Y-%m-%d %H:%M", time.localtime(bag.changed_s))
    return (
        plain(bag.name),
        ended,
        "–" if bag.seconds is None else length_words(bag.seconds),
        "–" if bag.topics is None else str(bag.topics),
        "–" if bag.messages is None else str(bag.messages),
        size_words(bag.bytes),
    )


def _publish_bag(path: Path, options: Namespace) -> int:
    """Publish until the end or until stopped.

    Return 1 if others publish all of it already, or if messages are missing in the bag. Raises
    BagError for a bag of which nothing can be published.
    """
    from graph.bag.publishing import BagPublisher
    from graph.bag.reading import open_bag
    from graph.ros import open_ros

    _name, domain, discovery = running_domain(options.domain, options.discovery)
    stop = stop_by_signals()
    keep_stdout_to_ourselves()
    with open_bag(path) as bag, ExitStack() as closing:
        try:
            ros = open_ros(domain, discovery, "replay")
        except Exception as error:  # noqa: BLE001 - rclpy may raise anything, or be missing
            say_error(localized(say("ROS cannot be used: {reason}", reason=error)))
            return 1
        closing.callback(ros.close)
        publisher = BagPublisher(bag, ros, lambda topic: _refusal(topic, motion=options.motion), STOPPED_BY_ZEROS)
        told: set[str] = set()
        if not publisher.topics:
            _tell_left_out(publisher.progress, told)
            raise nothing_to_publish(bag.path, bag.messages_count)
        publisher.find_others(stop)
        _begin(bag, publisher, domain)
        _tell_left_out(publisher.progress, told)
        if not publisher.topics:
            say_error(_("nothing is left to publish"))
            return 1

        def tell(progress: PublishingProgress) -> None:
            _tell_left_out(progress, told)
            write(_words(progress, bag))

        publisher.play(stop, tell, rate=options.rate, start_s=options.start, loop=options.loop)
        _tell_left_out(publisher.progress, told)
        # The end is known only after reading everything.
        _tell(bag.damage)
        write(_("published: {words}").format(words=_words(publisher.progress, bag)))
        return int(bag.is_incomplete or bag.damage is not None)


def _refusal(topic: TopicInBag, *, motion: bool) -> str | None:
    if topic.name == EMERGENCY_STOP:
        # A recorded `false` would release a stop that somebody has engaged.
        return say("only people engage and release an emergency stop")
    if not motion and moves(topic.name, topic.kind.name):
        return say("moves the robot; --motion publishes it too")
    return None


def _begin(bag: Bag, publisher: BagPublisher, domain: int) -> None:
    topics = ngettext("{n} topic", "{n} topics", publisher.topics).format(n=publisher.topics)
    words = _("publishing {name} in domain {domain}: {topics}, {length}; Ctrl-C ends it")
    length = length_words(bag.length_s)
    write(words.format(name=plain(bag.name), domain=domain, topics=topics, length=length))
    for words in bag.notes:
        _tell(words)


def _tell(sentence: str | None) -> None:
    if sentence:
        write(plain(localized(sentence), 400))


def _tell_left_out(progress: PublishingProgress, told: set[str]) -> None:
    """Say why topics are newly left out, and note which."""
    for name, reason in sorted(progress.left_out.items()):
        if name not in told:
            words = _("not published: {topic}: {reason}")
            write(words.format(topic=plain(name), reason=plain(localized(reason), 300)))
    told.update(progress.left_out)


def _words(progress: PublishingProgress, bag: Bag) -> str:
    place = _("{now} of {length}").format(now=length_words(progress.seconds), length=length_words(bag.length_s))
    count = progress.messages
    return BETWEEN.join((place, ngettext("{n} message", "{n} messages", count).format(n=count)))
