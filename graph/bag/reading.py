"""Reads recorded bags: a rosbag2 directory (MCAP, sqlite3), or one of its files.

What is read is what the files hold, whatever metadata.yaml says of them; differences are reported.
A bag that was cut short, by a crash or a full disk, is read as far as it goes.
"""

from __future__ import annotations

import heapq
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import TYPE_CHECKING, NamedTuple

from graph.bag import kinds
from graph.bag.decoding import TypeText
from graph.bag.differences import Note, notes_on
from graph.bag.errors import BagError, unreadable
from graph.bag.files import BagFiles, files_of, opened
from graph.bag.offers import Offer
from graph.bag.packed import unpacked
from graph.bag.part import CDR, Lost
from text.sentences import Words, say

if TYPE_CHECKING:
    from pathlib import Path

    from typing_extensions import Self

    from graph.bag.part import BagPart, Channel


@dataclass(frozen=True)
class TopicInBag:
    """One topic of a bag, of one type."""

    name: str
    """Its full name, to which ROS resolves one that is recorded without its slash."""
    kind: TypeText
    messages: int
    reliability: str = ""
    durability: str = ""
    """QoS offered by its first publisher: `reliable`, `volatile`; empty if the bag does not say."""
    encoding: str = CDR
    """Serialization format."""
    recorded: str = ""
    """Its name as the file has it."""


class _Place(NamedTuple):
    """Where a message is, for one that cannot be unpacked."""

    part: int
    number: int
    stamp_ns: int


class Bag:
    """An open bag; close it, or use it in a `with`."""

    def __init__(self, files: BagFiles, parts: Sequence[BagPart], notes: Sequence[Note]) -> None:
        """Use `open_bag` to make one."""
        self.path = files.path
        self.files = tuple(part.file for part in parts)
        """What is read."""
        self.notes = tuple(note.words for note in notes)
        """All that differs from what the bag says of itself, and what is missing."""
        self.is_incomplete = any(note.incomplete for note in notes)
        """Whether messages are known to be missing."""
        self.is_cut = any(part.cut_bytes is not None for part in parts)
        """Whether a file was not ended properly."""
        self.distro = _distro(files, parts)
        """ROS distribution that wrote it, empty if that is not known."""
        self._parts = parts
        self._topics = _topics(files, parts)
        self.all_topics = tuple(sorted(set(self._topics.values()), key=lambda topic: (topic.name, topic.recorded)))
        """Every topic, sorted by name, those in other serialization formats too."""
        self.topics = tuple(topic for topic in self.all_topics if topic.encoding == CDR)
        """Every topic of ROS 2, sorted by name."""
        self._not_unpacked: set[_Place] = set()
        self._fewer: Words | None = None
        with_messages = [part for part in parts if part.end_ns]
        self.start_ns = min((part.start_ns for part in with_messages), default=0)
        self.end_ns = max((part.end_ns for part in with_messages), default=0)
        """Unix time of the first and of the last message; equal in an empty bag."""
        self.messages_count = sum(topic.messages for topic in self.topics)

    @property
    def name(self) -> str:
        return self.path.stem if self.path.suffix in kinds.SUFFIXES else self.path.name

    @property
    def damage(self) -> Words | None:
        """What has been left out so far as unreadable; grows while messages are read."""
        lost = [lost for part in self._parts for lost in part.lost]
        lost += (Lost(place.stamp_ns, 1) for place in self._not_unpacked)
        if not lost:
            return self._fewer
        first_ns = min(each.at_ns for each in lost)
        return say(
            "{path} is damaged: messages lost: {messages}, damaged places: {places}, the first "
            "{seconds:.1f} s after the beginning. All others are played",
            path=self.path,
            messages=_lost_words(lost),
            places=len(lost),
            seconds=max(0, first_ns - self.start_ns) / 1e9,
        )

    @property
    def length_s(self) -> float:
        """Seconds from the first message to the last."""
        return (self.end_ns - self.start_ns) / 1e9

    def messages(
        self, start_ns: int | None = None, names: Collection[str] = ()
    ) -> Iterator[tuple[TopicInBag, int, bytes]]:
        """Yield topic, unix time in nanoseconds and raw message in the order of their times.

        `names`: of which topics, all if empty. What is damaged is left out, see `damage`.
        """
        wanted = [topic for topic in self.topics if not names or topic.name in names]
        parts = (self._of_part(n, start_ns, frozenset(wanted)) for n in range(len(self._parts)))
        read = 0
        for topic, stamp_ns, raw in heapq.merge(*parts, key=itemgetter(1)):
            if topic is not None:
                yield topic, stamp_ns, raw
                read += 1
        if start_ns is None or start_ns <= self.start_ns:
            self._count(read, sum(topic.messages for topic in wanted))

    def _count(self, read: int, said: int) -> None:
        """Compare what has been read of some topics with what the files say they hold."""
        lost = sum(lost.messages or 0 for part in self._parts for lost in part.lost)
        if read + lost + len(self._not_unpacked) < said:
            self._fewer = say(
                "{path} is damaged: of {said} messages only {read} could be read",
                path=self.path,
                said=said,
                read=read,
            )

    def _of_part(
        self, part_number: int, start_ns: int | None, wanted: frozenset[TopicInBag]
    ) -> Iterator[tuple[TopicInBag | None, int, bytes]]:
        part = self._parts[part_number]
        # The merge takes one from each before it begins; not all files should be read by then.
        yield None, part.start_ns, b""
        numbers = {
            channel.number: topic
            for channel in part.channels
            if (topic := self._topics[part_number, channel.number]) in wanted
        }
        for stamp_ns, number, raw in part.messages(start_ns, numbers):
            message = unpacked(raw)
            if message is None:
                self._not_unpacked.add(_Place(part_number, number, stamp_ns))
            else:
                yield numbers[number], stamp_ns, message

    def close(self) -> None:
        """Let go of the files."""
        _close(self._parts)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def open_bag(path: Path) -> Bag:
    """Open a bag. Raises BagError with words that name the file and the fix."""
    files = files_of(path)
    _refuse_packed(files)
    with ExitStack() as stack:
        parts: list[BagPart] = []
        stack.callback(_close, parts)
        errors = _open_all(files.named, parts)
        left_out = _open_others(files, parts, errors)
        if not parts:
            raise unreadable(path, errors[0])
        bag = Bag(files, parts, notes_on(files, parts, errors, left_out))
        if not bag.topics and bag.all_topics:
            reason = bag.notes[-1]
            raise BagError(say("{path} cannot be read: {reason}", path=path, reason=reason))
        stack.pop_all()
    return bag


