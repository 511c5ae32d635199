"""Publishes once, without missing a subscriber that is still being matched; or at a rate, without drift."""

from __future__ import annotations

import itertools
import time
from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from graph.data import Publication
from graph.messages.making import Draft, draft
from graph.messages.types import load_message
from graph.qos import RELIABLE, TRANSIENT_LOCAL, Qos, profile, to_be_heard
from graph.ros import ONLY_LISTENING
from graph.scan import subscriptions
from text.sentences import SaidError, reason_of, say

if TYPE_CHECKING:
    from collections.abc import Mapping
    from concurrent.futures import Future

    from rclpy.node import Node
    from rclpy.publisher import Publisher

    from graph.data import Value
    from graph.scan import TopicEnds


MATCH_WITHIN_S = 1.0
"""How long a new publisher waits for its subscribers."""
DISCOVERY_S = 4.0
"""How long after its start Deck may not have discovered everybody yet."""
SETTLE_S = 0.2
"""A subscriber is matched here a little before the publisher is matched there."""
DEPTH = 200
"""Queue of outgoing messages: a burst must not overwrite what is not acknowledged yet."""


class PublishError(SaidError):
    """The message cannot be published; str() says why, `words` says it in translatable form."""


@dataclass
class _PendingPublisher:
    """One publisher and the messages that wait for its subscribers."""

    node: Node
    publisher: Publisher
    cls: type[Any]
    qos: Qos
    expected: int
    """Subscribers known when the publisher was made, including Deck's own."""
    patience_ends_s: float
    waiting: deque[tuple[Draft | None, Future[int]]] = field(default_factory=deque)
    """A message, None once sent, and the future for the number of its receivers."""
    matched_since_s: float | None = None
    is_settled: bool = False
    """Whether all subscribers are matched, so that nothing needs to wait any more."""

    def advance(self) -> None:
        """Send what can be sent, and report the numbers of receivers."""
        now_s = time.monotonic()
        matched = self.publisher.get_subscription_count()
        if not self.is_settled:
            self._settle(matched >= max(1, self.expected), now_s)
        all_matched = self.matched_since_s is not None
        while self.waiting and (self.is_settled or (all_matched and self.waiting[0][0] is None)):
            message, future = self.waiting.popleft()
            if message is None or self.publish(message, future):
                future.set_result(max(0, matched - self._passive_subscriptions()))

    def publish(self, message: Draft, future: Future[int]) -> bool:
        """Publish; return whether that succeeded, and pass a failure to the future."""
        try:
            self.publisher.publish(message.dated())
        except Exception as error:  # noqa: BLE001 - reported to the caller
            failure = PublishError(f"{self.publisher.topic}: {error}")
            failure.__cause__ = error
            future.set_exception(failure)
            return False
        return True

    def _passive_subscriptions(self) -> int:
        """The current number of Deck's own subscribers, which do not count as receivers."""
        subscribed = subscriptions(self.node, self.publisher.topic)
        return sum(end.node.startswith(ONLY_LISTENING) for end in subscribed)

    def _settle(self, all_matched: bool, now_s: float) -> None:
        if not all_matched:
            self.matched_since_s = None
        elif self.matched_since_s is None:
            self.matched_since_s = now_s
        since_s = self.matched_since_s
        heard = since_s is not None and now_s - since_s >= SETTLE_S
        self.is_settled = heard or now_s >= self.patience_ends_s


