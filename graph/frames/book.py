"""Every frame that has been heard of on /tf and /tf_static."""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING, Any, NamedTuple

from graph.data import FrameRow
from graph.frames.senders import TOGETHER_S, Fields, Publishers, Senders
from graph.messages.definitions import TypeText, bag_decoder
from space.buffer import Stamped
from space.transform import IDENTITY, Transform
from text.ros_names import TF, TF_STATIC
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping

WINDOW_S = 5.0
"""Of the rate, and how long a transform that was not taken is spoken of."""
FEW = 3
"""Points of the rate that are kept whatever their age, so that a slow frame has one, too."""
TURNS = 3
"""So often within the window publishers change, or their numbers go back, only if several take
turns."""
CHANGES = 3
"""So many within the window: a parameter that somebody sets makes fewer."""
LONGEST_NAME = 200
"""Characters that are kept of a name."""
TOLERANCE = 0.01
"""How far the squared length of a quaternion may be from 1. Source: tf2, buffer_core.cpp."""
INFINITE = math.inf
NANOSECONDS = 1e-9
TF_MESSAGE = "tf2_msgs/msg/TFMessage"


class _Counted(NamedTuple):
    """How many transforms had come by the arrival of the newest."""

    arrived_s: float
    taken: int
    turns: int


class FrameRecord:
    """One frame in one parent on one of the two topics."""

    def __init__(self, parent: str, child: str, arrived_s: float, *, static: bool) -> None:
        """Begin to count; the names are without a leading slash."""
        self.names = (_kept(parent), _kept(child))
        self.static = static
        self.slashed = False
        """Whether somebody publishes it with a leading slash."""
        self.count = 0
        self.arrived_s = arrived_s
        """When the newest came, unix time."""
        self._wrong_name = _wrong_name(parent, child)
        self._good: Fields = ()
        """Of the newest that was taken."""
        self._bad: Fields = ()
        self._bad_s = -INFINITE
        self._faults = 0
        self._changes: deque[float] = deque(maxlen=CHANGES)
        """When a static one came with other numbers."""
        self._rivals = False
        self._number = -1
        self._turns = 0
        """How often another publisher than before has sent one that moves, as far as is known."""
        self._points: deque[_Counted] = deque()
        self._senders = Senders()

    def take(self, fields: Fields, arrived_s: float, number: int, sender: bytes | None) -> None:
        """Take the next transform; `number` counts the messages of its publisher, `sender`."""
        self.count += 1
        if self.count == 1:
            self._points.append(_Counted(arrived_s, 1, 0))
        passed_s = arrived_s - self.arrived_s
        if sender != self._senders.newest:
            turned = self.count > 1
            self._senders.hand_over(sender, self.arrived_s, self._good, passed_s)
        else:
            # The numbers of one publisher do not go back.
            turned = sender is None and number <= self._number
        if turned and not self.static:
            self._turns += 1
        self._number, self.arrived_s = number, arrived_s
        _, x, y, z, a, b, c, d = fields
        # Written so that any comparison with NaN fails.
        if (
            -TOLERANCE < a * a + b * b + c * c + d * d - 1.0 < TOLERANCE
            and -INFINITE < x < INFINITE
            and -INFINITE < y < INFINITE
            and -INFINITE < z < INFINITE
            and not self._wrong_name
        ):
            if self.static and self._good and self._good[1:] != fields[1:]:
                self._changes.append(arrived_s)
                # A node that is started anew takes longer.
                self._rivals = self._rivals or (turned and passed_s < TOGETHER_S)
            self._good = fields
        else:
            self._bad, self._bad_s = fields, arrived_s
            self._faults += 1

    def row(self, now_s: float, topic: Publishers) -> FrameRow:
        """Return what is known at `now_s`; `topic` are the publishers of its topic."""
        self._mark()
        who = self._senders.who(topic, self.arrived_s, now_s, latched=self.static)
        good = self._good
        stamp_s = (good or self._bad)[0]
        transform = Transform.of(good[1:4], good[4:]) if good else IDENTITY
        parent, child = self.names
        return FrameRow(
            Stamped(parent, child, stamp_s, transform, self.static),
            self.count,
            None if self.static else self._hz(),
            max(0.0, now_s - self.arrived_s),
            self.arrived_s - stamp_s,
            *who,
            self._fault(now_s),
            self._faults,
            self.slashed,
            self._keeps_changing(now_s) or self._has_rivals(topic, now_s),
            self._points[-1].turns - self._points[0].turns >= TURNS,
        )

    def _mark(self) -> None:
        points = self._points
        if points[-1].taken != self.count:
            points.append(_Counted(self.arrived_s, self.count, self._turns))
        while len(points) > FEW and self.arrived_s - points[0].arrived_s > WINDOW_S:
            points.popleft()

    def _hz(self) -> float | None:
        first, last = self._points[0], self._points[-1]
        span_s = last.arrived_s - first.arrived_s
        return (last.taken - first.taken) / span_s if span_s > 0 else None

    def _keeps_changing(self, now_s: float) -> bool:
        return len(self._changes) == CHANGES and now_s - self._changes[0] < WINDOW_S

    def _has_rivals(self, topic: Publishers, now_s: float) -> bool:
        senders = self._senders
        if senders.newest is None or senders.newest not in topic.known:
            return self._rivals
        return self.static and senders.disagree(topic, self._good, self.arrived_s, now_s)

    def _fault(self, now_s: float) -> str:
        if now_s - self._bad_s > WINDOW_S and self._good:
            return ""
        return self._wrong_name or (_wrong_numbers(self._bad) if self._bad else "")


