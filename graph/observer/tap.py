"""One subscription, polled a few times a second instead of woken for every message."""

from __future__ import annotations

import time
from collections import deque
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

from graph.data import Sample
from graph.heavy_types import IMAGE, POINT_CLOUD
from graph.messages.definitions import decoder
from graph.messages.stamps import delay_reader, frame_id
from graph.messages.stand_in import stand_in
from graph.messages.types import UnknownTypeError, load_message, not_decoded
from graph.observer.rates import Arrival, RateMeter
from graph.observer.taking import SENDER, SenderReader, TakeError
from graph.qos import TRANSIENT_LOCAL, Qos, profile
from graph.ros import subscribe, unsubscribe

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.node import Node
    from rclpy.subscription import Subscription

    TakeEvery: TypeAlias = Callable[[bytes, float, int | None, bytes | None], None]
    """Takes each message of a topic: when it arrived, its number at its publisher, and which one that is."""


class Losses:
    """The middleware's own count for one subscription, read without blocking.

    It counts messages of all publishers that were lost on the way. It does not count messages that
    arrived but were overwritten in Deck's own queue, or that were sent before Deck subscribed.
    """

    def __init__(self, subscription: Subscription) -> None:
        from rclpy.impl.implementation_singleton import rclpy_implementation as rclpy_c

        lost = rclpy_c.rcl_subscription_event_type_t.RCL_SUBSCRIPTION_MESSAGE_LOST
        self._event: Any = None
        try:
            with subscription.handle:
                self._event = rclpy_c.EventHandle(subscription.handle, lost)
        except rclpy_c.UnsupportedEventTypeError:
            # Not every middleware counts losses.
            return

    def take(self) -> int | None:
        """Return how many were lost since the last call; None if unknown."""
        if self._event is None:
            return None
        with self._event:
            told = self._event.take_event()
        return int(told.total_count_change) if told else 0

    def close(self) -> None:
        """Release it; call this before the subscription is destroyed."""
        if self._event is not None:
            self._event.destroy_when_not_in_use()
            self._event = None


DEEP = 200
DEEP_OF_EVERY = 2000
"""Where no message may be missed."""
SHALLOW = 4
"""A fragmented message occupies a slot while it is being reassembled, so 1 would starve."""
QUEUE_BYTES = 4_000_000
"""Bytes that may wait in one queue."""
LARGE_TYPES = frozenset({IMAGE, POINT_CLOUD, "nav_msgs/msg/OccupancyGrid"})
FOLLOWED = 200
"""Messages per poll that a follower gets; older ones of the same poll are only counted."""
NANOSECONDS = 1e-9
FIRST = 1
"""Number of the first message of a publisher."""

_Kept: TypeAlias = "tuple[bytes, float, tuple[int, int]]"
"""A message, when it was received, unix time, and its name."""


