"""The playhead of a replay, and the topics of its bag as if they were live: rows, rates, and samples of some."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from graph.data import EndpointInfo, NodeRow, Sample, TopicRow, Trouble
from graph.frames.book import FRAME_TOPICS, TF_MESSAGE, FrameBook
from graph.messages.definitions import bag_decoder, begins_with_header
from graph.messages.stamps import frame_id
from graph.messages.types import UnknownTypeError, not_decoded
from graph.observer.rates import QUIET_S, WINDOW_S, Arrival, RateMeter
from graph.qos import TRANSIENT_LOCAL
from text.i18n import N_
from text.ros_names import TF_STATIC
from text.sentences import say

if TYPE_CHECKING:
    from graph.bag.reading import Bag, TopicInBag
    from graph.data import FrameRow, Interest

RATES = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
"""Factors of the original speed."""
NODE = "/bag"
"""The node that publishes everything in a replay."""
FOLLOWED = 200
"""Messages per turn that a follower gets."""
NANOSECONDS = 1e-9
BEFORE_NS = int(WINDOW_S / NANOSECONDS)
"""Seconds read before the target of a jump, so that rates and newest messages are there at once."""
LONGEST_TURN_S = 0.2
"""Limit per step: a bag that cannot be read fast enough is played more slowly."""
SILENT = N_("Nothing of it was recorded around here: go on, or jump.")


@dataclass(frozen=True)
class ReplayState:
    """The position of a replay, and how it continues."""

    position_s: float = 0.0
    """Since the first message."""
    length_s: float = 0.0
    """From the first message to the last."""
    start_s: float = 0.0
    """Unix time of the first message."""
    rate: float = 1.0
    paused: bool = False
    loop: bool = False
    ended: bool = False
    """Whether it has stopped at the end."""
    messages: int = 0
    """All topics in the bag."""
    is_cut: bool = False
    """Whether the bag was cut short."""
    is_incomplete: bool = False
    """Whether messages are missing that the bag should have."""
    notes: tuple[str, ...] = ()
    """What differs from what the bag says of itself, and what is missing: translatable words."""
    damage: str = ""
    """What has been left out so far as unreadable, as translatable words."""
    error: str = ""
    """Why it cannot continue, as translatable words."""


def next_rate(rate: float, *, faster: bool) -> float:
    """Return the next of `RATES` above or below; the last one has no next."""
    if faster:
        return next((each for each in RATES if each > rate), RATES[-1])
    return next((each for each in reversed(RATES) if each < rate), RATES[0])


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

    def seek(self, position_s: float) -> None:
        """Move the playhead there, and take what came shortly before."""
        bag = self._bag
        target_ns = min(bag.start_ns + round(max(0.0, position_s) / NANOSECONDS), bag.end_ns)
        self.topics.forget(target_ns)
        begin_ns = max(bag.start_ns, target_ns - BEFORE_NS)
        latched = self.topics.latched
        if latched and begin_ns > bag.start_ns:
            for topic, stamp_ns, raw in bag.messages(names=latched):
                if stamp_ns >= begin_ns or self._stopping():
                    break
                self.topics.take(topic, stamp_ns, raw)
        self._coming = bag.messages(begin_ns)
        self._fetch()
        self._take_until(target_ns, float("inf"))
        self.ended = self._next is None and target_ns >= bag.end_ns

    def advance(self, span_s: float) -> None:
        """Move the playhead by this many seconds of the bag, as far as can be read in time."""
        self._take_until(self.now_ns + round(span_s / NANOSECONDS), time.monotonic() + LONGEST_TURN_S)
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

    def _fetch(self) -> None:
        self._next = next(self._coming, None)


class ReplayTopics:
    """All topics of a bag."""

    def __init__(self, topics: Iterable[TopicInBag]) -> None:
        kinds: dict[str, list[TopicInBag]] = {}
        for topic in topics:
            kinds.setdefault(topic.name, []).append(topic)
        self._frames = FrameBook()
        self._topics = {name: ReplayTopic(kinds[name], self._frames) for name in sorted(kinds)}
        self.node = NodeRow(NODE, publishes=tuple(self._topics))

    @property
    def latched(self) -> frozenset[str]:
        """Topics whose last message holds until the next."""
        return frozenset(name for name, each in self._topics.items() if each.is_latched)

    def take(self, topic: TopicInBag, stamp_ns: int, raw: bytes) -> None:
        """Take the next message of the bag."""
        self._topics[topic.name].take(topic, stamp_ns, raw)

    def forget(self, until_ns: int) -> None:
        """Restart the measurement at this time in the bag."""
        self._frames.clear()
        for topic in self._topics.values():
            topic.forget(until_ns)

    def frames(self, now_s: float) -> tuple[FrameRow, ...]:
        """Return a row for each frame as of `now_s`, unix time in the bag."""
        for topic in FRAME_TOPICS:
            self._frames.published_by(topic, {b"": NODE})
        return self._frames.rows(now_s)

    def samples(
        self, interest: Interest, fresh: frozenset[str], wall_s: float, now_ns: int
    ) -> dict[str, tuple[Sample, ...]]:
        """Return the new samples of the topics that a screen wants."""
        found = {}
        for name, topic in self._topics.items():
            wanted = FOLLOWED if name in interest.followed else int(name in interest.watched)
            if samples := topic.samples(wanted, fresh=name in fresh, wall_s=wall_s, now_ns=now_ns):
                found[name] = tuple(samples)
        return found

    def rows(self, interest: Interest, now_s: float, begun_s: float) -> tuple[TopicRow, ...]:
        """Return a row for each topic of the bag and each that is wanted, sorted by name."""
        rows = {name: topic.row(now_s, begun_s) for name, topic in self._topics.items()}
        for name in interest.named - rows.keys():
            rows[name] = TopicRow(name, (), 0, 0, trouble=Trouble.NO_PUBLISHER, detail=say(SILENT), recorded=True)
        return tuple(rows[name] for name in sorted(rows))


class Newest(NamedTuple):
    """A message that has not been decoded yet."""

    stamp_ns: int
    raw: bytes


class ReplayTopic:
    """One topic: its messages up to the playhead."""

    def __init__(self, kinds: Sequence[TopicInBag], frames: FrameBook) -> None:
        """`kinds`: the topic in the bag, once for each type that it has there.

        `frames` takes the messages that carry them.
        """
        self._frames = frames
        self._newest: Newest | None = None
        self._shown = max(kinds, key=lambda each: each.messages)
        self._meter = RateMeter()
        self._waiting: deque[Newest] = deque(maxlen=FOLLOWED)
        self._broken = ""
        self._still = self._row = _still_row(kinds, self._shown)

    @property
    def is_latched(self) -> bool:
        """Whether its last message holds until the next."""
        return self._shown.durability == TRANSIENT_LOCAL or self._shown.name == TF_STATIC

    def take(self, topic: TopicInBag, stamp_ns: int, raw: bytes) -> None:
        self._meter.add([Arrival(stamp_ns * NANOSECONDS, len(raw))])
        if topic.name in FRAME_TOPICS and topic.kind.name == TF_MESSAGE:
            try:
                self._frames.take(topic.name, raw, stamp_ns * NANOSECONDS)
            except Exception as error:  # noqa: BLE001 - as in `_sample`
                self._broken = not_decoded(TF_MESSAGE, error)
        if topic.kind == self._shown.kind:
            self._newest = Newest(stamp_ns, raw)
            self._waiting.append(self._newest)

    def forget(self, until_ns: int) -> None:
        """Restart the measurement, because the playhead has jumped; keep what had come by then."""
        self._meter = RateMeter()
        self._waiting.clear()
        if self._newest is not None and self._newest.stamp_ns > until_ns:
            self._newest = None

    def samples(self, how_many: int, *, fresh: bool, wall_s: float, now_ns: int) -> list[Sample]:
        """Return the last `how_many` of this turn, decoded; a `fresh` look gets the newest."""
        found = list(self._waiting)[-how_many:] if how_many else []
        self._waiting.clear()
        if fresh and not found and self._newest is not None:
            found = [self._newest]
        decoded = (self._sample(each, wall_s, now_ns) for each in found)
        return [sample for sample in decoded if sample is not None]

    def row(self, now_s: float, begun_s: float) -> TopicRow:
        """Return the row as of `now_s`, unix time in the bag; the same object if nothing is new."""
        meter, newest = self._meter, self._newest
        age_s = meter.age_s(now_s)
        if age_s is None and newest is not None:
            # It may be from before the last jump.
            age_s = max(0.0, now_s - newest.stamp_ns * NANOSECONDS)
        row = replace(
            self._still,
            hz=meter.hz(now_s),
            bytes_per_s=meter.bytes_per_s(now_s),
            age_s=age_s,
            jitter_s=meter.jitter_s(now_s),
            count=meter.count,
            frame_id=frame_id(newest.raw) if newest and begins_with_header(self._shown.kind) else "",
        )
        row = self._with_trouble(row, now_s, begun_s)
        if row != self._row:
            self._row = row
        return self._row

    def _with_trouble(self, row: TopicRow, now_s: float, begun_s: float) -> TopicRow:
        if self._broken:
            return replace(row, trouble=Trouble.UNKNOWN_TYPE, detail=self._broken)
        quiet = now_s - begun_s > QUIET_S if row.age_s is None else self._meter.is_quiet(now_s)
        if quiet and not self.is_latched:
            return replace(row, trouble=Trouble.QUIET, detail=say(SILENT))
        return row

    def _sample(self, message: Newest, wall_s: float, now_ns: int) -> Sample | None:
        kind = self._shown.kind
        try:
            value = bag_decoder(kind)(message.raw)
        except UnknownTypeError as error:
            self._broken = error.words
            return None
        except Exception as error:  # noqa: BLE001 - no content of a bag must end the replay
            self._broken = not_decoded(kind.name, error)
            return None
        self._broken = ""
        age_s = max(0.0, (now_ns - message.stamp_ns) * NANOSECONDS)
        return Sample(self._shown.name, kind.name, wall_s, age_s, len(message.raw), value)


def _still_row(kinds: Sequence[TopicInBag], shown: TopicInBag) -> TopicRow:
    """Return what of a row does not change."""
    types = tuple(dict.fromkeys(each.kind.name for each in kinds))
    ends = tuple(
        EndpointInfo(NODE, each.kind.name, each.reliability or "unknown", each.durability or "unknown")
        for each in kinds
    )
    row = TopicRow(shown.name, types, len(ends), 0, measured=True, recorded=True, published_by=ends)
    if len(types) == 1:
        return row
    words = say(
        "The endpoints use different types: {types}; shown is {shown}.", types=", ".join(types), shown=shown.kind.name
    )
    return replace(row, detail=words)
