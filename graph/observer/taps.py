"""Deck's subscriptions, and the rows and samples that result; why a topic shows nothing, in words."""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from graph.data import Interest, Sample, TopicRow, Trouble
from graph.frames.book import FRAME_TOPICS, TF_MESSAGE
from graph.heavy_types import IMAGES
from graph.messages.types import UnknownTypeError, not_subscribed
from graph.observer.rates import QUIET_S
from graph.observer.tap import FOLLOWED, LARGE_TYPES, Tap, first_depth
from graph.pictures.source import THINNED, host_of, is_away, picture_source, raw_from_afar, to_see
from graph.qos import TRANSIENT_LOCAL, Qos, mismatches, to_hear
from graph.scan import Scan, TopicEnds
from text.ros_names import TF_STATIC
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.node import Node

    from graph.frames.book import FrameBook


def structural(ends: TopicEnds, shown_type: str, unknown: UnknownTypeError | None) -> tuple[Trouble | None, str]:
    """Return what is wrong with the topic, regardless of its messages, and its detail.

    `shown_type` is the type that Deck decodes, `unknown` why it cannot.
    """
    if unknown is not None:
        return Trouble.UNKNOWN_TYPE, unknown.words
    if not ends.everyone_publishing:
        return Trouble.NO_PUBLISHER, ""
    # Two identical endpoints of one node give the same sentence.
    if found := list(dict.fromkeys(mismatches(ends.everyone_publishing, ends.subscribers))):
        words = say("{what} {mend}", what=found[0].what, mend=found[0].mend)
        more = len(found) - 1
        more_words = say("{what} (and {more} more such pairs)", what=words, more=more)
        return Trouble.QOS_MISMATCH, more_words if more else words
    if len(ends.type_names) > 1:
        types = ", ".join(ends.type_names)
        return None, say(
            "The endpoints use different types: {types}; shown is {shown}.", types=types, shown=shown_type
        )
    return None, ""


LINGER_S = 30.0
"""How long a subscription is kept that nobody wants any more: whoever changes tabs comes back."""
LIGHT_BYTES_PER_S = 50_000.0
"""Most that such a topic may cost."""
FAST_HZ = 20.0
"""What comes more often is left alone while nobody looks."""


