"""The topics of a bag as if they were live: their rows, their rates, and samples of some."""

from __future__ import annotations

from collections import deque
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from graph.bag.decoding import bag_decoder, begins_with_header
from graph.bag.errors import BagError
from graph.data import EndpointInfo, NodeRow, Sample, TopicRow, Trouble
from graph.frames.book import FRAME_TOPICS, FrameBook
from graph.frames.reading import TF_MESSAGE
from graph.messages.stamps import frame_id
from graph.messages.types import not_decoded
from graph.observer.rates import QUIET_S, Arrival, RateMeter
from graph.observer.taps import quiet
from graph.qos import TRANSIENT_LOCAL
from text.ros_names import TF_STATIC

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from graph.bag.reading import TopicInBag
    from graph.data import FrameRow, Interest, Value

NODE = "/bag"
"""The node that publishes everything in a replay."""
FOLLOWED = 200
"""Messages per turn that a follower gets."""
NANOSECONDS = 1e-9
RECORDED = {"recorded": ""}
"""Fact of a topic that is silent in a bag: there is no node to look at."""


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
        self.name = kinds[0].name
        self.newest: Newest | None = None
        self._kinds = kinds
        self._frames = frames
        self._shown = max(kinds, key=lambda each: each.messages)
        self._meter = RateMeter()
        self._waiting: deque[Newest] = deque(maxlen=FOLLOWED)
        self._broken = ""
        self._still = self._still_row()
        self._row = self._still

    @property
    def is_latched(self) -> bool:
        """Whether its last message holds until the next."""
        return self._shown.durability == TRANSIENT_LOCAL or self.name == TF_STATIC

    def take(self, topic: TopicInBag, stamp_ns: int, raw: bytes) -> None:
        self._meter.add([Arrival(stamp_ns * NANOSECONDS, len(raw))])
        if self.name in FRAME_TOPICS and topic.kind.name == TF_MESSAGE:
            self._take_frames(stamp_ns, raw)
        if topic.kind == self._shown.kind:
            self.newest = Newest(stamp_ns, raw)
            self._waiting.append(self.newest)

    def forget(self, until_ns: int) -> None:
        """Restart the measurement, because the playhead has jumped; keep what had come by then."""
        self._meter = RateMeter()
        self._waiting.clear()
        if self.newest is not None and self.newest.stamp_ns > until_ns:
            self.newest = None

    def samples(self, how_many: int, *, fresh: bool, wall_s: float, now_ns: int) -> list[Sample]:
        """Return the last `how_many` of this turn, decoded; a `fresh` look gets the newest."""
        found = list(self._waiting)[-how_many:] if how_many else []
        self._waiting.clear()
        if fresh and not found and self.newest is not None:
            found = [self.newest]
        decoded = (self._sample(each, wall_s, now_ns) for each in found)
        return [sample for sample in decoded if sample is not None]

    def row(self, now_s: float, begun_s: float) -> TopicRow:
        """Return the row as of `now_s`, unix time in the bag; the same object if nothing is new."""
        meter = self._meter
        row = replace(
            self._still,
            hz=meter.hz(now_s),
            bytes_per_s=meter.bytes_per_s(now_s),
            age_s=self._age_s(now_s),
            jitter_s=meter.jitter_s(now_s),
            count=meter.count,
            frame_id=self._frame_id(),
        )
        row = self._with_trouble(row, now_s, begun_s)
        if row != self._row:
            self._row = row
        return self._row

    def _take_frames(self, stamp_ns: int, raw: bytes) -> None:
        try:
            self._frames.take(self.name, raw, stamp_ns * NANOSECONDS)
        except Exception as error:  # noqa: BLE001 - as in `_sample`
            self._broken = not_decoded(TF_MESSAGE, error)

    def _frame_id(self) -> str:
        if self.newest is None or not begins_with_header(self._shown.kind):
            return ""
        return frame_id(self.newest.raw)

    def _age_s(self, now_s: float) -> float | None:
        """Return the age of the newest message, which may be from before the last jump."""
        age_s = self._meter.age_s(now_s)
        if age_s is None and self.newest is not None:
            return max(0.0, now_s - self.newest.stamp_ns * NANOSECONDS)
        return age_s

    def _with_trouble(self, row: TopicRow, now_s: float, begun_s: float) -> TopicRow:
        if self._broken:
            return replace(row, trouble=Trouble.UNKNOWN_TYPE, detail=self._broken)
        if self.is_latched:
            return row
        if row.age_s is None and now_s - begun_s > QUIET_S:
            finding = quiet(now_s - begun_s, ever=False)
        elif row.age_s is not None and self._meter.is_quiet(now_s):
            finding = quiet(row.age_s, ever=True)
        else:
            return row
        return replace(row, trouble=finding.trouble, detail=finding.detail, facts={**finding.facts, **RECORDED})

    def _sample(self, message: Newest, wall_s: float, now_ns: int) -> Sample | None:
        try:
            value = bag_decoder(self._shown.kind)(message.raw)
        except BagError as error:
            self._broken = error.words
            return None
        except Exception as error:  # noqa: BLE001 - no content of a bag must end the replay
            self._broken = not_decoded(self._shown.kind.name, error)
            return None
        self._broken = ""
        age_s = max(0.0, (now_ns - message.stamp_ns) * NANOSECONDS)
        size = len(message.raw)
        return Sample(self.name, self._shown.kind.name, wall_s, age_s, size, value)

    def _still_row(self) -> TopicRow:
        types = tuple(dict.fromkeys(each.kind.name for each in self._kinds))
        ends = tuple(
            EndpointInfo(NODE, each.kind.name, each.reliability or "unknown", each.durability or "unknown")
            for each in self._kinds
        )
        facts = {"types": ", ".join(types), "shown": self._shown.kind.name}
        return TopicRow(
            self.name,
            types,
            len(ends),
            0,
            measured=True,
            detail=f"more than one type: {facts['types']}" if len(types) > 1 else "",
            facts=facts if len(types) > 1 else {},
            published_by=ends,
        )


