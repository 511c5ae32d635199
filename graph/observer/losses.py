"""How many messages were lost, as far as the middleware knows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rclpy.subscription import Subscription


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
