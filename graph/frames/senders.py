"""Who sends a frame: exactly if the messages tell their publisher, otherwise who may do so.

In a live graph they do, see `graph.observer.taking`; in a recording nothing of it is kept.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

RECENT_S = 5.0
"""Whoever has not sent a moving frame for so long no longer does."""
Fields: TypeAlias = "tuple[Any, ...]"
"""Of one transform: its stamp in seconds, x, y, z, and the quaternion x, y, z, w."""
TOGETHER_S = 0.5
"""Two latched messages that come so close together are of two nodes: a restart takes longer."""
REPLACED_S = 30.0
"""A node that was killed stays in the graph until its lease has expired, 20 s with Fast DDS; it is
no second node beside the one of its name that was started in its place."""
PARTICIPANT = 12
"""Bytes of a gid that all publishers of one process have. Source: OMG DDSI-RTPS 2.5, 8.2.4.1."""
MOST_KNOWN, MOST_OTHERS = 1000, 20
"""Publishers that are remembered, of a topic and of a frame."""


@dataclass
class Publishers:
    """Those of one topic: who is there now, and who has been."""

    there: Mapping[bytes, str] = field(default_factory=dict)
    """Gid to the name of the node, empty while that is unknown."""
    known: dict[bytes, str] = field(default_factory=dict)
    """Those with a name, also if they have gone."""

    def are(self, there: Mapping[bytes, str]) -> None:
        if there == self.there:
            return
        self.there = there
        if len(self.known) > MOST_KNOWN:
            self.known.clear()
        self.known.update((gid, name) for gid, name in there.items() if name)


class PublishedBy(NamedTuple):
    """Who publishes a frame, as `graph.data.FrameRow` has it."""

    publishers: tuple[str, ...]
    certain: bool
    gone: str = ""


class _Sent(NamedTuple):
    """The last that a publisher has sent before another one did."""

    arrived_s: float
    fields: Fields
    beside: bool
    """Whether it was there at the same time as that other one, for sure."""


class Senders:
    """Those of one frame in one parent on one of the topics."""

    def __init__(self) -> None:
        self.newest: bytes | None = None
        """Gid of the one that sent the newest; None if it is not told."""
        self._others: dict[bytes, _Sent] = {}

    def hand_over(self, sender: bytes | None, arrived_s: float, fields: Fields, passed_s: float) -> None:
        """Say that `sender` sends the next; the one before has sent `fields`, at `arrived_s`.

        `passed_s` is the time since then.
        """
        # Whoever comes again has been there all the time.
        returned = sender is not None and self._others.pop(sender, None) is not None
        if self.newest is not None:
            beside = returned or passed_s < TOGETHER_S
            self._others[self.newest] = _Sent(arrived_s, fields, beside)
            if len(self._others) > MOST_OTHERS:
                del self._others[next(iter(self._others))]
        self.newest = sender

    def who(self, topic: Publishers, arrived_s: float, now_s: float, *, latched: bool) -> PublishedBy:
        """Return who publishes it at `now_s`; the newest has arrived at `arrived_s`."""
        if self.newest is None or self._is_news(topic, now_s):
            candidates = tuple(sorted({name or say("unknown node") for name in topic.there.values()}))
            return PublishedBy(candidates, certain=len(candidates) < 2)
        gids = [
            gid
            for gid, sent in self._beside(topic, arrived_s, now_s)
            if latched or arrived_s - sent.arrived_s < RECENT_S
        ]
        if topic.there.get(self.newest):
            gids.append(self.newest)
        # A node that has two publishers is one node.
        found = {(topic.there[gid], gid[:PARTICIPANT]) for gid in gids}
        names = tuple(name for name, _ in sorted(found))
        return PublishedBy(names, certain=True, gone="" if names else topic.known[self.newest])

    def disagree(self, topic: Publishers, fields: Fields, arrived_s: float, now_s: float) -> bool:
        """Return whether others that are there have sent other numbers than `fields`, the newest.

        The first field is the stamp, which does not matter.
        """
        return self.newest in topic.there and any(
            sent.fields and sent.fields[1:] != fields[1:] for _, sent in self._beside(topic, arrived_s, now_s)
        )

    def _is_news(self, topic: Publishers, now_s: float) -> bool:
        """Return whether one of them is still to be found in the graph."""
        return self.newest not in topic.known or any(
            gid not in topic.known and now_s - sent.arrived_s < RECENT_S for gid, sent in self._others.items()
        )

    def _beside(self, topic: Publishers, arrived_s: float, now_s: float) -> Iterator[tuple[bytes, _Sent]]:
        """Yield those that are there beside the one that has sent the newest."""
        newest = self.newest or b""
        name = topic.known.get(newest)
        for gid, sent in self._others.items():
            if topic.there.get(gid) and (
                topic.there[gid] != name
                or gid[:PARTICIPANT] == newest[:PARTICIPANT]
                or sent.beside
                or now_s - arrived_s > REPLACED_S
            ):
                yield gid, sent
