"""What the observer's process has been asked for and has not answered."""

from __future__ import annotations

import threading
import time
from concurrent.futures import Future, InvalidStateError
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from graph.observer.process import language

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from graph.data import CallResult


@dataclass(frozen=True)
class OpenOrder:
    """One order and who waits for its answer."""

    number: int
    name: str
    arguments: tuple[Any, ...]
    refusal: Callable[[Exception], Any] | None
    """Makes the result that says why not, for a future that must never raise."""
    asked_s: float = field(default_factory=time.monotonic)
    future: Future[Any] = field(default_factory=Future)

    @property
    def order(self) -> language.Order:
        return self.number, self.name, self.arguments, self.asked_s

    @property
    def outlives_its_process(self) -> bool:
        """Whether another process can be asked for the same: nothing moves by it, or it stops."""
        return self.name in language.PREPARING or language.is_state(self.name, self.arguments)

    def answer(self, result: object) -> None:
        """Hand over the result, unless nobody waits for it any more."""
        with suppress(InvalidStateError):
            self.future.set_result(result)

    def fail(self, error: Exception) -> None:
        """Say why there is none."""
        if self.refusal is not None:
            self.answer(self.refusal(error))
            return
        with suppress(InvalidStateError):
            self.future.set_exception(error)


class AskedBook:
    """All of them, oldest first; any thread may use it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._waiting: dict[int, OpenOrder] = {}
        self._late: dict[int, Future[CallResult]] = {}
        """Answers to calls that have timed out, should they still come."""

    def add(self, asked: OpenOrder) -> None:
        with self._lock:
            self._waiting[asked.number] = asked

    def drop(self, number: int) -> OpenOrder | None:
        with self._lock:
            return self._waiting.pop(number, None)

    def done(self, number: int, result: Any, has_late: bool) -> None:  # noqa: ANN401
        """Answer one; `has_late` if an answer may still come that would be too late."""
        asked = self.drop(number)
        if has_late:
            late: Future[CallResult] = Future()
            self._late[number] = late
            result = replace(result, late=late)
        if asked is not None:
            asked.answer(result)

    def later(self, number: int, result: CallResult) -> None:
        """Hand over an answer that has come too late."""
        late = self._late.pop(number, None)
        if late is not None:
            late.set_result(result)

    def failed(self, number: int, error: Exception) -> None:
        """Say why there is no answer."""
        asked = self.drop(number)
        if asked is not None:
            asked.fail(error)

    def fail_all(self, error: Exception) -> None:
        """Say to everybody that there will be no answer."""
        self._fail(error, lambda _: True)

    def fail_lost(self, error: Exception) -> tuple[OpenOrder, ...]:
        """Say so of what has gone with its process; return what another one can be asked for."""
        self._fail(error, lambda asked: not asked.outlives_its_process)
        with self._lock:
            return tuple(self._waiting.values())

    def _fail(self, error: Exception, is_lost: Callable[[OpenOrder], bool]) -> None:
        with self._lock:
            lost: Iterable[OpenOrder] = [each for each in self._waiting.values() if is_lost(each)]
            for asked in lost:
                del self._waiting[asked.number]
        self._late.clear()
        # The receiver may ask for something else at once.
        for asked in lost:
            asked.fail(error)
