"""Ctrl-C while a command is not yet ready for it: nothing is torn apart, nothing is printed."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Coroutine, Iterator
from contextlib import ExitStack, contextmanager
from typing import TypeVar

_T = TypeVar("_T")


@contextmanager
def silent() -> Iterator[None]:
    """Let an interrupt end the process at once, as a program that is not Python's: no traceback."""
    if not _python_answers():
        yield
        return
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@contextmanager
def held() -> Iterator[None]:
    """Hold back an interrupt until the `with` ends; raise it then as KeyboardInterrupt.

    An interrupted import, or an event loop interrupted while it is made, can end with a traceback
    of its own, or lose the interrupt.
    """
    if not _python_answers():
        yield
        return
    interrupts: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _frame: interrupts.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
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


def _python_answers() -> bool:
    """Whether an interrupt would be raised here: no handler of its own, and the main thread."""
    if threading.current_thread() is not threading.main_thread():
        return False
    return signal.getsignal(signal.SIGINT) is signal.default_int_handler
