"""Findings over time: what holds only for a moment, while nodes start or end, is not told."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING

from graph.findings.examining import examine

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import GraphUpdate
    from graph.findings.finding import GraphFinding, GraphNorms


class LastingFindings:
    """The findings of one graph that have held for long enough."""

    def __init__(self, norms: GraphNorms) -> None:
        self._norms = norms
        self._since_s: dict[str, float] = {}
        self._found: tuple[GraphFinding, ...] = ()

    def take(
        self,
        update: GraphUpdate,
        now_s: float,
        failures: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        """Examine the graph as it is at `now_s`, on any clock that runs steadily.

        `failures`: full name to why, of nodes that have ended for good.
        """
        if update.error:
            return
        self._found = examine(update, self._norms, failures)
        self._since_s = {one.key: self._since_s.get(one.key, now_s) for one in self._found}

    def told(self, now_s: float) -> tuple[GraphFinding, ...]:
        """Return those that have held long enough by `now_s`, the worst first."""
        return tuple(one for one in self._found if self._left_s(one, now_s) <= 0.0)

    def settles_in_s(self, now_s: float) -> float | None:
        """Return how long the last of those that are still to be told needs; None without one."""
        left_s = [left for one in self._found if (left := self._left_s(one, now_s)) > 0.0]
        return max(left_s, default=None)

    def forget(self) -> None:
        """Start over, for another graph."""
        self._found, self._since_s = (), {}

    def _left_s(self, finding: GraphFinding, now_s: float) -> float:
        return finding.settled_s - (now_s - self._since_s[finding.key])
