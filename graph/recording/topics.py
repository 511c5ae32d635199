"""The topics of a recording, raw: existing ones, new ones, and those that cannot be recorded.

Queues are drained in turn and nothing is decoded. The relay hands all that on to a program that reads ROS messages
itself.
"""

from __future__ import annotations

import atexit
import logging
import threading
import time
from collections.abc import Callable, Sequence
from collections.abc import Set as AbstractSet
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple, Protocol

from graph.housekeeping import is_hidden
from graph.messages.definitions import definition, hash_of
from graph.messages.types import UnknownTypeError, load_message, not_subscribed
from graph.observer.tap import LARGE_TYPES
from graph.qos import Qos, profile, to_hear
from graph.recording.writer import NANOSECONDS, BagTopic, Message, qos_offer
from graph.ros import open_ros, subscribe, taken, unsubscribe
from graph.scan import publishers
from text.sentences import say

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.subscription import Subscription
    from rclpy.topic_endpoint_info import TopicEndpointInfo

logger = logging.getLogger(__name__)

DEEP = 2000
"""Queue between two drains, for the rate of a fast driver and a pause of a second."""
DEEP_OF_LARGE = 60
RELAY_TURN_S = 0.02
LOOK_S = 0.25
"""How often to look for new topics."""
STOP_WITHIN_S = 5.0


class TopicChoice(NamedTuple):
    """Which topics are to be recorded."""

    topics: frozenset[str] | None = None
    """None for all."""
    hidden: bool = False
    """Whether "all" includes names that begin with an underscore."""
    without: AbstractSet[str] = frozenset()
    """Types that "all" does not include."""
    wanted: Callable[[str, Sequence[str]], bool] | None = None
    """Decides, by name and types, in the place of all this."""
    asked_for: Callable[[BagTopic], bool] = lambda _topic: True
    """Whether to listen to one of them now; it is asked again and again."""

    def takes(self, name: str, types: Sequence[str]) -> bool:
        if self.wanted is not None:
            return self.wanted(name, types)
        if self.topics is not None:
            return name in self.topics
        return (self.hidden or not is_hidden(name)) and self.without.isdisjoint(types)


class Sink(Protocol):
    """Where the messages go."""

    def add_topic(self, topic: BagTopic, text: str) -> None:
        """Take a topic before its first message; `text` is the definition of its type."""

    def put(self, messages: Sequence[Message]) -> None:
        """Take messages in the order of their arrival, without waiting."""


class Sequences:
    """Finds gaps in the sequence numbers that publishers give their messages.

    The middleware does not say which publisher a number belongs to: each is assigned to the
    publisher whose last number it follows, and if there is none, to the nearest one below.
    """

    def __init__(self) -> None:
        self._last: list[int] = []

    def missing(self, number: int, publishers: Callable[[], int]) -> int:
        """Add the next number; return how many are missing before it.

        `publishers` is how many there have ever been: those that have gone are included, as nobody
        knows which numbers were theirs.
        """
        if number - 1 in self._last:
            self._last[self._last.index(number - 1)] = number
            return 0
        below = [last for last in self._last if last < number]
        if len(self._last) < publishers() or not below:
            self._last.append(number)
            return 0
        nearest = max(below)
        self._last[self._last.index(nearest)] = number
        return number - nearest - 1


class RecordingTap:
    """A subscription; create it, drain it, close it."""

    def __init__(self, node: Node, topic: BagTopic, qos: Qos) -> None:
        """Prepare to `listen`. Raises UnknownTypeError."""
        self.topic = topic
        self.qos = qos
        self.lost = 0
        """Messages that were published but never arrived."""
        self._sequences = Sequences()
        self._ever: set[tuple[int, ...]] = set()
        """Every publisher so far, by its identifier in the middleware."""
        self._node = node
        self._cls = load_message(topic.type_name)
        self._depth = DEEP_OF_LARGE if topic.type_name in LARGE_TYPES else DEEP
        self._subscription: Subscription | None = None

    def reopen(self, qos: Qos) -> None:
        """Request another quality of service, because publishers have changed."""
        listens = self._subscription is not None
        self.close()
        self.qos = qos
        self.listen(wanted=listens)

    def listen(self, *, wanted: bool) -> None:
        """Subscribe, or end the subscription until it is wanted again. Raises what rclpy raises."""
        if not wanted:
            self.close()
        elif self._subscription is None:
            qos = profile(self.qos, self._depth)
            self._subscription = subscribe(self._node, self._cls, self.topic.name, qos, raw=True)

    def drain(self) -> list[Message]:
        if self._subscription is None:
            return []
        messages: list[Message] = []
        numbers: list[int] = []
        for raw, info in taken(self._subscription, 2 * self._depth):
            stamp_ns = info["received_timestamp"] or int(time.time() * NANOSECONDS)
            number = info["publication_sequence_number"]
            if number is not None:
                numbers.append(number)
            messages.append(Message(stamp_ns, self.topic, raw, info["source_timestamp"] or stamp_ns))
        # Asked after the messages were taken: by then their senders are known.
        publishers = lru_cache(self._publishers_so_far)
        self.lost += sum(self._sequences.missing(number, publishers) for number in numbers)
        return messages

    def know(self, publishers: Sequence[TopicEndpointInfo]) -> None:
        self._ever.update(tuple(info.endpoint_gid) for info in publishers)

    def _publishers_so_far(self) -> int:
        self.know(self._node.get_publishers_info_by_topic(self.topic.name))
        return len(self._ever)

    def close(self) -> None:
        if self._subscription is not None:
            unsubscribe(self._node, self._subscription)
            self._subscription = None