class Outbox:
    """Deck's publishers, one for each topic, type and durability; created once and kept."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._born_s = time.monotonic()
        self._lines: dict[tuple[str, str, bool], _PendingPublisher] = {}

    def knows_latched(self, topic: str, type_name: str) -> bool:
        return (topic, type_name, True) in self._lines

    def prepare(self, topic: str, type_name: str, ends: TopicEnds | None, *, latched: bool) -> None:
        """Create the publisher now, so that the first message need not wait for it.

        Raises PublishError or UnknownTypeError.
        """
        self._line(topic, type_name, ends, latched=latched)

    def publish(
        self,
        topic: str,
        type_name: str,
        value: Mapping[str, Value],
        ends: TopicEnds | None,
        future: Future[int],
        *,
        latched: bool,
    ) -> None:
        """Publish as soon as the existing subscribers are matched, then report how many there are.

        Raises PublishError, UnknownTypeError or FieldError.
        """
        line = self._line(topic, type_name, ends, latched=latched)
        message = draft(line.cls, value)
        if latched:
            # The middleware hands it to those matched later: a stop must not wait.
            if line.publish(message, future):
                line.waiting.append((None, future))
        else:
            line.waiting.append((message, future))
        line.advance()

    def renew_latched(self, topic: str, type_name: str, ends: TopicEnds | None) -> None:
        """Have a new latched publisher: what the old one has said reaches nobody any more.

        Raises PublishError or UnknownTypeError.
        """
        line = self._lines.pop((topic, type_name, True), None)
        if line is not None:
            self._node.destroy_publisher(line.publisher)
            for _message, future in line.waiting:
                future.set_exception(PublishError(say("{topic}: it was taken back", topic=topic)))
        self._line(topic, type_name, ends, latched=True)

    def step(self) -> bool:
        """Send what can be sent now; return whether anything still waits."""
        for line in self._lines.values():
            if line.waiting or not line.is_settled:
                line.advance()
        return any(line.waiting for line in self._lines.values())

    def fail(self, error: Exception) -> None:
        for line in self._lines.values():
            while line.waiting:
                line.waiting.popleft()[1].set_exception(error)

    def _line(self, topic: str, type_name: str, ends: TopicEnds | None, *, latched: bool) -> _PendingPublisher:
        refuse_other_type(topic, type_name, ends)
        subscribers = ends.subscribers if ends else ()
        qos = Qos(RELIABLE, TRANSIENT_LOCAL) if latched else to_be_heard(subscribers)
        key = (topic, type_name, latched)
        line = self._lines.get(key)
        if line is None or (line.qos != qos and not line.waiting):
            if line is not None:
                self._node.destroy_publisher(line.publisher)
            passive_subscriptions = ends.passive_subscriptions if ends else 0
            line = self._open(topic, type_name, qos, len(subscribers) + passive_subscriptions)
            self._lines[key] = line
        return line

    def _open(self, topic: str, type_name: str, qos: Qos, expected: int) -> _PendingPublisher:
        cls = load_message(type_name)
        publisher = open_publisher(self._node, topic, cls, qos)
        now_s = time.monotonic()
        patience_ends_s = max(now_s + MATCH_WITHIN_S, self._born_s + DISCOVERY_S)
        return _PendingPublisher(self._node, publisher, cls, qos, expected, patience_ends_s)


def refuse_other_type(topic: str, type_name: str, ends: TopicEnds | None) -> None:
    """Raise PublishError if others use the topic, and none of them with this type."""
    others = ends.type_names if ends and not ends.is_deserted else ()
    if others and type_name not in others:
        raise PublishError(
            say("{topic} carries {types}, not {type}", topic=topic, types=", ".join(others), type=type_name)
        )


def open_publisher(node: Node, topic: str, cls: type[Any], qos: Qos, depth: int = DEPTH) -> Publisher:
    """Create a publisher. Raises PublishError for an invalid name."""
    from rclpy.event_handler import PublisherEventCallbacks

    try:
        return node.create_publisher(
            cls,
            topic,
            profile(qos, 1 if qos.durability == TRANSIENT_LOCAL else depth),
            event_callbacks=PublisherEventCallbacks(use_default_callbacks=False),
        )
    except Exception as error:
        words = say("{topic} cannot be published: {error}", topic=topic, error=str(error))
        raise PublishError(words) from error


LEAST_HZ = 0.1
MOST_HZ = 100.0
LATE_S = 0.5
"""A longer delay, when Deck was stopped or the machine asleep, is not made up for."""


@dataclass
class _Repeated:
    """One message and its publisher."""

    number: int
    topic: str
    type_name: str
    hz: float
    message: Draft | bytes
    """Serialized once, unless it contains the time of sending."""
    cls: type[Any]
    qos: Qos
    publisher: Publisher
    due_s: float
    passive_subscriptions: int = 0
    """Deck's own subscribers; set by the look at the graph that the new publisher triggers."""
    sent: int = 0
    error: str = ""

    def step(self, now_s: float) -> None:
        """Publish as often as it is due."""
        if now_s - self.due_s > LATE_S:
            self.due_s = now_s
        while self.due_s <= now_s and not self.error:
            try:
                held = self.message
                self.publisher.publish(held if isinstance(held, bytes) else held.dated())
            except Exception as error:  # noqa: BLE001 - reported in its row
                self.error = reason_of(error)
            else:
                self.sent += 1
            # Counted from when it was due, not from when it went out.
            self.due_s += 1.0 / self.hz

    def row(self) -> Publication:
        """Return it as the screen shows it."""
        listeners = max(0, self.publisher.get_subscription_count() - self.passive_subscriptions)
        return Publication(self.number, self.topic, self.type_name, self.hz, self.sent, listeners, self.error)


