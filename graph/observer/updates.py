"""Updates on their way to the screen: two of them as one, and what of one has to be sent.

Whoever is slow draws less often, but does not fall behind: the rows are the newest, and all samples are kept as far
as the limits allow, so that at most one update waits.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from graph.data import GraphUpdate, TopicRow

if TYPE_CHECKING:
    from graph.data import Sample

KEPT_SAMPLES = 256
KEPT_BYTES = 32 * 1024 * 1024
"""Limit for one topic while nobody takes them; the newest sample is always kept."""
ENDS = ("published_by", "subscribed_by")
"""What is most of a row, and hardly ever changes."""


def merged(older: GraphUpdate, newer: GraphUpdate) -> GraphUpdate:
    """Return `newer` with the samples of both, each topic's in order and limited in size."""
    samples: dict[str, tuple[Sample, ...]] = dict(older.samples)
    for topic, fresh in newer.samples.items():
        samples[topic] = _newest((*samples.get(topic, ()), *fresh))
    return replace(newer, samples=samples)


def _newest(samples: tuple[Sample, ...]) -> tuple[Sample, ...]:
    """Return as many of the newest samples as the limit allows."""
    kept = samples[-KEPT_SAMPLES:]
    room = KEPT_BYTES
    for count, sample in enumerate(reversed(kept)):
        room -= sample.size_bytes
        if room < 0 and count:
            return kept[-count:]
    return kept


def news(update: GraphUpdate, last: GraphUpdate) -> dict[str, Any]:
    """Return the fields that have changed; a row of a topic lacks its endpoints if they are those of `last`.

    To send all that is known each time would cost the observer and the screen half as much again.
    """
    before = vars(last)
    # Samples may hold arrays, which cannot be compared.
    changed = {name: now for name, now in vars(update).items() if name == "samples" or now != before[name]}
    if "topics" in changed:
        rows = {row.name: row for row in last.topics}
        changed["topics"] = tuple(_light(row, rows.get(row.name)) for row in update.topics)
    return changed


def renewed(last: GraphUpdate, changed: dict[str, Any]) -> GraphUpdate:
    """Return the update that `changed` was made from, `last` being the one before it."""
    rows = {row.name: row for row in last.topics}
    for row in changed.get("topics", ()):
        if ENDS[0] not in vars(row):
            before = rows[row.name]
            vars(row).update(published_by=before.published_by, subscribed_by=before.subscribed_by)
    return replace(last, **changed)


def _light(row: TopicRow, before: TopicRow | None) -> TopicRow:
    # Endpoints that are equal may be others: what tells them apart is not compared.
    if before is None or row.published_by is not before.published_by or row.subscribed_by is not before.subscribed_by:
        return row
    light = object.__new__(TopicRow)
    vars(light).update(vars(row))
    for name in ENDS:
        del vars(light)[name]
    return light
