"""Watches the saved stop, so that it reaches a node that the middleware does not connect yet.

The files are looked at 20 times a second, on a thread that costs some 20 microseconds each time:
that works on every file system, and where a user has no watches left.
"""

from __future__ import annotations

import contextlib
import time
from typing import TYPE_CHECKING

from rclpy.impl.implementation_singleton import rclpy_implementation as rclpy_c

from nodes.parts.periodic_thread import PeriodicThread

if TYPE_CHECKING:
    from collections.abc import Callable

    from nodes.parts.node import LessonNode
    from robot.safety.stop_file import StopFile

_EVERY_S = 0.05
_STILL_S, _JUST_S = 0.5, 1.0
"""What is no delay of a busy machine any more, and how long everything that was late arrives."""


class StopWatch:
    """Calls back on the node's own thread after each change of the files, and when asked to."""

    def __init__(self, node: LessonNode, file: StopFile, changed: Callable[[], None]) -> None:
        """Watch from now on; read the file after this."""
        self._node, self._file, self._changed = node, file, changed
        self._seen = file.signature()
        self._due_s: float | None = None
        self._thread = PeriodicThread(_EVERY_S, self._look)
        self._looked_s, self._still_s = time.monotonic(), -_JUST_S

    def start(self) -> None:
        self._thread.start()

    @property
    def was_frozen(self) -> bool:
        """Whether this process has stood still a moment ago."""
        now_s = time.monotonic()
        return now_s - self._looked_s > _STILL_S or now_s - self._still_s < _JUST_S

    def call_later(self, after_s: float) -> None:
        """Call back after this time too, sooner if the files change."""
        if self._due_s is None:
            self._due_s = time.monotonic() + after_s

    def _look(self) -> None:
        now_s = time.monotonic()
        if now_s - self._looked_s > _STILL_S:
            self._still_s = now_s
        self._looked_s = now_s
        seen, due_s, executor = self._file.signature(), self._due_s, self._node.executor
        due = due_s is not None and now_s >= due_s
        if executor is None or not (due or seen != self._seen):
            return
        # A node that is ending has given these up.
        with contextlib.suppress(AttributeError, rclpy_c.InvalidHandle):
            self._due_s = None
            executor.create_task(self._changed)
            self._seen = seen
