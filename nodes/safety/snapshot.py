"""What the gate does just now, for its log and /safety_state."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from nodes.parts.refusals import Refusal


class GateSnapshot(NamedTuple):
    """The current state of the gate."""

    source: str = ""
    """Who drives, empty if nobody does."""
    ignored: str = ""
    """Who has been ignored in the last second."""
    asked_m_s: float = 0.0
    allowed: float = 1.0
    """How much of that passes, 0 to 1; of no speed, how much of one forward would."""
    age_s: float | None = None
    """Of the newest command that counts."""
    refused: Refusal | None = None
    """What was asked for in the last moments and refused."""
