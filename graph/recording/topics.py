"""The topics of a recording: existing ones, new ones, and those that cannot be recorded."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

from graph.bag.metadata import BagTopic, qos_offer
from graph.bag.types import definition, hash_of
from graph.data import EndpointInfo
from graph.housekeeping import is_hidden
from graph.messages.types import UnknownTypeError, not_subscribed
from graph.qos import to_hear
from graph.recording.tap import RecordingTap
from graph.scan import full_name

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from collections.abc import Set as AbstractSet

    from rclpy.node import Node
    from rclpy.topic_endpoint_info import TopicEndpointInfo

    from graph.recording.writer import Message


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


class RecordingTopics:
    """All subscriptions of a recording; used by the recorder's thread alone."""

    def __init__(self, node: Node, choice: TopicChoice, writer: Sink) -> None:
        self.skipped: dict[str, str] = {}
        """Topic to why it cannot be recorded."""
        self._node = node
        self._choice = choice
        self._writer = writer
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
        qos = to_hear([_end(info) for info in found])
        tap = self._taps.get(name)
        if tap is None:
            tap = self._open(name, types, found)
        elif tap.qos != qos:
            self._writer.put(tap.drain())
            tap.reopen(qos)
        if tap is not None:
            tap.know(found)

    def _open(self, name: str, types: Sequence[str], found: Sequence[TopicEndpointInfo]) -> RecordingTap | None:
        """Subscribe, and add the topic to the bag; None if that is impossible."""
        named = [info.topic_type for info in found]
        # The type that most publishers have.
        type_name = max(types, key=named.count)
        qos = to_hear([_end(info) for info in found])
        digest = next((str(i.topic_type_hash) for i in found if i.topic_type == type_name), "")
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
            tap = RecordingTap(self._node, topic, qos, listens=self._choice.asked_for(topic))
        except UnknownTypeError as error:
            self.skipped[name] = error.reason
            return None
        except Exception as error:  # noqa: BLE001 - a second type under one name, for one
            self.skipped[name] = not_subscribed(name, type_name, error)
            return None
        self.skipped.pop(name, None)
        self._writer.add_topic(topic, text)
        self._taps[name] = tap
        return tap


def _end(info: TopicEndpointInfo) -> EndpointInfo:
    qos = info.qos_profile
    return EndpointInfo(
        full_name(info.node_name, info.node_namespace),
        info.topic_type,
        qos.reliability.name.lower(),
        qos.durability.name.lower(),
    )
