"""Publishes a bag into a ROS domain: raw messages, timed as they were recorded.

Nothing is decoded. A topic that another node publishes is left to that node as soon as it is seen:
two publishers of one sensor are worse than none.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from graph.data import NAMELESS
from graph.messages.types import UnknownTypeError, load_message
from graph.qos import Qos, profile
from graph.scan import full_name
from text.sentences import say

if TYPE_CHECKING:
    import threading
    from collections.abc import Callable, Collection

    from rclpy.publisher import Publisher

    from graph.bag.reading import Bag, TopicInBag
    from graph.ros import Ros

DEPTH = 100
"""Queue of a publisher: how many messages a subscriber may lag behind."""
FOUND_WITHIN_S = 1.0
"""By then nodes with Deck's settings have discovered this publisher, and it them, as a rule."""
ANSWERED_WITHIN_S = 3.2
"""Others answer a new node only with their next announcement, each 3 s (Fast DDS's default)."""
SETTLED_S = 0.5
FOUND_AT_LAST_S = 6.0
"""On a busy machine it takes longer: as long as something new is found, but not beyond this."""
POLLED_S = 0.05
LOOK_S = 0.25
"""How often to look for other publishers of the topics."""
TELL_S = 1.0
ACKED_WITHIN_S = 2.0
SHARED = frozenset({"/rosout"})
"""Topics that every node publishes: no node owns them."""


@dataclass
class PublishingProgress:
    """How far the publishing has come."""

    seconds: float = 0.0
    """Position in the bag."""
    messages: int = 0
    left_out: dict[str, str] = field(default_factory=dict)
    """Topic to why it is not published, as translatable words."""


