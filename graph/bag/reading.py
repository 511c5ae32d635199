"""Reads recorded bags: a rosbag2 directory (MCAP, sqlite3), or one of its files.

What is read is what the files hold, whatever metadata.yaml says of them: what is missing is counted against what it
and the files themselves state. A bag that was cut short, by a crash or a full disk, is read as far as it goes.
"""

from __future__ import annotations

import heapq
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import TYPE_CHECKING, NamedTuple

from graph.bag.errors import BagError, unreadable
from graph.bag.files import SUFFIXES, BagFiles, Offer, Stated, files_of
from graph.bag.parts import CDR, BagPart, Channel, opened, unpacked
from graph.messages.definitions import TypeText
from text.sentences import Words, say

if TYPE_CHECKING:
    from pathlib import Path

    from typing_extensions import Self


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


class Note(NamedTuple):
    """Something about a bag that whoever opens it has to know."""

    words: str
    incomplete: bool = False
    """Whether messages are missing that the recording should have."""


def open_bag(path: Path) -> Bag:
    """Open a bag. Raises BagError with words that name the file and the fix."""
    files = files_of(path)
    parts: list[BagPart] = []
    errors: list[BagError] = []
    for file in files.named:
        try:
            parts.append(opened(file))
        except BagError as error:  # noqa: PERF203 - one broken file does not cost the others
            errors.append(error)
    if not parts:
        raise unreadable(path, errors[0])
    bag = Bag(files, parts, errors)
    if not bag.topics and bag.all_topics:
        bag.close()
        raise BagError(say("{path} cannot be read: {reason}", path=path, reason=bag.notes[-1]))
    return bag


class Bag:
    """An open bag; close it, or use it in a `with`."""

    def __init__(self, files: BagFiles, parts: Sequence[BagPart], unread: Sequence[BagError]) -> None:
        """Use `open_bag` to make one; `unread` is why other files cannot be opened."""
        self.path = files.path
        self.files = tuple(part.file for part in parts)
        """What is read."""
        notes = [Note(error.words, incomplete=True) for error in unread]
        notes += _notes_on(files, parts)
        self.notes = tuple(note.words for note in notes)
        """All that differs from what the bag says of itself, and what is missing."""
        self.is_incomplete = any(note.incomplete for note in notes)
        """Whether messages are known to be missing."""
        self.is_cut = any(part.cut_bytes is not None for part in parts)
        """Whether a file was not ended properly."""
        self.distro = files.stated.distro if files.stated else ""
        """ROS distribution that wrote it, empty if that is not known."""
        self._parts = parts
        self._topics = _topics(files.stated, parts)
        self.all_topics = tuple(sorted(set(self._topics.values()), key=lambda topic: (topic.name, topic.recorded)))
        """Every topic, sorted by name, those in other serialization formats too."""
        self.topics = tuple(topic for topic in self.all_topics if topic.encoding == CDR)
        """Every topic of ROS 2, sorted by name."""
        self.damage: Words | None = None
        """What has turned out to be missing when all was read."""
        with_messages = [part for part in parts if part.end_ns]
        self.start_ns = min((part.start_ns for part in with_messages), default=0)
        self.end_ns = max((part.end_ns for part in with_messages), default=0)
        """Unix time of the first and of the last message; equal in an empty bag."""
        self.messages_count = sum(topic.messages for topic in self.topics)

    @property
    def name(self) -> str:
        return self.path.stem if self.path.suffix in SUFFIXES else self.path.name

    @property
    def length_s(self) -> float:
        """Seconds from the first message to the last."""
        return (self.end_ns - self.start_ns) / 1e9

    def messages(
        self, start_ns: int | None = None, names: Collection[str] = ()
    ) -> Iterator[tuple[TopicInBag, int, bytes]]:
        """Yield topic, unix time in nanoseconds and raw message in the order of their times.

        `names`: of which topics, all if empty. A file is read up to where it is damaged, see `damage`. Raises
        BagError for a database that turns out to be damaged.
        """
        wanted = [topic for topic in self.topics if not names or topic.name in names]
        parts = (self._of_part(place, start_ns, frozenset(wanted)) for place in range(len(self._parts)))
        read = 0
        for topic, stamp_ns, raw in heapq.merge(*parts, key=itemgetter(1)):
            if topic is not None:
                yield topic, stamp_ns, raw
                read += 1
        if start_ns is None or start_ns <= self.start_ns:
            said = sum(topic.messages for topic in wanted)
            if read < said:
                self.damage = say(
                    "{path} is damaged: of {said} messages only {read} could be read",
                    path=self.path,
                    said=said,
                    read=read,
                )

    def _of_part(
        self, place: int, start_ns: int | None, wanted: frozenset[TopicInBag]
    ) -> Iterator[tuple[TopicInBag | None, int, bytes]]:
        part = self._parts[place]
        # The merge takes one from each before it begins; not all files should be read by then.
        yield None, part.start_ns, b""
        numbers = {
            channel.number: topic
            for channel in part.channels
            if (topic := self._topics[place, channel.number]) in wanted
        }
        for stamp_ns, number, raw in part.messages(start_ns, numbers):
            if (message := unpacked(raw)) is not None:
                yield numbers[number], stamp_ns, message

    def close(self) -> None:
        """Let go of the files."""
        for part in self._parts:
            part.stack.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _topics(stated: Stated | None, parts: Sequence[BagPart]) -> Mapping[tuple[int, int], TopicInBag]:
    """Return for part and channel the topic that it belongs to."""
    channels = {(place, channel.number): channel for place, part in enumerate(parts) for channel in part.channels}
    texts = {each.kind.name: each.kind for each in channels.values() if each.kind.text}
    offers = stated.offers if stated else {}
    merged: dict[tuple[str, TypeText, str], TopicInBag] = {}
    keys = {}
    for place, channel in channels.items():
        kind = channel.kind
        if not kind.text:
            # Another file of the bag may have it.
            kind = texts.get(kind.name, kind._replace(distro=stated.distro if stated else ""))
        key = keys[place] = (channel.topic, kind, channel.encoding)
        if (topic := merged.get(key)) is not None:
            merged[key] = replace(topic, messages=topic.messages + channel.messages)
            continue
        offer = offers.get(channel.topic, Offer())
        merged[key] = TopicInBag(
            channel.topic if channel.topic.startswith("/") else f"/{channel.topic}",
            kind,
            channel.messages,
            channel.offer.reliability or offer.reliability,
            channel.offer.durability or offer.durability,
            channel.encoding,
            channel.topic,
        )
    return {place: merged[key] for place, key in keys.items()}


