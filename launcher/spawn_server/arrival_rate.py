"""The rate of a topic, by when its last messages were sent and received."""

from __future__ import annotations

from collections import deque

COUNTED = 5
"""The rate is computed over this many recent messages."""


class ArrivalRate:
    """Counts the messages of one topic; all times are unix seconds."""

    def __init__(self) -> None:
        """Begin without a message."""
        self._sent_s: deque[float] = deque(maxlen=COUNTED)
        self._received_s: deque[float] = deque(maxlen=COUNTED)

    def add(self, sent_s: float, received_s: float) -> None:
        """Count a message; `sent_s` is by its publisher's clock, 0 if the middleware hides it."""
        self._sent_s.append(sent_s)
        self._received_s.append(received_s)

    def hz(self, now_s: float) -> float:
        """Return messages per second; 0 until enough have arrived to compute it.

        Messages that were held up arrive together, and a publisher that has fallen silent does not
        keep its former rate: the longest of the times that they took counts.
        """
        if len(self._received_s) < COUNTED:
            return 0.0
        first_s, last_s = self._received_s[0], self._received_s[-1]
        due_s = now_s - (last_s - first_s) / (COUNTED - 1)
        lasted_s = max(max(last_s, due_s) - first_s, max(self._sent_s) - min(self._sent_s))
        return (COUNTED - 1) / lasted_s if lasted_s > 0 else 0.0
