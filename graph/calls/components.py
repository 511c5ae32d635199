"""Asks containers of components which ones they hold, again after each change of the graph."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from graph.calls.exchanges import NodeRequest, ServiceSet
from graph.data import ANSWER_WITHIN_S
from graph.inner_states import ComponentRow, ContainerRow
from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from graph.calls.exchanges import Exchange, Exchanges
    from graph.data import NodeRow, ServiceRow

LIST_NODES = "_container/list_nodes"
LIST_NODES_TYPE = "composition_interfaces/srv/ListNodes"
SERVICES = ServiceSet({LIST_NODES: LIST_NODES_TYPE}, N_("{node} holds no components"))
ASK_AGAIN_S = 10.0
"""A component that makes no node of its own is noticed after this long."""


@dataclass
class _Asked:
    row: ContainerRow
    asking: bool = False
    again: bool = True
    next_s: float = 0.0


class Containers:
    """The containers of the graph."""

    def __init__(self, exchanges: Exchanges) -> None:
        """Ask through `exchanges`, which reports every failure in words."""
        self._exchanges = exchanges
        self._asked: dict[str, _Asked] = {}
        self._nodes: frozenset[str] = frozenset()

    def rows(self) -> tuple[ContainerRow, ...]:
        """Return a row for each container, sorted by name."""
        return tuple(asked.row for _, asked in sorted(self._asked.items()))

    def tune(self, nodes: Iterable[NodeRow], services: Iterable[ServiceRow]) -> None:
        """Keep exactly the containers of this graph."""
        there = containers(services)
        for name in self._asked.keys() - there:
            del self._asked[name]
        for name in there - self._asked.keys():
            self._asked[name] = _Asked(ContainerRow(name))
        names = frozenset(row.name for row in nodes)
        if names != self._nodes:
            self._nodes = names
            for asked in self._asked.values():
                asked.again = True

    def look(self) -> None:
        for name, asked in self._asked.items():
            if not asked.asking and (asked.again or time.monotonic() >= asked.next_s):
                self._ask(name, asked)

    def _ask(self, name: str, asked: _Asked) -> None:
        asked.asking, asked.again = True, False
        found: list[ComponentRow] = []

        def end(error: str) -> None:
            asked.asking = False
            asked.next_s = time.monotonic() + ASK_AGAIN_S
            if error:
                asked.row = replace(asked.row, error=error)
            else:
                asked.row = ContainerRow(name, tuple(found))

        self._exchanges.begin(name, read(found), SERVICES, ANSWER_WITHIN_S, end)


def containers(services: Iterable[ServiceRow]) -> set[str]:
    """Return the full names of the containers."""
    return {
        row.name.removesuffix(f"/{LIST_NODES}")
        for row in services
        if row.name.endswith(f"/{LIST_NODES}") and LIST_NODES_TYPE in row.type_names
    }


def read(found: list[ComponentRow]) -> Exchange:
    """Put what a container holds into `found`, sorted by number."""
    answer: Mapping[str, Any] = yield NodeRequest(LIST_NODES, {})
    ids = [int(number) for number in answer["unique_ids"]]
    names = [str(name) for name in answer["full_node_names"]]
    found += sorted(
        (ComponentRow(number, name) for number, name in zip(ids, names, strict=True)), key=lambda row: row.unique_id
    )
