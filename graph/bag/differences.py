"""What differs between a bag's metadata.yaml and its files, and what in them is not ROS 2's."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

from graph.bag import kinds
from graph.bag.part import CDR
from text.sentences import Words, say

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from graph.bag.errors import BagError
    from graph.bag.files import BagFiles
    from graph.bag.part import BagPart, Channel
    from graph.bag.stated import Stated, StatedTopic

NAMED = 5
"""So many topics are named in a sentence; of more only the number."""


class Note(NamedTuple):
    """Something about a bag that whoever opens it has to know."""

    words: Words
    incomplete: bool = False
    """Whether messages are missing that the recording should have."""


def notes_on(
    files: BagFiles, parts: Sequence[BagPart], unread: Sequence[BagError], left_out: Sequence[Path]
) -> list[Note]:
    """Return all that differs; `unread`: why files cannot be opened; `left_out`: files not read."""
    found = [Note(error.words, incomplete=True) for error in unread]
    if files.stated is not None:
        found += _against_metadata(files, files.stated, parts, left_out)
    found += (Note(words, incomplete=True) for words in _cut(files.path, parts))
    found += _by_own_count(parts)
    found += _foreign(parts)
    return found


def _against_metadata(
    files: BagFiles, stated: Stated, parts: Sequence[BagPart], left_out: Sequence[Path]
) -> Iterator[Note]:
    if stated.trouble is not None:
        yield Note(stated.trouble)
        return
    for name in files.missing:
        # It may only be called otherwise now: the counts tell.
        words = say("metadata.yaml names {file}, which is not there", file=name)
        yield Note(words, incomplete=not stated.messages)
    read = [part.file for part in parts]
    for file in files.others:
        if file in left_out:
            words = say(
                "{file} is not read: metadata.yaml does not name it, and its messages are of the "
                "same time as those of other files",
                file=file.name,
            )
            yield Note(words)
        elif file in read:
            words = say("{file} is read, too: metadata.yaml does not name it", file=file.name)
            yield Note(words)
    yield from _storages(files, stated, parts)
    yield from _counts(stated, parts)
    yield from _types(stated, parts)


def _storages(files: BagFiles, stated: Stated, parts: Sequence[BagPart]) -> Iterator[Note]:
    named = {kinds.storage_of_name(part.file) for part in parts} - {""}
    if not stated.storage or not named or stated.storage in named:
        return
    words = say(
        "metadata.yaml names the storage {storage}, {file} is {kind}",
        storage=stated.storage,
        file=files.named[0].name,
        kind=", ".join(sorted(named)),
    )
    yield Note(words)


def _counts(stated: Stated, parts: Sequence[BagPart]) -> Iterator[Note]:
    said = Counter({topic.name: topic.messages for topic in stated.topics})
    if stated.messages is None and not said:
        return
    held: Counter[str] = Counter()
    for channel in _channels(parts):
        if channel.encoding == CDR or channel.topic in said:
            held[channel.topic] += channel.messages
    whole = max(stated.messages or 0, said.total())
    fewer = {name: count for name, count in said.items() if held[name] < count}
    if held.total() < whole or fewer:
        words = count_words(whole, held.total(), _by_topic(fewer, held))
        yield Note(words, incomplete=True)
    elif held.total() > whole and not any(part.cut_bytes is not None for part in parts):
        more = {name: said[name] for name in held if held[name] > said[name]}
        yield Note(count_words(whole, held.total(), _by_topic(more, held)))


def count_words(said: int, held: int, topics: str = "") -> Words:
    """Say that the metadata count another number of messages than there are."""
    return say(
        "metadata.yaml counts {said} messages, the files hold {held}{topics}", said=said, held=held, topics=topics
    )


def _by_topic(said: Mapping[str, int], held: Mapping[str, int]) -> str:
    """Return `: /a 40, here 20; ...`."""
    if not said:
        return ""
    named = [f"{name} {said[name]} → {held[name]}" for name in sorted(said)]
    return ": " + _some(named)


def _types(stated: Stated, parts: Sequence[BagPart]) -> Iterator[Note]:
    by_name: dict[str, list[Channel]] = {}
    for channel in _channels(parts):
        by_name.setdefault(channel.topic, []).append(channel)
    for topic in stated.topics:
        channels = by_name.get(topic.name, [])
        types = {channel.kind.name for channel in channels}
        if types and topic.type_name and topic.type_name not in types:
            words = say(
                "metadata.yaml gives {topic} the type {stated}, the files {found}; these count",
                topic=topic.name,
                stated=topic.type_name,
                found=", ".join(sorted(types)),
            )
            yield Note(words)
        encodings = {channel.encoding for channel in channels}
        if encodings and topic.encoding and topic.encoding not in encodings:
            words = say(
                "metadata.yaml gives {topic} the serialization format {stated}, the files {found}; these count",
                topic=topic.name,
                stated=topic.encoding,
                found=", ".join(sorted(encodings)),
            )
            yield Note(words)
        yield from _offers(topic, channels)


def _offers(topic: StatedTopic, channels: Sequence[Channel]) -> Iterator[Note]:
    """Yield where the QoS of the metadata is another than that of the files, by which is played."""
    for channel in channels:
        pairs = ((channel.reliability, topic.offer.reliability), (channel.durability, topic.offer.durability))
        other = [(held, said) for held, said in pairs if held and said and held != said]
        if other:
            words = say(
                "metadata.yaml gives {topic} the QoS {stated}, the files {found}; these count",
                topic=topic.name,
                stated=", ".join(said for _held, said in other),
                found=", ".join(held for held, _said in other),
            )
            yield Note(words)
            return


def _cut(path: Path, parts: Sequence[BagPart]) -> list[Words]:
    """Tell of each file that ends too early: of a split recording others may follow it."""
    return [
        say(
            "{path} was cut short: the recording was not ended properly. {messages} messages "
            "are intact, the last {bytes} bytes are damaged, and nothing follows them",
            path=path if len(parts) == 1 else part.file.name,
            messages=sum(channel.messages for channel in part.channels),
            bytes=part.cut_bytes,
        )
        for part in parts
        if part.cut_bytes is not None
    ]


def _by_own_count(parts: Sequence[BagPart]) -> Iterator[Note]:
    for part in parts:
        held = sum(channel.messages for channel in part.channels)
        lost = sum(lost.messages or 0 for lost in part.lost)
        if part.said is not None and held + lost < part.said:
            words = say(
                "{file} counts {said} messages of its own, and holds {held}",
                file=part.file.name,
                said=part.said,
                held=held,
            )
            yield Note(words, incomplete=True)


def _foreign(parts: Sequence[BagPart]) -> list[Note]:
    found: Counter[tuple[str, str]] = Counter()
    for channel in _channels(parts):
        if channel.encoding != CDR:
            found[channel.topic, channel.encoding] += channel.messages
    if not found:
        return []
    named = [f"{topic} ({encoding}: {count})" for (topic, encoding), count in sorted(found.items())]
    words = say("left out, since their serialization format is not ROS 2's: {topics}", topics=_some(named))
    return [Note(words)]


def _channels(parts: Sequence[BagPart]) -> Iterator[Channel]:
    for part in parts:
        yield from part.channels


def _some(named: Sequence[str]) -> str:
    more = len(named) - NAMED
    return ", ".join(named[:NAMED]) + (f", … (+{more})" if more > 0 else "")
