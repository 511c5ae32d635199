"""How fast a recording would grow, by the rates that are measured now."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from graph.heavy_types import HEAVY_TYPES
from graph.housekeeping import is_hidden

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from graph.data import TopicRow

OTHERS = ""
"""Stands for all types that are not heavy."""
MESSAGE_BYTES = 47
"""What MCAP adds to each message: 31 bytes of its record, 16 in the index of its chunk."""


class RecordingShare(NamedTuple):
    """What the topics of one type add to a recording."""

    type_name: str
    """One of `HEAVY_TYPES`, or `OTHERS`."""
    topics: tuple[str, ...]
    bytes_per_s: float | None
    """On the disk; None while none of the topics has been measured."""


def shares(rows: Iterable[TopicRow]) -> tuple[RecordingShare, ...]:
    """Return the share of each heavy type and, as the last one, that of all others together."""
    found: dict[str, list[TopicRow]] = {kind: [] for kind in (*HEAVY_TYPES, OTHERS)}
    for row in rows:
        if row.publishers and not is_hidden(row.name):
            kind = next((kind for kind in HEAVY_TYPES if kind in row.type_names), OTHERS)
            found[kind].append(row)
    return tuple(
        RecordingShare(kind, tuple(row.name for row in of_kind), _rate(of_kind)) for kind, of_kind in found.items()
    )


def total_rate(found: Iterable[RecordingShare], left_out: Collection[str]) -> float | None:
    """Return the bytes a second of a recording without these types; None while unknown."""
    rates = [share.bytes_per_s for share in found if share.type_name not in left_out]
    return None if None in rates else sum(rate for rate in rates if rate is not None)


def _rate(rows: Sequence[TopicRow]) -> float | None:
    # A topic that is quiet has no rate, and adds nothing.
    known = [
        (row.bytes_per_s or 0.0) + MESSAGE_BYTES * (row.hz or 0.0)
        for row in rows
        if row.measured or row.bytes_per_s is not None
    ]
    return sum(known) if known or not rows else None
