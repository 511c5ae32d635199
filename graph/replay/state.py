"""The state of a replay: plain data for whoever shows it."""

from __future__ import annotations

from dataclasses import dataclass

RATES = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
"""How many times as fast as it was."""


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
    """Whether it has come to the end and stands there."""
    messages: int = 0
    """All there are in the bag."""
    cut: str = ""
    """What is missing of a bag that was cut short, in words that can be translated."""
    damage: str = ""
    """What was left out so far because it cannot be read, in words that can be translated."""
    error: str = ""
    """Why it cannot go on, in words that can be translated."""


def next_rate(rate: float, *, faster: bool) -> float:
    """Return the next of `RATES` above or below; the last one stays."""
    if faster:
        return next((each for each in RATES if each > rate), RATES[-1])
    return next((each for each in reversed(RATES) if each < rate), RATES[0])