def _lost_words(lost: Sequence[Lost]) -> int | Words:
    """Return how many messages have been lost, as far as that can be known."""
    known = sum(each.messages or 0 for each in lost)
    if all(each.messages is not None for each in lost):
        return known
    return say("at least {count}", count=known) if known else say("how many cannot be known")


def _close(parts: Sequence[BagPart]) -> None:
    for part in parts:
        part.close()


def _refuse_packed(files: BagFiles) -> None:
    """Raise BagError for a bag that is packed by something that Deck does not know."""
    packed_by = files.stated.compression if files.stated else ""
    if packed_by.lower() not in {"", kinds.ZSTD}:
        raise BagError(
            say(
                "{path} cannot be read: it is packed by {kind}, and only zstd is known",
                path=files.path,
                kind=packed_by,
            )
        )


def _open_all(files: Sequence[Path], parts: list[BagPart]) -> list[BagError]:
    """Append what can be opened to `parts`; return why the others cannot."""
    errors = []
    for file in files:
        try:
            parts.append(opened(file))
        except BagError as error:  # noqa: PERF203 - one broken file does not cost the others
            errors.append(error)
    return errors


def _open_others(files: BagFiles, parts: list[BagPart], errors: list[BagError]) -> list[Path]:
    """Open files that the metadata do not name, but none that is a copy; return those left out."""
    spans = [(part.start_ns, part.end_ns) for part in parts if part.end_ns]
    others: list[BagPart] = []
    errors += _open_all(files.others, others)
    left_out = []
    for part in others:
        if any(part.start_ns <= end_ns and begin_ns <= part.end_ns for begin_ns, end_ns in spans):
            left_out.append(part.file)
            part.close()
        else:
            parts.append(part)
    return left_out


def _topics(files: BagFiles, parts: Sequence[BagPart]) -> Mapping[tuple[int, int], TopicInBag]:
    """Return for part and channel the topic that it belongs to."""
    channels = {(place, channel.number): channel for place, part in enumerate(parts) for channel in part.channels}
    stated, distro = files.stated, _distro(files, parts)
    texts = {each.kind.name: each.kind for each in channels.values() if each.kind.text}
    offers = {topic.name: topic.offer for topic in stated.topics} if stated else {}
    merged: dict[tuple[str, TypeText, str], TopicInBag] = {}
    keys = {}
    for place, channel in channels.items():
        kind = channel.kind
        if not kind.text:
            # Another file of the bag may have it.
            kind = texts.get(kind.name, kind._replace(distro=distro))
        key = keys[place] = (channel.topic, kind, channel.encoding)
        merged[key] = _with(merged.get(key), channel, kind, offers.get(channel.topic, Offer()))
    return {place: merged[key] for place, key in keys.items()}


def _distro(files: BagFiles, parts: Sequence[BagPart]) -> str:
    stated = files.stated.distro if files.stated else ""
    return stated or next((part.distro for part in parts if part.distro), "")


def _with(topic: TopicInBag | None, channel: Channel, kind: TypeText, stated: Offer) -> TopicInBag:
    """Return a topic with another channel of its own; without QoS in the file the metadata's."""
    if topic is not None:
        return replace(topic, messages=topic.messages + channel.messages)
    return TopicInBag(
        channel.topic if channel.topic.startswith("/") else f"/{channel.topic}",
        kind,
        channel.messages,
        channel.reliability or stated.reliability,
        channel.durability or stated.durability,
        channel.encoding,
        channel.topic,
    )
