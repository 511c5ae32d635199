"""Exchanges with nodes, each through the node's own services, any number at once, non-blocking.

An exchange is a generator: it yields requests, is sent the answers as trees, and knows neither time nor ROS. This
module delivers the requests, and says in words why there is no answer.
"""

from __future__ import annotations

import time
from collections.abc import Generator, Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from graph.data import ANSWER_WITHIN_S, CallResult
from graph.inner_states import LOG_LEVELS, LevelResult
from text.i18n import N_
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Callable

    from graph.calls.services import Calls
    from graph.data import NodeRow, ServiceRow, Value


FOUND_WITHIN_S = 1.0
"""How long a node or its services may take to be discovered before they are reported missing."""


class NodeRequest(NamedTuple):
    """A request to one of a node's own services."""

    service: str
    """The service relative to the node's name: `list_parameters`."""
    value: Mapping[str, Value]
    within_s: float | None = None
    """How long to wait for its answer, if not as long as for the others of the exchange."""


Exchange = Generator[NodeRequest, Mapping[str, Any], None]


class ServiceSet(NamedTuple):
    """Services that a node has all of, or none."""

    types: Mapping[str, str]
    """Their names relative to the node's, and their types."""
    lacking: str
    """An English sentence about a `{node}` that has none of them, marked for the catalogue."""


@dataclass
class _RunningExchange:
    """One exchange with one node."""

    node: str
    exchange: Exchange
    services: ServiceSet
    request: NodeRequest
    timeout_s: float
    """How long to wait for each answer."""
    end: Callable[[str], None]
    """Reports to the caller; the argument says why it ended early, or is empty."""
    asked_s: float
    """When the request should first have been sent."""
    answer: Future[CallResult] | None = None
    was_there: bool = False


class Exchanges:
    """The exchanges that are under way."""

    def __init__(
        self, calls: Calls, node: Callable[[str], NodeRow | None], service: Callable[[str], ServiceRow | None]
    ) -> None:
        """Send requests through `calls`; `node` and `service` look names up in the known graph."""
        self._calls = calls
        self._node = node
        self._service = service
        self._exchanges: list[_RunningExchange] = []

    def begin(
        self, node: str, exchange: Exchange, services: ServiceSet, timeout_s: float, end: Callable[[str], None]
    ) -> None:
        """Begin an exchange with the node of this full name; `end` gets why it failed, or ""."""
        self._exchanges.append(
            _RunningExchange(node, exchange, services, next(exchange), timeout_s, end, time.monotonic())
        )
        self.step()

    def step(self) -> bool:
        """Ask, take answers, give up; return whether any exchange is still under way."""
        for running in list(self._exchanges):
            try:
                word = self._go_on(running)
            except StopIteration:
                word = ""
            except Exception as error:  # noqa: BLE001 - one odd node must not end the others
                word = say("the answer of {node} cannot be understood: {error}", node=running.node, error=str(error))
            if word is not None:
                self._exchanges.remove(running)
                running.end(word)
        return bool(self._exchanges)

    def fail(self, error: Exception) -> None:
        """End every exchange that is under way."""
        while self._exchanges:
            self._exchanges.pop().end(reason_of(error))

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
        patience_s = _patience_s(running) + FOUND_WITHIN_S
        self._calls.begin(
            name,
            running.services.types[request.service],
            request.value,
            self._service(name),
            running.answer,
            patience_s,
        )

    def _missing(self, running: _RunningExchange) -> str | None:
        """Return why the node cannot be asked, "" if that is not known yet, None if it can."""
        node = self._node(running.node)
        running.was_there = running.was_there or node is not None
        if node and self._service(f"{running.node}/{running.request.service}"):
            for name, type_name in running.services.types.items():
                # All at once, so that not each has to wait again until the node has discovered it.
                self._calls.prepare(f"{running.node}/{name}", type_name)
            return None
        if time.monotonic() - running.asked_s < min(running.timeout_s, FOUND_WITHIN_S):
            return ""
        if node:
            return say(running.services.lacking, node=running.node)
        return _gone(running)

    def _lost_patience(self, running: _RunningExchange) -> str | None:
        if self._node(running.node) is None:
            return _gone(running)
        patience_s = _patience_s(running)
        if time.monotonic() - running.asked_s >= patience_s:
            return say("{node} does not answer within {seconds} s", node=running.node, seconds=f"{patience_s:g}")
        return None


def full_name(node: str) -> str:
    """Return the full name of a node, whose first slash may have been left out."""
    return node if node.startswith("/") else f"/{node}"


def _patience_s(running: _RunningExchange) -> float:
    within_s = running.request.within_s
    return running.timeout_s if within_s is None else within_s


def _gone(running: _RunningExchange) -> str:
    if running.was_there:
        return say("{node} has left the graph", node=running.node)
    return say("there is no node {node} in the graph", node=running.node)


LEVEL_SERVICES = ServiceSet(
    {
        "get_logger_levels": "rcl_interfaces/srv/GetLoggerLevels",
        "set_logger_levels": "rcl_interfaces/srv/SetLoggerLevels",
    },
    N_(
        "{node} does not let others change its log level; its program has to allow that: "
        "super().__init__(..., enable_logger_service=True), in C++ "
        "NodeOptions().enable_logger_service(true)"
    ),
)
DEFAULT = LOG_LEVELS["info"]
"""Of a logger whose level nobody has set, if there is no other default."""


class LoggerLevels:
    """The requests about log levels."""

    def __init__(self, exchanges: Exchanges) -> None:
        """Ask through `exchanges`, which reports every failure in words."""
        self._exchanges = exchanges

    def ask(self, node: str, level: str | None, future: Future[LevelResult]) -> None:
        """Read the level of a node's own logger, once it was set to one of `LOG_LEVELS` if one is given."""
        node = full_name(node)
        found: list[str] = []
        logger = logger_of(node)
        exchange = read_level(logger, found) if level is None else write_level(logger, LOG_LEVELS[level], found)

        def end(error: str) -> None:
            refused = error or (found[1] if len(found) > 1 else "")
            future.set_result(LevelResult(node, found[0] if found else "", refused))

        self._exchanges.begin(node, exchange, LEVEL_SERVICES, ANSWER_WITHIN_S, end)


def logger_of(node: str) -> str:
    """Return the name of a node's own logger: `arm.gripper` for `/arm/gripper`."""
    return node.strip("/").replace("/", ".")


def read_level(logger: str, found: list[str]) -> Exchange:
    """Put the level in effect into `found`: that of the logger, or of the next one above it."""
    parts = logger.split(".")
    names = [".".join(parts[:count]) for count in range(len(parts), -1, -1)]
    answer = yield NodeRequest("get_logger_levels", {"names": names})
    found[:] = [_named(next(filter(None, map(_level, answer["levels"])), DEFAULT))]


def write_level(logger: str, level: int, found: list[str]) -> Exchange:
    """Set the level; put the one in effect then into `found`, and why it was refused after it."""
    wanted: dict[str, Value] = {"name": logger, "level": level}
    answer = yield NodeRequest("set_logger_levels", {"levels": [wanted]})
    results = answer["results"]
    yield from read_level(logger, found)
    if not results or not results[0]["successful"]:
        reason = str(results[0]["reason"]) if results else ""
        found.append(reason or say("the node refuses it and gives no reason"))


def _level(told: Mapping[str, Any]) -> int:
    return int(told["level"])


def _named(level: int) -> str:
    return next((name for name, number in LOG_LEVELS.items() if number == level), str(level))
