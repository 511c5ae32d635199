"""Nodes of the session that have ended for good, as whoever started them says."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.findings.finding import FindingLevel, FindingPlace, GraphFinding
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


def failures(failed: Mapping[str, str]) -> Iterator[GraphFinding]:
    """Yield the nodes that have failed; `failed`: full name to why, as translatable words."""
    for name, why in failed.items():
        yield GraphFinding(
            FindingLevel.ERROR,
            "failed",
            FindingPlace("node", name),
            say("It has failed, and is not started again: {reason}", reason=why),
            say("Look at its log, and start it again once its fault is fixed."),
            (name,),
            settled_s=0.0,
        )
