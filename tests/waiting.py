"""Waiting for a condition with a deadline, in place of sleeping and hoping."""

from __future__ import annotations

import asyncio
import inspect
import time
from collections.abc import Awaitable, Callable
from typing import Any, Literal, NoReturn, TypeVar, overload

import pytest

from tests.slowness import patient

T = TypeVar("T")
DEADLINE_S = 60.0
"""What takes longer is broken: on a machine with 30 processes at work, a command takes 20 s.

As every `within_s` here, it is for a quiet machine, and longer on a slow one.
"""


def wait_until(
    condition: Callable[[], T | Literal[False] | None],
    what: str | Callable[[], str],
    within_s: float = DEADLINE_S,
    every_s: float = 0.02,
) -> T:
    """Return the first truthy result of `condition`; fail naming `what` after `within_s`.

    `what` can be asked for when it comes to that, to tell how things stand then.
    """
    within_s = patient(within_s)
    deadline = time.monotonic() + within_s
    while True:
        result = condition()
        if result:
            return result
        if time.monotonic() > deadline:
            _overdue(what, within_s)
        time.sleep(every_s)


def comes(condition: Callable[[], object], within_s: float, every_s: float = 0.01) -> bool:
    """Whether the condition holds within that time: what is asked again, or ends a test."""
    within_s = patient(within_s)
    deadline = time.monotonic() + within_s
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(every_s)
    return True


@overload
async def until(
    condition: Callable[[], Awaitable[T | Literal[False] | None]],
    what: str | Callable[[], str],
    within_s: float = ...,
    every_s: float = ...,
) -> T: ...


@overload
async def until(
    condition: Callable[[], T | Literal[False] | None],
    what: str | Callable[[], str],
    within_s: float = ...,
    every_s: float = ...,
) -> T: ...


async def until(
    condition: Callable[[], Any], what: str | Callable[[], str], within_s: float = DEADLINE_S, every_s: float = 0.02
) -> Any:
    """As `wait_until`, while other tasks go on; the condition may be one of them."""
    within_s = patient(within_s)
    deadline = time.monotonic() + within_s
    while True:
        answer = condition()
        result = await answer if inspect.isawaitable(answer) else answer
        if result:
            return result
        if time.monotonic() > deadline:
            _overdue(what, within_s)
        await asyncio.sleep(every_s)


def _overdue(what: str | Callable[[], str], within_s: float) -> NoReturn:
    pytest.fail(f"not within {within_s:.3g} s: {what if isinstance(what, str) else what()}")
