"""The messages between a judge's process and whoever shows what it says: a line of JSON each.

To the judge: `start`, once; then `judge`, as often as wished, and `quit`. From it: `values`, once
it is at work, `step` for whatever changes, and `end`, the last one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from course.results import CheckResult, State, StepResult
from text.packing import pack_text, unpack_text

if TYPE_CHECKING:
    from collections.abc import Mapping

MOST_BYTES = 1 << 22
"""Longest line in either direction."""


def pack_step(step: StepResult) -> dict[str, Any]:
    """Return the result of a step as JSON."""
    return {
        "id": step.id,
        "state": step.state.value,
        "points": step.points,
        "reason": pack_text(step.reason),
        "checks": [
            {
                "state": check.state.value,
                "what": pack_text(check.what),
                "seen": pack_text(check.seen),
                "look": pack_text(check.look),
                "hint": pack_text(check.hint),
            }
            for check in step.checks
        ],
    }


def unpack_step(fields: Mapping[str, Any]) -> StepResult:
    """Return the result that `pack_step` was given."""
    checks = tuple(
        CheckResult(State(check["state"]), *(unpack_text(check[key]) for key in ("what", "seen", "look", "hint")))
        for check in fields["checks"]
    )
    return StepResult(fields["id"], State(fields["state"]), fields["points"], checks, unpack_text(fields["reason"]))
