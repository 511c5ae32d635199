"""One thing that is wrong with the frames, and how it names frames and nodes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Sequence

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
    """Name the first of them, and count the others."""
    if not names:
        return say("nobody")
    words = _called(names[0])
    for name in names[1:NAMED]:
        # Nested, since a name may be a sentence that is still to be translated.
        words = say("{names}, {name}", names=words, name=_called(name))
    more = len(names) - NAMED
    return say("{names} and {count} more", names=words, count=more) if more > 0 else words


def by_whom(publishers: Sequence[str]) -> str:
    """Name the publisher, or those that it may be."""
    return (
        listed(publishers)
        if len(publishers) < 2
        else say("one of {nodes}", nodes=listed(publishers))
    )


def _called(name: str) -> str:
    return name or say("a frame without a name")
