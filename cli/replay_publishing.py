"""`deck replay --publish`: publish a recording to the ROS graph, without a screen.

Topics that move a robot are left out unless requested, and so is every topic that another node
publishes: with a recorded distance beside a measured one a robot would drive into obstacles.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cli.domains import running_domain
from graph.bag.errors import BagError, nothing_to_publish
from launcher.errors import UsageError
from launcher.processes.ending import stop_by_signals
from robot.safety.moving_topics import STOPPED_BY_ZEROS, moves
from robot.topics import EMERGENCY_STOP
from text.i18n import _, localized, ngettext
from text.output import keep_stdout_to_ourselves, say_error, write
from text.plain import plain
from text.sentences import say
from tui.recording.words import BETWEEN, length_words

if TYPE_CHECKING:
    import threading
    from argparse import Namespace
    from pathlib import Path

    from graph.bag.publishing import BagPublisher, PublishingProgress
    from graph.bag.reading import Bag, TopicInBag


def publish_bag(path: Path, options: Namespace) -> int:
    """Publish until the end or until stopped.

    Return 1 if others publish all of it already, or if messages are missing in the bag. Raises
    UsageError for a bag of which nothing can be published.
    """
    from graph.bag.reading import open_bag

    _name, domain, discovery = running_domain(options.domain, options.discovery)
    stop = stop_by_signals()
    keep_stdout_to_ourselves()
    try:
        with open_bag(path) as bag:
            return _publish(bag, domain, discovery, stop, options)
    except BagError as error:
        raise UsageError(error.words) from error


def _publish(
    bag: Bag, domain: int, discovery: str | tuple[str, ...], stop: threading.Event, options: Namespace
) -> int:
    from graph.bag.publishing import BagPublisher
    from graph.ros import open_ros

    try:
        ros = open_ros(domain, discovery, "replay")
    except Exception as error:  # noqa: BLE001 - rclpy may raise anything, or be missing
        say_error(localized(say("ROS cannot be used: {reason}", reason=error)))
        return 1
    try:
        publisher = BagPublisher(bag, ros, lambda topic: _refusal(topic, motion=options.motion), STOPPED_BY_ZEROS)
        if not publisher.topics:
            _tell_left_out(publisher.progress, set())
            raise nothing_to_publish(bag.path, bag.messages_count)
        publisher.find_others(stop)
        _begin(bag, publisher, domain)
        told = _tell_left_out(publisher.progress, set())
        if not publisher.topics:
            say_error(_("nothing is left to publish"))
            return 1

        def tell(progress: PublishingProgress) -> None:
            told.update(_tell_left_out(progress, told))
            write(_words(progress, bag))

        publisher.play(stop, tell, rate=options.rate, start_s=options.start, loop=options.loop)
        _tell_left_out(publisher.progress, told)
        # The end is known only after reading everything.
        _tell(bag.damage)
        write(_("published: {words}").format(words=_words(publisher.progress, bag)))
        return int(bag.is_incomplete or bag.damage is not None)
    finally:
        ros.close()


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


def _tell_left_out(progress: PublishingProgress, told: set[str]) -> set[str]:
    """Say why topics are newly left out; return the names of all topics left out."""
    for name, reason in sorted(progress.left_out.items()):
        if name not in told:
            words = _("not published: {topic}: {reason}")
            write(words.format(topic=plain(name), reason=plain(localized(reason), 300)))
    return set(progress.left_out)


def _words(progress: PublishingProgress, bag: Bag) -> str:
    place = _("{now} of {length}").format(now=length_words(progress.seconds), length=length_words(bag.length_s))
    count = progress.messages
    return BETWEEN.join((place, ngettext("{n} message", "{n} messages", count).format(n=count)))