def _notes_on(files: BagFiles, parts: Sequence[BagPart]) -> Iterator[Note]:
    """Yield what differs between what is stated and what is there, and what in it is not ROS 2's."""
    channels = [channel for part in parts for channel in part.channels]
    if files.stated is not None and files.stated.trouble is not None:
        yield Note(files.stated.trouble)
    elif files.stated is not None:
        for name in files.missing:
            # It may only be called otherwise now: the counts tell.
            words = say("metadata.yaml names {file}, which is not there", file=name)
            yield Note(words, incomplete=not files.stated.messages)
        for file in files.others:
            yield Note(say("{file} is not read: metadata.yaml does not name it", file=file.name))
        yield from _counts(files.stated, channels)
    for part in parts:
        held = sum(channel.messages for channel in part.channels)
        if part.cut_bytes is not None:
            words = say(
                "{path} was cut short, or is damaged: {messages} messages are intact, the last {bytes} bytes cannot "
                "be read",
                path=files.path if len(parts) == 1 else part.file.name,
                messages=held,
                bytes=part.cut_bytes,
            )
            yield Note(words, incomplete=True)
        if part.said is not None and held < part.said:
            words = say(
                "{file} counts {said} messages of its own, and holds {held}",
                file=part.file.name,
                said=part.said,
                held=held,
            )
            yield Note(words, incomplete=True)
    yield from _foreign(channels)


def _foreign(channels: Sequence[Channel]) -> Iterator[Note]:
    foreign = Counter[str]()
    for channel in channels:
        if channel.encoding != CDR:
            foreign[f"{channel.topic} ({channel.encoding}"] += channel.messages
    if foreign:
        named = ", ".join(f"{topic}: {count})" for topic, count in sorted(foreign.items()))
        yield Note(say("left out, since their serialization format is not ROS 2's: {topics}", topics=named))


def _counts(stated: Stated, channels: Sequence[Channel]) -> Iterator[Note]:
    """Yield whether the files hold another number of messages than the metadata count."""
    held = sum(channel.messages for channel in channels if channel.encoding == CDR or channel.topic in stated.offers)
    if stated.messages is not None and held != stated.messages:
        yield Note(count_words(stated.messages, held), incomplete=held < stated.messages)


def count_words(said: int, held: int) -> Words:
    """Say that the metadata count another number of messages than there are."""
    return say("metadata.yaml counts {said} messages, the files hold {held}", said=said, held=held)
