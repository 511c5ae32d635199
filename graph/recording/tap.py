"""One subscription of a recording: its queue is drained in turn, nothing is decoded."""

from __future__ import annotations

import time
from functools import lru_cache
from typing import TYPE_CHECKING

from graph.messages.types import load_message
from graph.observer.tap import LARGE_TYPES
from graph.qos import Qos, profile
from graph.recording.writer import Message

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rclpy.node import Node
    from rclpy.subscription import Subscription
    from rclpy.topic_endpoint_info import TopicEndpointInfo

    from graph.bag.metadata import BagTopic

DEEP = 2000
"""Queue between two drains, for the rate of a fast driver and a pause of a second."""
DEEP_OF_LARGE = 60
NANOSECONDS = 1_000_000_000


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

    def __init__(self, node: Node, topic: BagTopic, qos: Qos, *, listens: bool = True) -> None:
        """Subscribe, unless it is to listen only later: see `listen`.

        Raises UnknownTypeError, and what rclpy raises.
        """
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
        self._subscription = self._subscribe() if listens else None

    def reopen(self, qos: Qos) -> None:
        """Request another quality of service, because publishers have changed."""
        listens = self._subscription is not None
        self.close()
        self.qos = qos
        self.listen(wanted=listens)

    def listen(self, *, wanted: bool) -> None:
        """Subscribe, or end the subscription until it is wanted again."""
        if not wanted:
            self.close()
        elif self._subscription is None:
            self._subscription = self._subscribe()

    def _subscribe(self) -> Subscription:
        from rclpy.event_handler import SubscriptionEventCallbacks

        return self._node.create_subscription(
            self._cls,
            self.topic.name,
            _never_called,
            profile(self.qos, self._depth),
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
            raw=True,
        )

    def drain(self) -> list[Message]:
        if self._subscription is None:
            return []
        taken: list[Message] = []
        numbers: list[int] = []
        handle = self._subscription.handle
        with handle:
            # A publisher faster than this loop must not keep it busy for ever.
            for _ in range(2 * self._depth):
                found = handle.take_message(self._cls, True)
                if found is None:
                    break
                raw, info = found
                stamp_ns = info["received_timestamp"] or int(time.time() * NANOSECONDS)
                number = info["publication_sequence_number"]
                if number is not None:
                    numbers.append(number)
                sent_ns = info["source_timestamp"] or stamp_ns
                taken.append(Message(stamp_ns, self.topic, raw, sent_ns))
        # Asked after the messages were taken: by then their senders are known.
        publishers = lru_cache(self._publishers_so_far)
        self.lost += sum(self._sequences.missing(number, publishers) for number in numbers)
        return taken

    def know(self, publishers: Sequence[TopicEndpointInfo]) -> None:
        self._ever.update(tuple(info.endpoint_gid) for info in publishers)

    def _publishers_so_far(self) -> int:
        self.know(self._node.get_publishers_info_by_topic(self.topic.name))
        return len(self._ever)

    def close(self) -> None:
        if self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
            self._subscription = None


def _never_called(message: object) -> None:
    """Stand in for the callback that rclpy insists on; no executor ever spins the node."""