class RepeatedPublications:
    """Everything that is being published, each with a publisher of its own."""

    def __init__(self, node: Node, first_number: int = 1) -> None:
        self._node = node
        self._numbers = itertools.count(first_number)
        self._repeated: dict[int, _Repeated] = {}

    def start(self, topic: str, type_name: str, value: Mapping[str, Value], hz: float, ends: TopicEnds | None) -> int:
        """Publish from now on; return its number.

        Raises PublishError, also for an invalid rate, UnknownTypeError or FieldError.
        """
        if isinstance(hz, bool) or not LEAST_HZ <= hz <= MOST_HZ:
            raise PublishError(
                say(
                    "the rate must be between {least:g} and {most:g} Hz, not {hz:g}",
                    least=LEAST_HZ,
                    most=MOST_HZ,
                    hz=hz,
                )
            )
        from rclpy.serialization import serialize_message

        refuse_other_type(topic, type_name, ends)
        cls = load_message(type_name)
        made = draft(cls, value)
        message = made if made.stamps else serialize_message(made.message)
        qos = to_be_heard(ends.subscribers if ends else ())
        publisher = open_publisher(self._node, topic, cls, qos)
        number = next(self._numbers)
        self._repeated[number] = _Repeated(
            number, topic, type_name, hz, message, cls, qos, publisher, time.monotonic()
        )
        return number

    def stop(self, number: int) -> None:
        repeated = self._repeated.pop(number, None)
        if repeated is not None:
            self._node.destroy_publisher(repeated.publisher)

    def tune(self, topics: Mapping[str, TopicEnds]) -> None:
        """Adapt the offered QoS to new subscribers."""
        for repeated in self._repeated.values():
            ends = topics.get(repeated.topic)
            repeated.passive_subscriptions = ends.passive_subscriptions if ends else 0
            qos = to_be_heard(ends.subscribers if ends else ())
            if qos == repeated.qos:
                continue
            try:
                publisher = open_publisher(self._node, repeated.topic, repeated.cls, qos)
            except PublishError as error:
                repeated.error = error.words
                continue
            self._node.destroy_publisher(repeated.publisher)
            repeated.publisher, repeated.qos = publisher, qos

    def step(self) -> float | None:
        """Publish what is due; return when the next one is, on the monotonic clock."""
        now_s = time.monotonic()
        working = [each for each in self._repeated.values() if not each.error]
        for repeated in working:
            repeated.step(now_s)
        return min((each.due_s for each in working), default=None)

    def rows(self) -> tuple[Publication, ...]:
        """Return all of them, oldest first; one that stopped by itself says why."""
        return tuple(each.row() for each in self._repeated.values())

    def close(self) -> None:
        for number in list(self._repeated):
            self.stop(number)
