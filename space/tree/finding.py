"""One thing that is wrong with the frames, and how it names frames and nodes."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from space.tree.heard import HeardFrame

NAMED = 3
"""Frames and nodes that a sentence names; the others are counted."""


class FrameTrouble(str, Enum):
    """What is wrong, from what stops tf2 to what will puzzle somebody later."""

    FULL = "full"
    LOOP = "loop"
    PARENTS = "two parents"
    CONTESTED = "contested"
    NUMBERS = "numbers"
    STALE = "stale"
    GONE = "gone"
    ROOTS = "two roots"
    UNKNOWN = "unknown frame"
    CLOCK = "clock"
    BOTH = "both topics"
    STATIC_MOVED = "static moved"
    VOLATILE = "volatile"
    ELSEWHERE = "elsewhere"
    SLASH = "slash"


@dataclass(frozen=True)
class FrameFinding:
    """One thing that is wrong."""

    trouble: FrameTrouble
    frames: tuple[str, ...]
    """Where: the frames that it is about."""
    text: str
    """A sentence."""
    advice: str
    """What to do, a sentence."""


def listed(names: Sequence[str]) -> str:
    """Name the first of them, and count the others; what is there several times is named once."""
    if not names:
        return say("nobody")
    counted = Counter(names)
    first, *others = list(counted)[:NAMED]
    words = _called(first, counted[first])
    for name in others:
        # Nested, since a name may be a sentence that is still to be translated.
        words = say("{names}, {name}", names=words, name=_called(name, counted[name]))
    more = len(counted) - NAMED
    return say("{names} and {count} more", names=words, count=more) if more > 0 else words


def by_whom(heard: Sequence[HeardFrame]) -> str:
    """Name the publishers of frames, or those that it may be."""
    names: Counter[str] = Counter()
    for one in heard:
        names |= Counter(one.publishers)
    nodes = listed(tuple(names.elements()))
    return nodes if all(one.certain for one in heard) else say("one of {nodes}", nodes=nodes)


def _called(name: str, times: int) -> str:
    called = name or say("a frame without a name")
    return say("{name} ({count} of this name)", name=called, count=times) if times > 1 else called