class Taps:
    """All of Deck's subscriptions, kept in step with the graph and with what the screens want."""

    def __init__(self, node: Node, frames: FrameBook) -> None:
        """While frames are wanted, `frames` takes all of their messages."""
        self._node = node
        self._frames = frames
        self._taps: dict[str, Tap] = {}
        self._refused: dict[tuple[str, str, Qos], UnknownTypeError] = {}
        self._rows: dict[str, TopicRow] = {}
        """What is known without any message, by topic."""
        self._scan = Scan()
        self._interest = Interest()
        self._left_s: dict[str, float] = {}
        """Since when nobody wants a topic that is subscribed, Unix time."""
        self._fresh: set[str] = set()
        """Topics whose newest message is owed to a screen that has just begun to look."""
        self._sources: dict[str, str] = {}
        """Topic of which pictures are wanted to the one that they are taken from."""
        self._needed: frozenset[str] = frozenset()
        """Topics that are subscribed whether they exist or not."""
        self._frame_ids: dict[str, str] = {}
        """What headers have named on topics that are subscribed no more."""
        self._costly: set[str] = set()
        """Topics that have turned out to cost much since somebody has last looked at all."""
        self._host = b""
        """What identifiers of this machine begin with; empty as long as that is not known."""

    @property
    def any_open(self) -> bool:
        return bool(self._taps)

    def tune(self, scan: Scan, interest: Interest) -> None:
        """Open, reopen and close subscriptions to suit this graph and this interest."""
        self._fresh |= interest.watched - self._interest.watched
        self._fresh |= {
            topic
            for topic in interest.followed - self._interest.followed
            if topic in self._taps and self._taps[topic].qos.durability == TRANSIENT_LOCAL
        }
        sources = {topic: picture_source(topic, scan.topics) for topic in interest.pictures}
        self._fresh |= {source for topic, source in sources.items() if source != self._sources.get(topic)}
        self._sources, self._needed = sources, interest.named.union(sources.values())
        self._fresh &= self._needed
        if not interest.frames:
            self._frames.clear()
        self._scan, self._interest = scan, interest
        if interest.all_fast:
            self._costly.clear()
        self._host = next((host_of(end) for ends in scan.topics.values() for end in ends.own_publishers), b"")
        self._rows = {}
        for topic in (self._taps.keys() | self._frame_ids.keys()) - scan.topics.keys():
            self._close(topic)
            self._frame_ids.pop(topic, None)
        for topic, ends in scan.topics.items():
            unknown = self._tune_one(topic, ends)
            if topic in self._needed or topic in sources or not ends.is_deserted:
                self._rows[topic] = self._still_row(topic, ends, unknown)
        for topic in self._needed.union(sources) - scan.topics.keys():
            self._rows[topic] = self._still_row(topic, TopicEnds(topic, ()), None)
        self._rows = dict(sorted(self._rows.items()))

    def drain(self, serve_urgent: Callable[[], object]) -> dict[str, tuple[Sample, ...]]:
        """Take what has arrived, and return the samples that some screen wants.

        `serve_urgent` is called between two topics.
        """
        samples: dict[str, tuple[Sample, ...]] = {}
        for topic, tap in self._taps.items():
            serve_urgent()
            found = tap.drain(one_publisher=self._one_publisher(topic), decode=self._how_many(topic))
            if topic in self._fresh:
                found = found or tap.newest()
                if found:
                    self._fresh.discard(topic)
            if found:
                self._hand_out(topic, found, samples)
        return samples

    def _hand_out(self, topic: str, found: tuple[Sample, ...], samples: dict[str, tuple[Sample, ...]]) -> None:
        """Put the samples under each name by which they are wanted."""
        if topic in self._interest.named:
            samples[topic] = found
        for wanted, source in self._sources.items():
            if source == topic and wanted not in samples:
                samples[wanted] = tuple(replace(sample, topic=wanted) for sample in found)

    def need_tuning(self) -> bool:
        """Return whether a queue turned out to have the wrong depth or to cost much, or has lingered enough."""
        now_s = time.time()
        costly = set() if self._interest.all_fast else {topic for topic in self._taps if self._costs(topic, now_s)}
        news = costly - self._costly
        self._costly |= costly
        return (
            bool(news)
            or any(now_s - left_s >= LINGER_S for left_s in self._left_s.values())
            or any(
                tap.better_depth(one_publisher=self._one_publisher(topic)) != tap.depth
                for topic, tap in self._taps.items()
            )
        )

    def rows(self) -> tuple[TopicRow, ...]:
        """Return a row for each topic that exists or is wanted, sorted by name."""
        now_s = time.time()
        return tuple(self._row(topic, row, now_s) for topic, row in self._rows.items())

    def close(self) -> None:
        for topic in list(self._taps):
            self._close(topic)

    def _row(self, topic: str, row: TopicRow, now_s: float) -> TopicRow:
        if topic in self._taps:
            return replace(_measured(row, self._taps[topic], now_s), raw_from_afar=self._comes_raw(topic))
        source = self._sources.get(topic)
        if source in self._taps:
            return _seen_by(row, _measured(self._rows[source], self._taps[source], now_s))
        return replace(row, frame_id=self._frame_ids.get(topic, ""))

    def _comes_raw(self, topic: str) -> bool:
        ends = self._scan.topics.get(topic)
        return topic in self._sources and ends is not None and raw_from_afar(ends, self._host)

    def _tune_one(self, topic: str, ends: TopicEnds) -> UnknownTypeError | None:
        heard = bool(ends.everyone_publishing)
        measured = self._interest.all_topics and heard and not self._is_spared(topic, ends)
        wanted = topic in self._needed or measured
        if not wanted:
            if not self._lingers(topic):
                self._close(topic)
            return None
        self._left_s.pop(topic, None)
        tap = self._taps.get(topic)
        if tap and not heard:
            tap.since_s = time.time()
            return None
        return self._open(topic, ends)

    def _costs(self, topic: str, now_s: float) -> bool:
        meter = self._taps[topic].meter
        return (meter.hz(now_s) or 0) > FAST_HZ or (meter.bytes_per_s(now_s) or 0) > LIGHT_BYTES_PER_S

    def _is_spared(self, topic: str, ends: TopicEnds) -> bool:
        """Whether to leave a topic alone that nobody looks at: a camera fills a network."""
        if not self._interest.all_fast and (topic in self._costly or not LARGE_TYPES.isdisjoint(ends.type_names)):
            return True
        if IMAGES.isdisjoint(ends.type_names):
            return False
        spared = not self._interest.all_images or topic.endswith(THINNED)
        return spared or is_away(ends, self._host)

    def _open(self, topic: str, ends: TopicEnds) -> UnknownTypeError | None:
        type_name, qos = _type_to_show(ends), to_hear(ends.everyone_publishing)
        if topic in self._sources.values() and topic not in self._interest.named:
            qos = to_see(ends)
        every = self._interest.frames and topic in FRAME_TOPICS and type_name == TF_MESSAGE
        if every and topic == TF_STATIC:
            qos = _as_tf2_hears(ends)
        depth, meter = first_depth(type_name, every=every), None
        tap = self._taps.get(topic)
        if tap and tap.type_name == type_name:
            as_before = every == (tap.every is not None)
            if as_before:
                depth = tap.better_depth(one_publisher=self._one_publisher(topic))
            if as_before and tap.qos == qos and tap.depth == depth:
                return tap.unknown
            meter = tap.meter
        self._close(topic)
        key = (topic, type_name, qos)
        if key not in self._refused:
            # A second attempt would make rcl print its complaint on the terminal again.
            take = partial(self._frames.take, topic) if every else None
            try:
                self._taps[topic] = Tap(self._node, topic, type_name, qos, depth, meter, take)
            except UnknownTypeError as error:
                self._refused[key] = error
            except Exception as error:  # noqa: BLE001 - a second type under one name, for one
                reason = not_subscribed(topic, type_name, error)
                self._refused[key] = UnknownTypeError(reason)
        made = self._taps.get(topic)
        return made.unknown if made else self._refused[key]

    def _lingers(self, topic: str) -> bool:
        """Whether to keep a subscription that nobody wants now: it costs little, and another more.

        The middleware keeps a little of each subscription that there ever was.
        """
        tap, now_s = self._taps.get(topic), time.time()
        if tap is None or tap.every or tap.type_name in LARGE_TYPES | IMAGES:
            return False
        left_s = self._left_s.setdefault(topic, now_s)
        is_light = (tap.meter.bytes_per_s(now_s) or 0) <= LIGHT_BYTES_PER_S
        return is_light and 0 <= now_s - left_s < LINGER_S

    def _close(self, topic: str) -> None:
        self._left_s.pop(topic, None)
        tap = self._taps.pop(topic, None)
        if tap:
            # One that was made anew has heard nothing yet.
            self._frame_ids[topic] = tap.frame_id or self._frame_ids.get(topic, "")
            tap.close()

    def _one_publisher(self, topic: str) -> bool:
        ends = self._scan.topics.get(topic)
        return ends is not None and len(ends.everyone_publishing) == 1

    def _how_many(self, topic: str) -> int:
        if topic in self._interest.followed:
            return FOLLOWED
        return 1 if topic in self._interest.watched.union(self._sources.values()) else 0

    def _still_row(self, topic: str, ends: TopicEnds, unknown: UnknownTypeError | None) -> TopicRow:
        trouble, detail = structural(ends, _type_to_show(ends), unknown)
        return TopicRow(
            topic,
            ends.type_names,
            len(ends.publishers),
            len(ends.subscribers),
            trouble=trouble,
            detail=detail,
            published_by=ends.publishers,
            subscribed_by=ends.subscribers,
            own_publishers=len(ends.own_publishers),
            from_afar=is_away(ends, self._host),
        )


