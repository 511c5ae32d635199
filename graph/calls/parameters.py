"""Reads and sets the parameters of any node, any number of nodes at once, without blocking."""

from __future__ import annotations

import time
from concurrent.futures import Future
from dataclasses import dataclass
from typing import TYPE_CHECKING

from graph.calls.parameters_talk import SERVICES, read, write
from graph.data import CallResult, ParameterRow, ParametersResult, SetResult
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from graph.calls.parameters_talk import Question, Talk
    from graph.calls.services import Calls
    from graph.data import NodeRow, ServiceRow, Value

FOUND_WITHIN_S = 1.0
"""How long a node or its services may take to be discovered before they are reported missing."""


@dataclass
class _Talking:
    """One exchange with one node."""

    node: str
    talk: Talk
    question: Question
    timeout_s: float
    """How long to wait for each answer."""
    end: Callable[[str], None]
    """Reports to the caller; the argument says why it ended early, or is empty."""
    asked_s: float
    """When the question should first have been sent."""
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
        self._talks: list[_Talking] = []

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
        for talking in list(self._talks):
            try:
                word = self._go_on(talking)
            except StopIteration:
                word = ""
            except Exception as error:  # noqa: BLE001 - one odd node must not end the others
                word = say(
                    "the answer of {node} cannot be understood: {error}",
                    node=talking.node,
                    error=str(error),
                )
            if word is not None:
                self._talks.remove(talking)
                talking.end(word)
        return bool(self._talks)

    def fail(self, error: Exception) -> None:
        """End every exchange that is under way."""
        while self._talks:
            self._talks.pop().end(reason_of(error))

    def _begin(self, node: str, talk: Talk, timeout_s: float, end: Callable[[str], None]) -> None:
        self._talks.append(_Talking(node, talk, next(talk), timeout_s, end, time.monotonic()))
        self.step()

    def _go_on(self, talking: _Talking) -> str | None:
        """Take the next step; return None if there is more to come, otherwise why there is not."""
        if talking.answer is None:
            word = self._missing(talking)
            if word is not None:
                return word or None
            self._ask(talking)
        while talking.answer is not None and talking.answer.done():
            result = talking.answer.result()
            if result.response is None:
                return result.error
            talking.question = talking.talk.send(result.response)
            talking.asked_s = time.monotonic()
            self._ask(talking)
        return self._lost_patience(talking)

    def _ask(self, talking: _Talking) -> None:
        question = talking.question
        talking.answer = Future()
        name = f"{talking.node}/{question.service}"
        # This class watches the time itself, to report a time-out in its own words.
        patience_s = talking.timeout_s + FOUND_WITHIN_S
        self._calls.begin(
            name,
            SERVICES[question.service],
            question.request,
            self._service(name),
            talking.answer,
            patience_s,
            time.monotonic(),
        )

    def _missing(self, talking: _Talking) -> str | None:
        """Return why the node cannot be asked, "" if that is not known yet, None if it can."""
        node = self._node(talking.node)
        talking.was_there = talking.was_there or node is not None
        if node and self._service(f"{talking.node}/{talking.question.service}"):
            for name, type_name in SERVICES.items():
                # All at once, so that not each has to wait again until the node has discovered it.
                self._calls.prepare(f"{talking.node}/{name}", type_name)
            return None
        if time.monotonic() - talking.asked_s < min(talking.timeout_s, FOUND_WITHIN_S):
            return ""
        if node:
            return say(
                "{node} has no parameter services: it has just appeared, or was started without "
                "them",
                node=talking.node,
            )
        return _gone(talking)

    def _lost_patience(self, talking: _Talking) -> str | None:
        if self._node(talking.node) is None:
            return _gone(talking)
        if time.monotonic() - talking.asked_s >= talking.timeout_s:
            return say(
                "{node} does not answer within {seconds} s",
                node=talking.node,
                seconds=f"{talking.timeout_s:g}",
            )
        return None


def _gone(talking: _Talking) -> str:
    if talking.was_there:
        return say("{node} has left the graph", node=talking.node)
    return say("there is no node {node} in the graph", node=talking.node)


def _full(node: str) -> str:
    return node if node.startswith("/") else f"/{node}"
