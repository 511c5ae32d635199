"""The current state of the gate, for its log and /safety_state."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from nodes.parts.refusals import Refusal


class GateSnapshot(NamedTuple):
    """The current state of the gate."""

    source: str = ""
    """The source that drives, empty if none does."""
    ignored: str = ""
    """The sources ignored in the last second."""
    asked_m_s: float = 0.0
    allowed: float = 1.0
    """The share of that which passes, 0 to 1; for zero speed, the forward share."""
    age_s: float | None = None
    """Age of the newest active command."""
    refused: Refusal | None = None
    """Recently refused commands."""
