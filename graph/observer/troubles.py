"""Why a topic shows nothing, in words: four different troubles, never an empty panel."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from graph.data import Trouble
from graph.qos_compatibility import mismatches

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from graph.messages.types import UnknownTypeError
    from graph.qos_compatibility import Mismatch
    from graph.scan import TopicEnds

MOST_PAIRS = 5
"""Pairs that are described in words; the rest are only counted."""


@dataclass(frozen=True)
class Diagnosis:
    """A trouble, or a remark if there is none, with its details."""

    trouble: Trouble | None = None
    detail: str = ""
    facts: Mapping[str, str] = field(default_factory=dict)


def structural(ends: TopicEnds, shown_type: str, unknown: UnknownTypeError | None) -> Diagnosis:
    """Return what is wrong with the topic, regardless of its messages.

    `shown_type` is the type that Deck decodes, `unknown` why it cannot.
    """
    if unknown is not None:
        return Diagnosis(
            Trouble.UNKNOWN_TYPE,
            unknown.reason,
            {"type": unknown.type_name, "package": unknown.package, "reason": unknown.reason, **unknown.install},
        )
    if not ends.everyone_publishing:
        return Diagnosis(Trouble.NO_PUBLISHER, "nobody publishes this topic")
    found = mismatches(ends.everyone_publishing, ends.subscribers)
    if found:
        return _misfit(found)
    if len(ends.type_names) > 1:
        types = ", ".join(ends.type_names)
        return Diagnosis(
            None,
            f"peers disagree about the type: {types}; shown is {shown_type}",
            {"types": types, "shown": shown_type},
        )
    return Diagnosis()


def _misfit(found: Sequence[Mismatch]) -> Diagnosis:
    """Return all incompatible pairs in words, and the first one as facts."""
    # Two identical endpoints of one node give the same sentence.
    told = list(dict.fromkeys(found))
    more = len(told) - MOST_PAIRS
    words = [f"{pair.what} {pair.mend}" for pair in told[:MOST_PAIRS]]
    words += [f"(and {more} more pairs)"] if more > 0 else []
    others = {"more": str(len(told) - 1)} if len(told) > 1 else {}
    return Diagnosis(Trouble.QOS_MISMATCH, " ".join(words), told[0].facts() | others)


def quiet(seconds: float, *, ever: bool) -> Diagnosis:
    """Return that nothing has come for `seconds`; `ever` says whether anything came before."""
    since = "" if ever else ", and never before"
    return Diagnosis(Trouble.QUIET, f"no data for {seconds:.0f} s{since}", {"seconds": f"{seconds:.0f}"})
