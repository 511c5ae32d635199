"""Periodic publishing: each message at its rate, without drift."""

from __future__ import annotations

import itertools
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from graph.data import Publication
from graph.messages.making import Draft, draft
from graph.messages.types import load_message
from graph.publishing.outbox import PublishError, open_publisher, refuse_other_type
from graph.qos import Qos, to_be_heard
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Mapping
    from concurrent.futures import Future

    from rclpy.node import Node
    from rclpy.publisher import Publisher

    from graph.data import Value
    from graph.scan.endpoints import TopicEnds

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

    def __init__(self, node: Node) -> None:
        self._node = node
        self._numbers = itertools.count(1)
        self._repeated: dict[int, _Repeated] = {}

    def number_from(self, first: int) -> None:
        """Count those to come from this number on."""
        self._numbers = itertools.count(first)

    def start(
        self,
        topic: str,
        type_name: str,
        value: Mapping[str, Value],
        hz: float,
        ends: TopicEnds | None,
        future: Future[int],
    ) -> None:
        """Publish from now on; the future returns the number.

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
        future.set_result(number)

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