def _kept(name: str) -> str:
    return name if len(name) <= LONGEST_NAME else f"{name[: LONGEST_NAME - 1]}…"


def _wrong_name(parent: str, child: str) -> str:
    """Say what is wrong with the names, empty if nothing is."""
    if not child:
        return say("its child_frame_id is empty")
    if not parent:
        return say("its header.frame_id is empty")
    if parent == child:
        return say("it is its own parent")
    longest = max(len(parent), len(child))
    return say("its name has {count} characters", count=longest) if longest > LONGEST_NAME else ""


def _wrong_numbers(fields: Fields) -> str:
    """Say why the numbers are no transform."""
    moved, turned = fields[1:4], fields[4:]
    if not all(map(math.isfinite, moved)):
        return say("its translation is not finite: {numbers}", numbers=_listed(moved))
    if not all(map(math.isfinite, turned)):
        return say("its quaternion is not finite: {numbers}", numbers=_listed(turned))
    length = math.hypot(*turned)
    if not length:
        return say("its quaternion is all zeros, where no rotation is 0, 0, 0, 1")
    return say("its quaternion has the length {length:.4g} in place of 1", length=length)


def _listed(numbers: tuple[float, ...]) -> str:
    return ", ".join(f"{number:g}" for number in numbers)


FRAME_TOPICS = frozenset({TF, TF_STATIC})
MOST_FRAMES = 2000
"""Frames that are kept; whoever comes later is not shown."""
FORGOTTEN_S = 10.0
"""A moving frame that has been silent for so long, as long as tf2 remembers, makes room."""
ROOM_AGAIN_S = 1.0


class FrameBook:
    """Takes the messages of both topics, and gives a row for every frame in each of its parents."""

    def __init__(self) -> None:
        self._records: dict[tuple[str, str, bool], FrameRecord] = {}
        self._publishers = {topic: Publishers() for topic in FRAME_TOPICS}
        self._messages = 0
        self._is_full = False
        """Whether a frame has found no room since room was made."""
        self._made_room_s = 0.0

    def clear(self) -> None:
        self._records.clear()

    def take(
        self, topic: str, raw: bytes, arrived_s: float, number: int | None = None, sender: bytes | None = None
    ) -> None:
        """Take a message, with its `number` at its publisher, if the middleware counts.

        `sender` is the gid of that publisher, if the middleware tells.
        Raises whatever bytes that are no such message make of it.
        """
        # rclpy would take five times as long.
        transforms: Any = bag_decoder(TypeText(TF_MESSAGE))(raw)["transforms"]
        if number is None:
            number = self._messages = self._messages + 1
        for one in transforms:
            parent, child = one["header"]["frame_id"], one["child_frame_id"]
            record = self._record(parent, child, arrived_s, static=topic == TF_STATIC)
            if record is not None:
                record.take(_fields(one), arrived_s, number, sender)

    def published_by(self, topic: str, there: Mapping[bytes, str]) -> None:
        """Say who publishes one of the topics now: the gid of each publisher to its node.

        The name is empty while it is unknown.
        """
        self._publishers[topic].are(there)

    def rows(self, now_s: float) -> tuple[FrameRow, ...]:
        """Return the rows at this unix time, sorted by frame and parent."""
        if self._is_full and abs(now_s - self._made_room_s) > ROOM_AGAIN_S:
            self._make_room(now_s)
        moving, static = self._publishers[TF], self._publishers[TF_STATIC]
        records = sorted(self._records.values(), key=lambda record: (record.names[::-1], record.static))
        return tuple(record.row(now_s, static if record.static else moving) for record in records)

    def _record(self, parent: str, child: str, arrived_s: float, *, static: bool) -> FrameRecord | None:
        bare = parent.removeprefix("/"), child.removeprefix("/")
        key = (_kept(bare[0]), _kept(bare[1]), static)
        record = self._records.get(key)
        if record is None:
            if len(self._records) >= MOST_FRAMES:
                self._is_full = True
                return None
            record = self._records[key] = FrameRecord(*bare, arrived_s, static=static)
        record.slashed = record.slashed or bare != (parent, child)
        return record

    def _make_room(self, now_s: float) -> None:
        """Forget moving frames that are long silent."""
        self._made_room_s, self._is_full = now_s, False
        self._records = {
            key: record
            for key, record in self._records.items()
            if record.static or now_s - record.arrived_s <= FORGOTTEN_S
        }


def _fields(one: Mapping[str, Any]) -> Fields:
    stamp, moved, turned = one["header"]["stamp"], one["transform"]["translation"], one["transform"]["rotation"]
    return (stamp["sec"] + stamp["nanosec"] * NANOSECONDS, *moved.values(), *turned.values())
