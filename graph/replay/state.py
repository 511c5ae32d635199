"""The state of a replay: plain data for whoever shows it."""

from __future__ import annotations

from dataclasses import dataclass

RATES = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
"""Factors of the original speed."""


@dataclass(frozen=True)
class ReplayState:
    """The position of a replay, and how it continues."""

    position_s: float = 0.0
    """Since the first message."""
    length_s: float = 0.0
    """From the first message to the last."""
    start_s: float = 0.0
    """Unix time of the first message."""
    rate: float = 1.0
    paused: bool = False
    loop: bool = False
    ended: bool = False
    """Whether it has stopped at the end."""
    messages: int = 0
    """All topics in the bag."""
    is_cut: bool = False
    """Whether the bag was cut short."""
    is_incomplete: bool = False
    """Whether messages are missing that the bag should have."""
    notes: tuple[str, ...] = ()
    """What differs from what the bag says of itself, and what is missing: translatable words."""
    damage: str = ""
    """What has been left out so far as unreadable, as translatable words."""
    error: str = ""
    """Why it cannot continue, as translatable words."""


def next_rate(rate: float, *, faster: bool) -> float:
    """Return the next of `RATES` above or below; the last one has no next."""
    if faster:
        return next((each for each in RATES if each > rate), RATES[-1])
    return next((each for each in reversed(RATES) if each < rate), RATES[0])
