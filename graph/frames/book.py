"""Every frame that has been heard of on /tf and /tf_static."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.frames.reading import Names, TransformReader
from graph.frames.record import FrameRecord
from graph.frames.senders import Publishers
from text.ros_names import TF, TF_STATIC

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from graph.data import FrameRow, Value

FRAME_TOPICS = frozenset({TF, TF_STATIC})
MOST_FRAMES = 2000
"""Frames that are kept; whoever comes later is not shown."""
FORGOTTEN_S = 10.0
"""A moving frame that has been silent for so long, as long as tf2 remembers, makes room."""
ROOM_AGAIN_S = 1.0
MOST_LISTED = 20_000
"""Records in all lists, so that messages with other names each time do not fill the memory."""


class FrameBook:
    """Takes the messages of both topics, and gives a row for every frame in each of its parents."""

    def __init__(self, decode: Callable[[bytes], Mapping[str, Value]]) -> None:
        """`decode` makes a tree of a message that is not in little-endian CDR."""
        self._readers = {topic: TransformReader(decode) for topic in FRAME_TOPICS}
        self._records: dict[tuple[str, str, bool], FrameRecord] = {}
        self._lists: dict[tuple[bool, Names], list[FrameRecord | None]] = {}
        """The records of a message with these names; None for those that find no room."""
        self._listed = 0
        self._publishers = {topic: Publishers() for topic in FRAME_TOPICS}
        self._messages = 0
        self._is_full = False
        """Whether a frame has found no room since room was made."""
        self._made_room_s = 0.0

    def clear(self) -> None:
        self._records.clear()
        self._lists.clear()

    def take(
        self, topic: str, raw: bytes, arrived_s: float, number: int | None = None, sender: bytes | None = None
    ) -> None:
        """Take a message, with its `number` at its publisher, if the middleware counts.

        `sender` is the gid of that publisher, if the middleware tells.
        Raises what `TransformReader.read` raises.
        """
        names, found = self._readers[topic].read(raw)
        key = (topic == TF_STATIC, names)
        records = self._lists.get(key)
        if records is None:
            records = self._open(names, arrived_s, static=key[0])
        if number is None:
            number = self._messages = self._messages + 1
        for record, fields in zip(records, found, strict=True):
            if record is not None:
                record.take(fields, arrived_s, number, sender)

    def published_by(self, topic: str, there: Mapping[bytes, str], now_s: float) -> None:
        """Say who publishes one of the topics now: the gid of each publisher to its node.

        The name is empty while it is unknown.
        """
        self._publishers[topic].are(there, now_s)

    def rows(self, now_s: float) -> tuple[FrameRow, ...]:
        """Return the rows at this unix time, sorted by frame and parent."""
        if self._is_full and abs(now_s - self._made_room_s) > ROOM_AGAIN_S:
            self._make_room(now_s)
        moving, static = self._publishers[TF], self._publishers[TF_STATIC]
        return tuple(record.row(now_s, static if record.static else moving) for record in self._records.values())

    def _open(self, names: Names, arrived_s: float, *, static: bool) -> list[FrameRecord | None]:
        known = len(self._records)
        records = [self._record(parent, child, arrived_s, static=static) for parent, child in names]
        if len(self._records) != known:
            in_order = sorted(self._records.items(), key=lambda each: (each[0][1], each[0]))
            self._records = dict(in_order)
        self._listed += len(records) + 1
        if self._listed > MOST_LISTED:
            self._lists.clear()
            self._listed = len(records) + 1
        self._lists[static, names] = records
        return records

    def _record(self, parent: str, child: str, arrived_s: float, *, static: bool) -> FrameRecord | None:
        bare = parent.removeprefix("/"), child.removeprefix("/")
        made = FrameRecord(*bare, arrived_s, static=static)
        key = (*made.names, static)
        record = self._records.get(key)
        if record is None:
            if len(self._records) >= MOST_FRAMES:
                self._is_full = True
                return None
            record = self._records[key] = made
        record.slashed = record.slashed or bare != (parent, child)
        return record

    def _make_room(self, now_s: float) -> None:
        """Forget moving frames that are long silent, and let all others try again."""
        self._made_room_s, self._is_full = now_s, False
        self._lists.clear()
        self._records = {
            key: record
            for key, record in self._records.items()
            if record.static or now_s - record.arrived_s <= FORGOTTEN_S
        }
