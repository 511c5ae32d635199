"""The playhead of a replay: which messages are due, and what a jump reads."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from graph.observer.rates import WINDOW_S
from graph.replay.topics import NANOSECONDS, ReplayTopics

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from graph.bag.reading import Bag, TopicInBag
    from text.sentences import Words

BEFORE_NS = int(WINDOW_S / NANOSECONDS)
"""Seconds read before the target of a jump, so that rates and newest messages are there at once."""
LONGEST_TURN_S = 0.2
"""Limit per step: a bag that cannot be read fast enough is played more slowly."""


class Player:
    """Reads a bag in step with a playhead; used by the thread of the replay alone."""

    def __init__(self, bag: Bag, stopping: Callable[[], bool]) -> None:
        """`stopping` is set when nobody needs the player any more."""
        self.topics = ReplayTopics(bag.topics)
        self.now_ns = bag.start_ns
        """The playhead, in unix time of the bag."""
        self.ended = False
        self._bag = bag
        self._stopping = stopping
        self._coming: Iterator[tuple[TopicInBag, int, bytes]] = iter(())
        self._next: tuple[TopicInBag, int, bytes] | None = None
        self.seek(0.0)

    @property
    def position_s(self) -> float:
        """Seconds since the first message."""
        return (self.now_ns - self._bag.start_ns) * NANOSECONDS

    @property
    def damage(self) -> Words | None:
        """What has been left out so far as unreadable."""
        return self._bag.damage

    def seek(self, position_s: float) -> None:
        """Move the playhead there, and take what came shortly before."""
        bag = self._bag
        target_ns = bag.start_ns + round(max(0.0, position_s) / NANOSECONDS)
        target_ns = min(target_ns, bag.end_ns)
        self.topics.forget(target_ns)
        begin_ns = max(bag.start_ns, target_ns - BEFORE_NS)
        latched = self.topics.latched
        if latched and begin_ns > bag.start_ns:
            self._take_latched(latched, begin_ns)
        self._coming = bag.messages(begin_ns)
        self._fetch()
        self._take_until(target_ns, float("inf"))
        self.ended = self._next is None and target_ns >= bag.end_ns

    def advance(self, span_s: float) -> None:
        """Move the playhead by this many seconds of the bag, as far as can be read in time."""
        target_ns = self.now_ns + round(span_s / NANOSECONDS)
        self._take_until(target_ns, time.monotonic() + LONGEST_TURN_S)
        if self._next is None and self.now_ns >= self._bag.end_ns:
            self.now_ns = self._bag.end_ns
            self.ended = True

    def step(self, wanted: frozenset[str]) -> None:
        """Take the next message, of these topics if any are named."""
        while self._next is not None and not self._stopping():
            topic, stamp_ns, raw = self._next
            self.topics.take(topic, stamp_ns, raw)
            self.now_ns = max(self.now_ns, stamp_ns)
            self._fetch()
            if not wanted or topic.name in wanted:
                return
        self.ended = self._next is None

    def _take_until(self, target_ns: int, deadline_s: float) -> None:
        while self._next is not None and self._next[1] <= target_ns and not self._stopping():
            self.topics.take(*self._next)
            self.now_ns = self._next[1]
            self._fetch()
            if time.monotonic() > deadline_s:
                return
        self.now_ns = target_ns

    def _take_latched(self, names: frozenset[str], until_ns: int) -> None:
        for topic, stamp_ns, raw in self._bag.messages(names=names):
            if stamp_ns >= until_ns or self._stopping():
                return
            self.topics.take(topic, stamp_ns, raw)

    def _fetch(self) -> None:
        self._next = next(self._coming, None)
