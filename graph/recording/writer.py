"""The thread that writes a recording, and the bounded queue in front of it."""

from __future__ import annotations

import threading
import time
from collections import Counter, deque
from typing import TYPE_CHECKING, NamedTuple

from graph.bag.errors import not_written

if TYPE_CHECKING:
    from collections.abc import Sequence

    from graph.bag.metadata import BagTopic
    from graph.recording.file import BagFile
    from text.sentences import Words

BUFFER_BYTES = 256_000_000
FLUSH_S = 1.0
"""Seconds of data that a crash may cost."""


class NewTopic(NamedTuple):
    """A topic, before its first message."""

    topic: BagTopic
    text: str
    """The definition of its type."""


class Message(NamedTuple):
    """One message on its way to the disk."""

    stamp_ns: int
    """When the middleware received it, unix time."""
    topic: BagTopic
    raw: bytes
    sent_ns: int
    """When it was sent, by the clock of its sender."""


class RecordingWriter:
    """Writes messages; those dropped because the disk is too slow are counted."""

    def __init__(self, file: BagFile, limit_bytes: int = BUFFER_BYTES) -> None:
        """Start at once to write to `file`, with at most `limit_bytes` waiting."""
        self.error: Words | None = None
        """Why nothing is written any more."""
        self.dropped: Counter[str] = Counter()
        """Topic to the number of its messages that found the buffer full."""
        self._file = file
        self._limit_bytes = limit_bytes
        self._waiting: deque[NewTopic | Message] = deque()
        self._in_hand: deque[NewTopic | Message] = deque()
        self._waiting_bytes = 0
        self._news = threading.Condition()
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="deck-recording", daemon=True)
        self._thread.start()

    @property
    def waiting_bytes(self) -> int:
        """Bytes that are not written yet."""
        return self._waiting_bytes

    def add_topic(self, topic: BagTopic, text: str) -> None:
        """Add a topic; `text` is the definition of its type."""
        with self._news:
            self._waiting.append(NewTopic(topic, text))

    def put(self, messages: Sequence[Message]) -> None:
        """Add messages in the order of their stamps; never waits."""
        with self._news:
            for message in messages:
                size = len(message.raw)
                if self.error or self._waiting_bytes + size > self._limit_bytes:
                    self.dropped[message.topic.name] += 1
                else:
                    self._waiting.append(message)
                    self._waiting_bytes += size
            self._news.notify()

    def finish(self, within_s: float) -> bool:
        """Write what waits and close the file; return whether that was done in time."""
        with self._news:
            self._ending = True
            self._news.notify()
        self._thread.join(within_s)
        return not self._thread.is_alive()

    def _run(self) -> None:
        try:
            self._write_till_the_end()
            self._file.close()
        except OSError as error:
            self._give_up(error)

    def _give_up(self, error: OSError) -> None:
        """Close the file as well as possible, and count what is not in it."""
        with self._news:
            self.error = not_written(self._file.path, error)
            for item in (*self._in_hand, *self._waiting):
                if isinstance(item, Message):
                    self.dropped[item.topic.name] += 1
            self._in_hand.clear()
            self._waiting.clear()
            self._waiting_bytes = 0
        before = {topic.name: topic.messages for topic in self._file.topics}
        self._file.salvage()
        for topic in self._file.topics:
            self.dropped[topic.name] += before[topic.name] - topic.messages

    def _write_till_the_end(self) -> None:
        flush_at_s = time.monotonic() + FLUSH_S
        while self._take(flush_at_s):
            while self._in_hand:
                item = self._in_hand.popleft()
                if isinstance(item, NewTopic):
                    self._file.add_topic(item.topic, item.text)
                else:
                    self._file.write(item.topic, item.stamp_ns, item.sent_ns, item.raw)
                    with self._news:
                        self._waiting_bytes -= len(item.raw)
                flush_at_s = self._flush_at(flush_at_s)
            flush_at_s = self._flush_at(flush_at_s)

    def _flush_at(self, flush_at_s: float) -> float:
        """Flush if it is time; return the next time."""
        if time.monotonic() < flush_at_s:
            return flush_at_s
        self._file.flush()
        return time.monotonic() + FLUSH_S

    def _take(self, until_s: float) -> bool:
        """Write what waits, as soon as anything does; return False when nothing more will come."""
        with self._news:
            if not self._waiting and not self._ending:
                self._news.wait(max(0.0, until_s - time.monotonic()))
            self._in_hand, self._waiting = self._waiting, deque()
            return bool(self._in_hand) or not self._ending
