"""Asks the head to turn, one request after the other, without blocking.

A missing service or answer is reported in words after a while.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from example_interfaces.srv import AddTwoInts
from rclpy.task import Future

from nodes.parts.node import LessonNode
from robot.topics import HEAD_SERVICE
from text.i18n import N_

APPEAR_S = 1.0
"""How long a missing service may take to appear: discovery is sometimes slow."""
_CHECK_EVERY_S = 0.1

ABSENT = N_("the service {service} is not there: is head_controller running?")
LATE = N_("no answer from {service} for {seconds:g} s")

DROPPED = N_("dropped for newer commands")


@dataclass(frozen=True)
class HeadAnswer:
    """The outcome of one request."""

    pan: int
    tilt: int
    sum: int | None = None
    """1 done, 0 refused, None if there was no answer."""
    trouble: str = ""
    """Why there was no answer, in the language of the node."""


class HeadClient:
    """A queue of requests to the head, one of them under way."""

    def __init__(self, node: LessonNode, timeout_s: Callable[[], float]) -> None:
        self._node = node
        self._timeout_s = timeout_s
        self._client = node.create_client(AddTwoInts, HEAD_SERVICE)
        self._queue: deque[tuple[int, int, Callable[[HeadAnswer], None]]] = deque()
        self._call: Future | None = None
        self._asked_s = 0.0
        self._timer = node.every(_CHECK_EVERY_S, self._check)
        self._timer.cancel()

    def turn(self, pan: int, tilt: int, report: Callable[[HeadAnswer], None]) -> None:
        """Queue a request for a pose, in degrees; `report` is called with the outcome."""
        self._queue.append((pan, tilt, report))
        if len(self._queue) == 1:
            self._ask()

    def forget(self) -> None:
        """Drop requests that have not been sent yet."""
        under_way = self._queue.popleft() if self._queue else None
        dropped, self._queue = self._queue, deque([under_way] if under_way else [])
        for pan, tilt, report in dropped:
            report(HeadAnswer(pan, tilt, trouble=self._node.say.text(DROPPED)))

    def _ask(self) -> None:
        self._asked_s = time.monotonic()
        self._timer.reset()
        self._call_if_there()

    def _call_if_there(self) -> None:
        if self._client.service_is_ready():
            pan, tilt, _report = self._queue[0]
            self._asked_s = time.monotonic()
            self._call = self._client.call_async(AddTwoInts.Request(a=pan, b=tilt))
            self._call.add_done_callback(self._answered)

    def _check(self) -> None:
        if self._call is None:
            self._call_if_there()
        waited_s = time.monotonic() - self._asked_s
        if self._call is None and waited_s > APPEAR_S:
            self._finish(trouble=self._node.say.text(ABSENT, service=HEAD_SERVICE))
        elif self._call is not None and waited_s > self._timeout_s():
            self._client.remove_pending_request(self._call)
            late = self._node.say.text(LATE, service=HEAD_SERVICE, seconds=self._timeout_s())
            self._finish(trouble=late)

    def _answered(self, call: Future) -> None:
        # An answer may arrive after its request was given up.
        if call is self._call:
            response = call.result()
            self._finish(total=None if response is None else response.sum)

    def _finish(self, total: int | None = None, trouble: str = "") -> None:
        self._call = None
        self._timer.cancel()
        pan, tilt, report = self._queue.popleft()
        report(HeadAnswer(pan, tilt, total, trouble))
        if self._queue and self._call is None:
            self._ask()
