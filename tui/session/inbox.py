"""Updates of the graph on their way from the observer's thread to the app.

While the app is busy they are merged, newest rows and all samples, so that at most one waits:
a slow screen falls behind in drawing, never in time.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from graph.data import GraphUpdate, Sample

KEPT_SAMPLES = 256
KEPT_BYTES = 32 * 1024 * 1024
"""Of one topic, while the app does not come to take them; the newest is kept whatever its size."""


class GraphInbox:
    """Holds the one update that waits; `wake` is called when the first one has come in."""

    def __init__(self, wake: Callable[[], object]) -> None:
        """`wake` must be safe to call from any thread."""
        self._wake = wake
        self._lock = threading.Lock()
        self._waiting: GraphUpdate | None = None

    def put(self, update: GraphUpdate) -> None:
        """Take an update on the observer's thread."""
        with self._lock:
            first = self._waiting is None
            self._waiting = update if self._waiting is None else merged(self._waiting, update)
        if first:
            self._wake()

    def take(self) -> GraphUpdate | None:
        """Return what waits, on the app's thread."""
        with self._lock:
            update, self._waiting = self._waiting, None
        return update


def merged(older: GraphUpdate, newer: GraphUpdate) -> GraphUpdate:
    """Return `newer` with the samples of both, each topic's in order and bounded."""
    samples: dict[str, tuple[Sample, ...]] = dict(older.samples)
    for topic, fresh in newer.samples.items():
        samples[topic] = _newest((*samples.get(topic, ()), *fresh))
    return replace(newer, samples=samples)


def _newest(samples: tuple[Sample, ...]) -> tuple[Sample, ...]:
    """Return as many of the newest as may wait."""
    kept = samples[-KEPT_SAMPLES:]
    room = KEPT_BYTES
    for count, sample in enumerate(reversed(kept)):
        room -= sample.size_bytes
        if room < 0 and count:
            return kept[-count:]
    return kept
