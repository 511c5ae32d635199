"""Reads and sets the parameters of any node, any number of nodes at once, without blocking."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from graph.calls.exchanges import full_name
from graph.calls.parameters_exchange import SERVICES, read, write
from graph.data import ParametersResult, SetResult

if TYPE_CHECKING:
    from collections.abc import Mapping
    from concurrent.futures import Future

    from graph.calls.exchanges import Exchanges
    from graph.data import ParameterRow, Value


class ParameterCalls:
    """The requests about parameters."""

    def __init__(self, exchanges: Exchanges) -> None:
        """Ask through `exchanges`, which reports every failure in words."""
        self._exchanges = exchanges

    def read(self, node: str, timeout_s: float, future: Future[ParametersResult]) -> None:
        """Read all parameters of a node, with their descriptors; failures are reported in words."""
        node, started_s = full_name(node), time.monotonic()
        rows: list[ParameterRow] = []

        def end(error: str) -> None:
            taken = () if error else tuple(rows)
            future.set_result(ParametersResult(node, taken, error, time.monotonic() - started_s))

        self._exchanges.begin(node, read(rows), SERVICES, timeout_s, end)

    def write(self, node: str, values: Mapping[str, Value], timeout_s: float, future: Future[SetResult]) -> None:
        """Set parameters of a node, each independently; failures are reported in words."""
        node, started_s = full_name(node), time.monotonic()
        refused: dict[str, str] = {}

        def end(error: str) -> None:
            future.set_result(SetResult(node, refused, error, time.monotonic() - started_s))

        if values:
            self._exchanges.begin(node, write(values, refused), SERVICES, timeout_s, end)
        else:
            end("")