class BagPublisher:
    """Publishes the topics of a bag, on one thread, from `play` until its end."""

    def __init__(
        self,
        bag: Bag,
        ros: Ros,
        refusal: Callable[[TopicInBag], str | None],
        stopped_by_zeros: Collection[str] = (),
        *,
        gives_way: bool = True,
    ) -> None:
        """`refusal` returns why a topic must not be published, None for those that may be.

        `stopped_by_zeros`: types for which an empty message is sent at the end. Without `gives_way`, a topic is also
        published beside another node that does so.
        """
        self._gives_way = gives_way
        self.progress = PublishingProgress()
        self._bag = bag
        self._ros = ros
        self._stopped_by_zeros = frozenset(stopped_by_zeros)
        self._publishers: dict[str, tuple[TopicInBag, Publisher]] = {}
        for topic in bag.topics:
            reason = refusal(topic)
            if reason is None and topic.messages:
                self._open(topic)
            elif reason is not None:
                self.progress.left_out[topic.name] = reason

    @property
    def topics(self) -> int:
        return len(self._publishers)

    def find_others(self, stop: threading.Event, after_s: float = ANSWERED_WITHIN_S) -> None:
        """Wait until all existing nodes are known; leave topics to those who publish them.

        That is `after_s` at the earliest.
        """
        begun_s = changed_s = time.monotonic()
        known = self._found()
        while not stop.wait(POLLED_S):
            now_s = time.monotonic()
            before, known = known, self._found()
            if known != before:
                changed_s = now_s
            settled = now_s >= begun_s + after_s and now_s >= changed_s + SETTLED_S
            if settled or now_s >= begun_s + FOUND_AT_LAST_S:
                break
        self._give_way()

    def play(
        self,
        stop: threading.Event,
        tell: Callable[[PublishingProgress], None],
        *,
        rate: float = 1.0,
        start_s: float = 0.0,
        loop: bool = False,
    ) -> None:
        """Publish once, or with `loop` until `stop`; report the progress each second.

        `start_s` is the place in the bag where the first time begins.

        Raises BagError if the bag turns out to be damaged.
        """
        try:
            self._once(stop, tell, rate, start_s)
            while loop and not stop.is_set() and self._publishers:
                self._once(stop, tell, rate, 0.0)
        finally:
            self._end()

    def _once(
        self, stop: threading.Event, tell: Callable[[PublishingProgress], None], rate: float, start_s: float
    ) -> None:
        bag = self._bag
        begin_ns = bag.start_ns + round(start_s * 1e9)
        self._latched_before(begin_ns)
        begun_s = look_s = tell_s = time.monotonic()
        for topic, stamp_ns, raw in bag.messages(begin_ns, list(self._publishers)):
            due_s = begun_s + (stamp_ns - begin_ns) / 1e9 / rate
            while not stop.is_set():
                now_s = time.monotonic()
                if now_s >= look_s + LOOK_S:
                    look_s = now_s
                    self._give_way()
                if now_s >= tell_s + TELL_S:
                    tell_s = now_s
                    tell(self.progress)
                if now_s >= due_s:
                    break
                stop.wait(min(due_s - now_s, LOOK_S))
            if stop.is_set() or not self._publishers:
                return
            self.progress.seconds = (stamp_ns - bag.start_ns) / 1e9
            self._put(topic, raw)

    def _latched_before(self, begin_ns: int) -> None:
        """Publish what was latched before the start, if playing does not start at the beginning."""
        names = [name for name, (topic, _) in self._publishers.items() if _latched(topic)]
        if begin_ns <= self._bag.start_ns or not names:
            return
        newest: dict[str, tuple[TopicInBag, bytes]] = {}
        for topic, stamp_ns, raw in self._bag.messages(names=names):
            if stamp_ns >= begin_ns:
                break
            newest[topic.name] = (topic, raw)
        for topic, raw in newest.values():
            self._put(topic, raw)

    def _put(self, topic: TopicInBag, raw: bytes) -> None:
        found = self._publishers.get(topic.name)
        # A bag may have two types under one name.
        if found is not None and found[0].kind.name == topic.kind.name:
            found[1].publish(raw)
            self.progress.messages += 1

    def _open(self, topic: TopicInBag) -> None:
        from rclpy.exceptions import InvalidTopicNameException
        from rclpy.validate_full_topic_name import validate_full_topic_name

        if topic.name in self._publishers:
            self._leave_other_type(topic, self._publishers[topic.name][0])
            return
        qos = Qos(topic.reliability or "reliable", topic.durability or "volatile")
        try:
            validate_full_topic_name(topic.name)
            kind = load_message(topic.kind.name)
            publisher = self._ros.node.create_publisher(kind, topic.name, profile(qos, DEPTH))
        except UnknownTypeError as error:
            self.progress.left_out[topic.name] = error.words
        except InvalidTopicNameException:
            # Programs outside ROS write MCAP files, too.
            self.progress.left_out[topic.name] = say("not a valid name of a ROS topic")
        else:
            self._publishers[topic.name] = (topic, publisher)

    def _leave_other_type(self, topic: TopicInBag, published: TopicInBag) -> None:
        """Say that a topic is left out since the bag has it with another type, too."""
        if topic.kind.name != published.kind.name:
            self.progress.left_out[f"{topic.name} ({topic.kind.name})"] = say(
                "the bag has it as {type}, too, and that is published", type=published.kind.name
            )

    def _found(self) -> tuple[int, ...]:
        """Return what changes as long as something is discovered."""
        node = self._ros.node
        publishers = [publisher for _, publisher in self._publishers.values()]
        return (
            len(node.get_node_names()),
            *(node.count_subscribers(one.topic_name) for one in publishers),
            *(one.get_subscription_count() for one in publishers),
        )

    def _give_way(self) -> None:
        """Leave topics to others who publish them."""
        if not self._gives_way:
            return
        node = self._ros.node
        for name in self._publishers.keys() - SHARED:
            if node.handle.get_count_publishers(name) >= 2 and (others := self._others(name)):
                node.destroy_publisher(self._publishers.pop(name)[1])
                # A publisher is discovered a moment before the name of its node.
                named = ", ".join(each for each in others if not each.endswith(NAMELESS))
                left = say("{node} publishes it", node=named) if named else say("another program publishes it")
                self.progress.left_out[name] = left

    def _others(self, topic: str) -> list[str]:
        """Return the full names of the other nodes that publish it."""
        found = self._ros.node.get_publishers_info_by_topic(topic)
        names = {full_name(one.node_name, one.node_namespace) for one in found}
        return sorted(names - {self._ros.name})

    def _end(self) -> None:
        """Stop what was set in motion, and let messages under way arrive."""
        for topic, publisher in self._publishers.values():
            if topic.kind.name in self._stopped_by_zeros:
                publisher.publish(load_message(topic.kind.name)())
        self._ros.wait_until_heard(ACKED_WITHIN_S)


def _latched(topic: TopicInBag) -> bool:
    return topic.durability == "transient_local"
