"""Updates of the graph on their way from the observer's thread to the app.

While the app is busy they are merged, keeping the newest rows and all samples, so that at most one
waits: a slow screen draws less often, but does not fall behind.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

from graph.observer.updates import merged

if TYPE_CHECKING:
    from graph.data import GraphUpdate


class GraphInbox:
    """Holds the one waiting update; `wake` is called when an update arrives in an empty inbox."""

    def __init__(self, wake: Callable[[], object]) -> None:
        """Pass a `wake` that may be called from any thread."""
        self._wake = wake
        self._lock = threading.Lock()
        self._waiting: GraphUpdate | None = None

    def put(self, update: GraphUpdate) -> None:
        """Add an update, on the observer's thread."""
        with self._lock:
            first = self._waiting is None
            self._waiting = update if self._waiting is None else merged(self._waiting, update)
        if first:
            self._wake()

    def take(self) -> GraphUpdate | None:
        """Return the waiting update, on the app's thread."""
        with self._lock:
            update, self._waiting = self._waiting, None
        return update