def _measured(row: TopicRow, tap: Tap, now_s: float) -> TopicRow:
    """Return the row with what the tap has measured."""
    trouble, detail = _trouble(row, tap, now_s)
    return replace(
        row,
        hz=tap.meter.hz(now_s),
        bytes_per_s=tap.meter.bytes_per_s(now_s),
        age_s=tap.meter.age_s(now_s),
        jitter_s=tap.meter.jitter_s(now_s),
        latency_s=tap.meter.latency_s(now_s),
        lost=tap.meter.lost,
        clock_off_s=tap.meter.clock_off_s(now_s),
        several_send=tap.meter.several_send(now_s),
        steady_hz=tap.meter.steady_hz(now_s),
        count=tap.meter.count,
        frame_id=tap.frame_id,
        measured=True,
        trouble=trouble,
        detail=detail,
    )


def _seen_by(row: TopicRow, source: TopicRow) -> TopicRow:
    """Return the row of a topic whose pictures are taken from another one."""
    return replace(
        row,
        age_s=source.age_s,
        frame_id=source.frame_id,
        pictures_from=source.name,
        trouble=source.trouble,
        detail=source.detail,
    )


def _trouble(row: TopicRow, tap: Tap, now_s: float) -> tuple[Trouble | None, str]:
    if row.trouble is not None:
        return row.trouble, row.detail
    if tap.broken:
        return Trouble.UNKNOWN_TYPE, tap.broken
    age_s = tap.meter.age_s(now_s)
    # A latched topic need not publish again.
    silent = tap.meter.is_quiet(now_s) and tap.qos.durability != TRANSIENT_LOCAL
    if now_s - tap.since_s > QUIET_S if age_s is None else silent:
        return Trouble.QUIET, ""
    return None, row.detail


def _as_tf2_hears(ends: TopicEnds) -> Qos:
    """Return a request that gets what is latched, even where another publisher latches nothing."""
    publishers = ends.everyone_publishing
    latched = [end for end in publishers if end.durability == TRANSIENT_LOCAL]
    return to_hear(latched or publishers)


def _type_to_show(ends: TopicEnds) -> str:
    """Return the type of most publishers; without publishers, the first type that anybody has."""
    if ends.everyone_publishing:
        counted = Counter(end.type_name for end in ends.everyone_publishing)
        return counted.most_common(1)[0][0]
    return ends.type_names[0] if ends.type_names else ""
