"""Two updates as one, for whoever has not taken the first when the second comes.

The rows are the newest, and all samples are kept as far as the limits allow, so that at most one
update waits: who is slow draws less often, but does not fall behind.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from graph.data import GraphUpdate, Sample

KEPT_SAMPLES = 256
KEPT_BYTES = 32 * 1024 * 1024
"""Limit for one topic while nobody takes them; the newest sample is always kept."""


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