class Tap:
    """One of Deck's subscriptions with its rates; create it, drain it, close it."""

    def __init__(
        self,
        node: Node,
        topic: str,
        type_name: str,
        qos: Qos,
        depth: int,
        meter: RateMeter | None = None,
        every: TakeEvery | None = None,
    ) -> None:
        """Subscribe; `meter` continues where an earlier tap ended.

        `every` is given each message, its arrival in unix time, its number at its publisher, and
        the identifier of that.
        A type that is not installed is measured if the middleware allows it, but not decoded.
        Raises UnknownTypeError, and what rclpy raises.
        """
        self.topic = topic
        self.type_name = type_name
        self.qos = qos
        self.depth = depth
        self.meter = meter or RateMeter()
        self.since_s = self._subscribed_s = time.time()
        self.broken = ""
        """Why the newest message could not be decoded."""
        self.unknown: UnknownTypeError | None
        """Why no message can be decoded."""
        self._cls, self.unknown = _class_for(type_name)
        self._decode = decoder(type_name) if self.unknown is None else None
        self._delay = delay_reader(self._cls) if self.unknown is None else None
        self.every = every
        self._node = node
        self._last: _Kept | None = None
        self._numbered = True
        self._hears = False
        """Whether a message has come since this subscription was created."""
        self._subscription = subscribe(node, self._cls, topic, profile(qos, depth), raw=True)
        self._losses = Losses(self._subscription)
        self._senders = SenderReader.load() if every else None

    def drain(self, *, one_publisher: bool, decode: int) -> tuple[Sample, ...]:
        """Empty the queue, and return the newest `decode` messages as samples.

        `one_publisher` says that the sequence numbers come from one writer.
        """
        batch, kept = self._take_all(decode)
        lost = self._take_losses()
        if batch:
            # One less than the depth: see SHALLOW.
            full = len(batch) >= self.depth - 1
            self._numbered = batch[-1].sequence is not None
            self.meter.add(batch, overflowed=full, one_publisher=one_publisher, lost=lost)
        self._hears = self._hears or bool(batch)
        now_s = time.time()
        return tuple(sample for one in kept if (sample := self._sample(*one, now_s)))

    def newest(self) -> tuple[Sample, ...]:
        """Return the newest message ever received, for a screen that begins to look now."""
        if self._last is None:
            return ()
        sample = self._sample(*self._last, time.time())
        return (sample,) if sample else ()

    @property
    def frame_id(self) -> str:
        """The frame that the header of the newest message names, empty without a header."""
        return frame_id(self._last[0]) if self._last and self._delay else ""

    def better_depth(self, *, one_publisher: bool) -> int:
        """Return how deep the queue should be for messages of this size.

        It may be shallow if a single publisher numbers its messages: the rate then comes from the
        numbers, and only the newest message is needed.
        """
        size = self.meter.mean_size_bytes
        if not size:
            return self.depth
        least = SHALLOW if one_publisher and self._numbered and not self.every else 8 * SHALLOW
        most = DEEP_OF_EVERY if self.every else DEEP
        wanted = max(least, min(most, int(QUEUE_BYTES / size)))
        # Sizes vary: a new subscription for every small difference would cost more than it saves.
        return wanted if not self.depth / 2 <= wanted <= self.depth * 2 else self.depth

    def close(self) -> None:
        self._losses.close()
        self._end_senders()
        unsubscribe(self._node, self._subscription)

    def _take_all(self, decode: int) -> tuple[list[Arrival], deque[_Kept]]:
        batch: list[Arrival] = []
        kept: deque[_Kept] = deque(maxlen=decode)
        take = self._taking()
        with self._subscription.handle:
            # A publisher faster than this loop must not keep it busy for ever.
            for _ in range(2 * self.depth):
                try:
                    taken = take()
                except TakeError:
                    # From the next poll on rclpy takes them, and says what is wrong if it cannot.
                    self._end_senders()
                    break
                if taken is None:
                    break
                raw, info = taken
                stamp_s = info["received_timestamp"] * NANOSECONDS or time.time()
                delay_s = self._delay(raw, stamp_s) if self._delay else None
                number, sent_ns = info["publication_sequence_number"], info["source_timestamp"]
                if self.every:
                    self._hand_on(self.every, raw, stamp_s, number, info.get(SENDER))
                is_latched = self.qos.durability == TRANSIENT_LOCAL
                if not (is_latched and self.meter.is_again(sent_ns, number)):
                    of_past = is_latched and self._is_of_past(sent_ns, number)
                    batch.append(Arrival(stamp_s, len(raw), number, delay_s, of_past))
                self._last = (raw, stamp_s, (sent_ns, number or 0))
                kept.append(self._last)
        return batch, kept

    def _is_of_past(self, sent_ns: int, number: int | None) -> bool:
        return sent_ns * NANOSECONDS < self._subscribed_s or number == FIRST

    def _taking(self) -> Callable[[], tuple[bytes, dict[str, Any]] | None]:
        if self._senders:
            return partial(self._senders.take, self._subscription)
        return partial(self._subscription.handle.take_message, self._cls, True)

    def _end_senders(self) -> None:
        if self._senders:
            self._senders.close()
            self._senders = None

    def _hand_on(
        self, every: TakeEvery, raw: bytes, stamp_s: float, number: int | None, sender: bytes | None
    ) -> None:
        try:
            every(raw, stamp_s, number, sender)
        except Exception as error:  # noqa: BLE001 - as in `_sample`
            self.broken = not_decoded(self.type_name, error)
        else:
            self.broken = ""

    def _take_losses(self) -> int:
        """Return how many messages were lost since the previous poll, and add them up."""
        lost = self._losses.take()
        if lost is None:
            return 0
        # For a late joiner, messages that a latched publisher no longer keeps may count as lost.
        lost = lost if self._hears else 0
        self.meter.lost = (self.meter.lost or 0) + lost
        return lost

    def _sample(self, raw: bytes, stamp_s: float, name: tuple[int, int], now_s: float) -> Sample | None:
        if self._decode is None:
            return None
        try:
            value = self._decode(raw)
        except Exception as error:  # noqa: BLE001
            # Whatever another program publishes under this name must not end the observer.
            self.broken = not_decoded(self.type_name, error)
            return None
        self.broken = ""
        age_s = max(0.0, now_s - stamp_s)
        sent_s = name[0] * NANOSECONDS or None
        return Sample(self.topic, self.type_name, now_s, age_s, len(raw), value, sent_s, name)


def first_depth(type_name: str, *, every: bool) -> int:
    """Return the depth for a topic whose messages have not been seen yet; `every` one is needed."""
    if every:
        return DEEP_OF_EVERY // 2
    return SHALLOW if type_name in LARGE_TYPES else DEEP


def _class_for(type_name: str) -> tuple[type[Any], UnknownTypeError | None]:
    """Return the class to subscribe with, and why its messages cannot be decoded, if so."""
    try:
        return load_message(type_name), None
    except UnknownTypeError as error:
        cls = stand_in(type_name)
        if cls is None:
            raise
        return cls, error
