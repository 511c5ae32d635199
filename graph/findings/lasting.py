"""Findings over time: what holds only while nodes start or end is not told.

On a slow machine the nodes of a robot come one after the other, for longer than a finding takes to
settle; so it settles once no node has come or gone for as long. Where one comes and goes for ever,
it is reported nevertheless, after `CHANGING_S`.
"""

from __future__ import annotations

import math
from types import MappingProxyType
from typing import TYPE_CHECKING

from graph.findings.examining import examine

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import GraphUpdate
    from graph.findings.finding import GraphFinding, GraphNorms


CHANGING_S = 20.0
"""So long at most is a graph waited for whose nodes change."""


class LastingFindings:
    """The findings of one graph that have held for long enough."""

    def __init__(self, norms: GraphNorms) -> None:
        self._norms = norms
        self._since_s: dict[str, float] = {}
        self._found: tuple[GraphFinding, ...] = ()
        self._nodes: frozenset[str] = frozenset()
        self._changed_s = -math.inf
        self._told: set[str] = set()

    def take(self, update: GraphUpdate, now_s: float, failures: Mapping[str, str] = MappingProxyType({})) -> None:
        """Examine the graph as it is at `now_s`, on any clock that runs steadily.

        `failures`: full name to why, of nodes that have ended for good.
        """
        if update.error:
            return
        nodes = frozenset(node.name for node in update.nodes)
        if nodes != self._nodes:
            self._nodes, self._changed_s = nodes, now_s
        self._found = examine(update, self._norms, failures)
        self._since_s = {one.key: self._since_s.get(one.key, now_s) for one in self._found}
        self._told &= self._since_s.keys()

    def told(self, now_s: float) -> tuple[GraphFinding, ...]:
        """Return those that have held long enough by `now_s`, the worst first."""
        told = tuple(one for one in self._found if self._left_s(one, now_s) <= 0.0)
        self._told |= {one.key for one in told}
        return told

    def settles_in_s(self, now_s: float) -> float | None:
        """Return how long the last of those that are still to be reported needs; None without one."""
        left_s = [left for one in self._found if (left := self._left_s(one, now_s)) > 0.0]
        return max(left_s, default=None)

    def forget(self) -> None:
        """Start over, for another graph."""
        self._found, self._since_s = (), {}
        self._nodes, self._changed_s = frozenset(), -math.inf
        self._told = set()

    def _left_s(self, finding: GraphFinding, now_s: float) -> float:
        if finding.key in self._told:
            return 0.0
        held_s, same_s = now_s - self._since_s[finding.key], now_s - self._changed_s
        left_s = finding.settled_s - min(held_s, same_s)
        return left_s if held_s < CHANGING_S else finding.settled_s - held_s