class RecordingTopics:
    """All subscriptions of a recording; used by one thread alone."""

    def __init__(self, node: Node, choice: TopicChoice, sink: Sink) -> None:
        self.skipped: dict[str, str] = {}
        """Topic to why it cannot be recorded."""
        self._node = node
        self._choice = choice
        self._sink = sink
        self._taps: dict[str, RecordingTap] = {}
        self._publishers: dict[str, int] = {}

    def all(self) -> list[RecordingTap]:
        """Return every subscription so far, including those that are quiet now."""
        return list(self._taps.values())

    def absent(self) -> tuple[str, ...]:
        """Return the topics asked for by name that are neither recorded nor skipped."""
        known = self._taps.keys() | self.skipped.keys()
        return tuple(sorted((self._choice.topics or frozenset()) - known))

    def look(self) -> None:
        """Subscribe to new topics, and follow publishers whose quality of service has changed."""
        for name, types in self._node.get_topic_names_and_types():
            if self._choice.takes(name, types):
                count = self._node.handle.get_count_publishers(name)
                if count and count != self._publishers.get(name):
                    self._publishers[name] = count
                    self._tune(name, types)
        for tap in self._taps.values():
            tap.listen(wanted=self._choice.asked_for(tap.topic))

    def drain(self) -> list[Message]:
        """Take the messages of all topics, in order of arrival."""
        found = [message for tap in self._taps.values() for message in tap.drain()]
        found.sort(key=lambda message: message.stamp_ns)
        return found

    def close(self) -> None:
        for tap in self._taps.values():
            tap.close()

    def _tune(self, name: str, types: Sequence[str]) -> None:
        found = self._node.get_publishers_info_by_topic(name)
        if not found:
            self._publishers.pop(name, None)
            return
        qos = to_hear(publishers(self._node, name))
        tap = self._taps.get(name)
        if tap is None:
            tap = self._open(name, types, found, qos)
        elif tap.qos != qos:
            self._sink.put(tap.drain())
            tap.reopen(qos)
        if tap is not None:
            tap.know(found)

    def _open(
        self, name: str, types: Sequence[str], found: Sequence[TopicEndpointInfo], qos: Qos
    ) -> RecordingTap | None:
        """Subscribe, and hand the topic on; None if that is impossible."""
        named = [info.topic_type for info in found]
        # The type that most publishers have.
        type_name = max(types, key=named.count)
        digest = next((str(info.topic_type_hash) for info in found if info.topic_type == type_name), "")
        digest = digest if digest.startswith("RIHS") else ""
        topic = BagTopic(
            len(self._taps) + 1,
            name,
            type_name,
            # rosbags rejects a whole bag because of a service type's hash, which it does not know.
            "" if "/srv/" in type_name else digest or hash_of(type_name),
            [qos_offer(info.qos_profile) for info in found],
        )
        try:
            text = definition(type_name, digest)
            tap = RecordingTap(self._node, topic, qos)
            tap.listen(wanted=self._choice.asked_for(topic))
        except UnknownTypeError as error:
            self.skipped[name] = error.words
            return None
        except Exception as error:  # noqa: BLE001 - a second type under one name, for one
            self.skipped[name] = not_subscribed(name, type_name, error)
            return None
        self.skipped.pop(name, None)
        self._sink.add_topic(topic, text)
        self._taps[name] = tap
        return tap


class Relay:
    """Hands on the topics of one domain from `start` to `stop`; it only listens."""

    def __init__(self, domain: int, discovery: str | tuple[str, ...], sink: Sink, choice: TopicChoice) -> None:
        """`sink` and what `choice` asks are called by the relay's own thread."""
        self.error = ""
        """Why nothing is handed on any more, as translatable words."""
        self._place = domain, discovery
        self._sink = sink
        self._choice = choice
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="deck-relay", daemon=True)

    def start(self) -> None:
        # DDS threads must end before the interpreter does.
        atexit.register(self.stop)
        self._thread.start()

    def stop(self) -> None:
        """Leave the graph; returns within a few seconds."""
        self._stopping.set()
        atexit.unregister(self.stop)
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join(STOP_WITHIN_S)

    def _run(self) -> None:
        try:
            # This imports rclpy; the caller need not wait for it.
            ros = open_ros(*self._place, "view")
            try:
                self._take_turns(RecordingTopics(ros.node, self._choice, self._sink))
            finally:
                ros.close()
        except Exception as error:
            logger.exception("the relay failed")
            self.error = say("ROS cannot be used: {reason}", reason=error)

    def _take_turns(self, topics: RecordingTopics) -> None:
        look_at_s = 0.0
        while not self._stopping.wait(RELAY_TURN_S):
            if time.monotonic() >= look_at_s:
                topics.look()
                look_at_s = time.monotonic() + LOOK_S
            if found := topics.drain():
                self._sink.put(found)
        topics.close()
