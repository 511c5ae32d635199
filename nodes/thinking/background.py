"""Questions to a server, beside the node: on a thread of their own, answered on the node's.

A node's callbacks must not wait for a network. There is one question at a time; a newer one takes
the place of the one under way, which is hung up on.
"""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections import deque
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine
    from concurrent.futures import Future
    from typing import Any

    from nodes.parts.node import LessonNode

T = TypeVar("T")
_CLOSING_S = 2.0


class Background:
    """A thread with an event loop, and the way back to the node's thread; `close` it."""

    def __init__(self, node: LessonNode) -> None:
        self._results: deque[Callable[[], None]] = deque()
        self._wake = node.create_guard_condition(self._take)
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="model", daemon=True)
        self._thread.start()
        self._question: Future[Any] | None = None
        self._number = 0

    @property
    def busy(self) -> bool:
        """Whether a question is under way."""
        return self._question is not None

    def ask(
        self, question: Coroutine[Any, Any, T], answered: Callable[[T], None], failed: Callable[[Exception], None]
    ) -> None:
        """Ask in place of the question under way; one of the two is called on the node's thread."""
        self.cancel()
        number = self._number
        asked = asyncio.run_coroutine_threadsafe(question, self._loop)
        self._question = asked

        def done(future: Future[T]) -> None:
            if not future.cancelled():
                self.post(lambda: self._finish(number, future, answered, failed))

        asked.add_done_callback(done)

    def cancel(self) -> None:
        """Hang up on the question under way; nothing is called for it any more."""
        self._number += 1
        question, self._question = self._question, None
        if question is not None:
            question.cancel()

    def post(self, call: Callable[[], None]) -> None:
        """Have something called on the node's thread; from any thread."""
        self._results.append(call)
        self._wake.trigger()

    def call(self, call: Callable[[], object]) -> None:
        """Call something on the thread, between the steps of a question."""
        self._loop.call_soon_threadsafe(call)

    def begin(self, work: Coroutine[Any, Any, None]) -> None:
        """Do something on the thread beside the question under way; its end is not waited for."""
        asyncio.run_coroutine_threadsafe(work, self._loop)

    def close(self, last: Coroutine[Any, Any, None] | None = None) -> None:
        """Hang up, run what closes the connections, and end the thread."""
        self.cancel()
        if last is not None:
            with contextlib.suppress(Exception):
                asyncio.run_coroutine_threadsafe(last, self._loop).result(_CLOSING_S)
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(_CLOSING_S)

    def _finish(
        self, number: int, future: Future[T], answered: Callable[[T], None], failed: Callable[[Exception], None]
    ) -> None:
        if number != self._number:
            return
        self._question = None
        error = future.exception()
        if error is None:
            answered(future.result())
        elif isinstance(error, Exception):
            failed(error)

    def _take(self) -> None:
        while self._results:
            self._results.popleft()()
