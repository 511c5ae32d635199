"""Reads and sets the parameters of any node, any number of nodes at once, without blocking."""

from __future__ import annotations

import time
from concurrent.futures import Future
from dataclasses import dataclass
from typing import TYPE_CHECKING

from graph.calls.parameters_exchange import SERVICES, read, write
from graph.data import CallResult, ParameterRow, ParametersResult, SetResult
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from graph.calls.parameters_exchange import ParameterExchange, ParameterRequest
    from graph.calls.services import Calls
    from graph.data import NodeRow, ServiceRow, Value

FOUND_WITHIN_S = 1.0
"""How long a node or its services may take to be discovered before they are reported missing."""


@dataclass
class _RunningExchange:
    """One exchange with one node."""

    node: str
    exchange: ParameterExchange
    request: ParameterRequest
    timeout_s: float
    """How long to wait for each answer."""
    end: Callable[[str], None]
    """Reports to the caller; the argument says why it ended early, or is empty."""
    asked_s: float
    """When the request should first have been sent."""
    answer: Future[CallResult] | None = None
    was_there: bool = False


class ParameterCalls:
    """The requests that are under way."""

    def __init__(
        self,
        calls: Calls,
        node: Callable[[str], NodeRow | None],
        service: Callable[[str], ServiceRow | None],
    ) -> None:
        """Send requests through `calls`; `node` and `service` look names up in the known graph."""
        self._calls = calls
        self._node = node
        self._service = service
        self._exchanges: list[_RunningExchange] = []

    def read(
        self, node: str, timeout_s: float, started_s: float, future: Future[ParametersResult]
    ) -> None:
        """Read all parameters of a node, with their descriptors; failures are reported in words."""
        node = _full(node)
        rows: list[ParameterRow] = []

        def end(error: str) -> None:
            taken = () if error else tuple(rows)
            future.set_result(ParametersResult(node, taken, error, time.monotonic() - started_s))

        self._begin(node, read(rows), timeout_s, end)

    def write(
        self,
        node: str,
        values: Mapping[str, Value],
        timeout_s: float,
        started_s: float,
        future: Future[SetResult],
    ) -> None:
        """Set parameters of a node, each independently; failures are reported in words."""
        node = _full(node)
        refused: dict[str, str] = {}

        def end(error: str) -> None:
            future.set_result(SetResult(node, refused, error, time.monotonic() - started_s))

        if values:
            self._begin(node, write(values, refused), timeout_s, end)
        else:
            end("")

    def step(self) -> bool:
        """Ask, take answers, give up; return whether any exchange is still under way."""
        for running in list(self._exchanges):
            try:
                word = self._go_on(running)
            except StopIteration:
                word = ""
            except Exception as error:  # noqa: BLE001 - one odd node must not end the others
                word = say(
                    "the answer of {node} cannot be understood: {error}",
                    node=running.node,
                    error=str(error),
                )
            if word is not None:
                self._exchanges.remove(running)
                running.end(word)
        return bool(self._exchanges)

    def fail(self, error: Exception) -> None:
        """End every exchange that is under way."""
        while self._exchanges:
            self._exchanges.pop().end(reason_of(error))

    def _begin(
        self, node: str, exchange: ParameterExchange, timeout_s: float, end: Callable[[str], None]
    ) -> None:
        self._exchanges.append(
            _RunningExchange(node, exchange, next(exchange), timeout_s, end, time.monotonic())
        )
        self.step()

    def _go_on(self, running: _RunningExchange) -> str | None:
        """Take the next step; return None if there is more to come, otherwise why there is not."""
        if running.answer is None:
            word = self._missing(running)
            if word is not None:
                return word or None
            self._ask(running)
        while running.answer is not None and running.answer.done():
            result = running.answer.result()
            if result.response is None:
                return result.error
            running.request = running.exchange.send(result.response)
            running.asked_s = time.monotonic()
            self._ask(running)
        return self._lost_patience(running)

    def _ask(self, running: _RunningExchange) -> None:
        request = running.request
        running.answer = Future()
        name = f"{running.node}/{request.service}"
        # This class watches the time itself, to report a time-out in its own words.
        patience_s = running.timeout_s + FOUND_WITHIN_S
        self._calls.begin(
            name,
            SERVICES[request.service],
            request.value,
            self._service(name),
            running.answer,
            patience_s,
            time.monotonic(),
        )

    def _missing(self, running: _RunningExchange) -> str | None:
        """Return why the node cannot be asked, "" if that is not known yet, None if it can."""
        node = self._node(running.node)
        running.was_there = running.was_there or node is not None
        if node and self._service(f"{running.node}/{running.request.service}"):
            for name, type_name in SERVICES.items():
                # All at once, so that not each has to wait again until the node has discovered it.
                self._calls.prepare(f"{running.node}/{name}", type_name)
            return None
        if time.monotonic() - running.asked_s < min(running.timeout_s, FOUND_WITHIN_S):
            return ""
        if node:
            return say(
                "{node} has no parameter services: it has just appeared, or was started without "
                "them",
                node=running.node,
            )
        return _gone(running)

    def _lost_patience(self, running: _RunningExchange) -> str | None:
        if self._node(running.node) is None:
            return _gone(running)
        if time.monotonic() - running.asked_s >= running.timeout_s:
            return say(
                "{node} does not answer within {seconds} s",
                node=running.node,
                seconds=f"{running.timeout_s:g}",
            )
        return None


def _gone(running: _RunningExchange) -> str:
    if running.was_there:
        return say("{node} has left the graph", node=running.node)
    return say("there is no node {node} in the graph", node=running.node)


def _full(node: str) -> str:
    return node if node.startswith("/") else f"/{node}"