class ReplayTopics:
    """All topics of a bag."""

    def __init__(self, topics: Iterable[TopicInBag]) -> None:
        kinds: dict[str, list[TopicInBag]] = {}
        for topic in topics:
            kinds.setdefault(topic.name, []).append(topic)
        self._frames = FrameBook(_tree_reader(kinds))
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
            self._frames.published_by(topic, {b"": NODE}, now_s)
        return self._frames.rows(now_s)

    def samples(
        self, interest: Interest, fresh: frozenset[str], wall_s: float, now_ns: int
    ) -> dict[str, tuple[Sample, ...]]:
        """Return the new samples of the topics that a screen wants."""
        found = {}
        for name, topic in self._topics.items():
            wanted = FOLLOWED if name in interest.followed else int(name in interest.watched)
            samples = topic.samples(wanted, fresh=name in fresh, wall_s=wall_s, now_ns=now_ns)
            if samples:
                found[name] = tuple(samples)
        return found

    def rows(self, interest: Interest, now_s: float, begun_s: float) -> tuple[TopicRow, ...]:
        """Return a row for each topic of the bag and each that is wanted, sorted by name."""
        rows = {name: topic.row(now_s, begun_s) for name, topic in self._topics.items()}
        for name in interest.named - rows.keys():
            rows[name] = TopicRow(
                name, (), 0, 0, trouble=Trouble.NO_PUBLISHER, detail="not in this recording", facts=RECORDED
            )
        return tuple(rows[name] for name in sorted(rows))


def _tree_reader(kinds: Mapping[str, Sequence[TopicInBag]]) -> Callable[[bytes], dict[str, Value]]:
    """Return what decodes the messages of /tf and /tf_static in another representation."""
    found = [each.kind for name in FRAME_TOPICS for each in kinds.get(name, ())]

    def read(raw: bytes) -> dict[str, Value]:
        return bag_decoder(next(kind for kind in found if kind.name == TF_MESSAGE))(raw)

    return read
