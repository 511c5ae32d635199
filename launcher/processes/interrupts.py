"""Ctrl-C while a command is not yet ready for it: nothing is torn apart, nothing is printed."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Coroutine, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from typing import Any, TypeVar

_T = TypeVar("_T")


@contextmanager
def _answered_by(answer: Any) -> Iterator[None]:  # noqa: ANN401 - as `signal.signal` takes it
    """Let something else answer interrupts, where Python would: on the main thread, without a handler of its own."""
    main = threading.current_thread() is threading.main_thread()
    if not main or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield
        return
    signal.signal(signal.SIGINT, answer)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def silent() -> AbstractContextManager[None]:
    """Let an interrupt end the process at once, as a program that is not Python's: no traceback."""
    return _answered_by(signal.SIG_DFL)


@contextmanager
def held() -> Iterator[None]:
    """Hold back an interrupt until the `with` ends; raise it then as KeyboardInterrupt.

    An interrupted import, or an event loop interrupted while it is made, can end with a traceback
    of its own, or lose the interrupt.
    """
    interrupts: list[int] = []
    try:
        with _answered_by(lambda number, _frame: interrupts.append(number)):
            yield
    finally:
        if interrupts:
            raise KeyboardInterrupt


def run(work: Coroutine[object, object, _T]) -> _T:
    """Run a command's coroutine as `asyncio.run` does; an interrupt may come at any time.

    `asyncio.run` answers interrupts once its loop runs. One that comes while the loop is made
    leaves a loop whose end prints a traceback, and a coroutine that nobody awaited.
    """
    # Not every command needs asyncio, whose import takes a tenth of the start of `deck list`.
    if sys.version_info >= (3, 11):
        from asyncio import Runner
    else:
        from backports.asyncio.runner import Runner

    try:
        with ExitStack() as closing:
            with held():
                runner = closing.enter_context(Runner())
            return runner.run(work)
    finally:
        work.close()
