"""Reads and sets the severity from which on a node logs, through its logger services."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from graph.calls.exchanges import NodeRequest, ServiceSet, full_name
from graph.inner_states import LOG_LEVELS, LevelResult
from text.i18n import N_
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping
    from concurrent.futures import Future

    from graph.calls.exchanges import Exchange, Exchanges
    from graph.data import Value

SERVICES = ServiceSet(
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

    def ask(self, node: str, level: str | None, timeout_s: float, future: Future[LevelResult]) -> None:
        """Read the level of a node's own logger, once it was set to one of `LOG_LEVELS` if one is given."""
        node = full_name(node)
        found: list[str] = []
        logger = logger_of(node)
        exchange = read(logger, found) if level is None else write(logger, LOG_LEVELS[level], found)

        def end(error: str) -> None:
            refused = error or (found[1] if len(found) > 1 else "")
            future.set_result(LevelResult(node, found[0] if found else "", refused))

        self._exchanges.begin(node, exchange, SERVICES, timeout_s, end)


def logger_of(node: str) -> str:
    """Return the name of a node's own logger: `arm.gripper` for `/arm/gripper`."""
    return node.strip("/").replace("/", ".")


def read(logger: str, found: list[str]) -> Exchange:
    """Put the level in effect into `found`: that of the logger, or of the next one above it."""
    parts = logger.split(".")
    names = [".".join(parts[:count]) for count in range(len(parts), -1, -1)]
    answer = yield NodeRequest("get_logger_levels", {"names": names})
    found[:] = [_named(next(filter(None, map(_level, answer["levels"])), DEFAULT))]


def write(logger: str, level: int, found: list[str]) -> Exchange:
    """Set the level; put the one in effect then into `found`, and why it was refused after it."""
    wanted: dict[str, Value] = {"name": logger, "level": level}
    answer = yield NodeRequest("set_logger_levels", {"levels": [wanted]})
    results = answer["results"]
    yield from read(logger, found)
    if not results or not results[0]["successful"]:
        reason = str(results[0]["reason"]) if results else ""
        found.append(reason or say("the node refuses it and gives no reason"))


def _level(told: Mapping[str, Any]) -> int:
    return int(told["level"])


def _named(level: int) -> str:
    return next((name for name, number in LOG_LEVELS.items() if number == level), str(level))
