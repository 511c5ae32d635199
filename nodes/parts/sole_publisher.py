"""Checks whether another node publishes what only this node should, and so bypasses it.

ROS lets anybody publish anything; a node can only name who does. It does not refuse to run: the
endpoint of a killed node stays for up to 20 s, and its successor must drive.
"""

from __future__ import annotations

import time
from collections import Counter
from typing import TYPE_CHECKING

from text.i18n import N_

if TYPE_CHECKING:
    from nodes.parts.node import LessonNode

_LOOK_EVERY_S = 1.0
_SAY_EVERY_S = 10.0
_NAMELESS = "_NODE_NAME_UNKNOWN_"
"""Source: rmw, `get_topic_endpoint_info.h`."""
_NAMED_WITHIN_S = 3.0
"""The name of an endpoint is known a little later than the endpoint; that of a program without a
ROS node never is."""
_FOUND_WITHIN_S = 5.0
"""Endpoints found this soon after the start may be left over from a dead node of this name."""
_FORGOTTEN_S = 25.0
"""By then the middleware has removed such an endpoint."""

SLOWEST = N_("{topic} is also published by {others}: the slowest command counts")
LOWEST = N_("{topic} is published by several, {others}: the lowest distance counts")
_NO_NODE = N_("a program without a node's name")
_NAMESAKE = N_("another {name}")


class SolePublisher:
    """Looks once a second for several publishers of a topic, and names them."""

    def __init__(self, node: LessonNode, topic: str, *, own: bool = False, others: str) -> None:
        """Say `others` of them; `own`: the node publishes it itself, else one other may."""
        self._node, self._topic, self._words = node, topic, others
        self._own = node.get_fully_qualified_name() if own else ""
        self._began_s = time.monotonic()
        self._seen_s: dict[str, float] = {}
        self._told: frozenset[str] = frozenset()
        node.every(_LOOK_EVERY_S, self._look)

    def _look(self) -> None:
        others = self._others() if self._node.count_publishers(self._topic) > 1 else []
        if not self._own and len(others) < 2:
            # One that was started again: what is left of its last run is in the graph for a while.
            others = []
        if others:
            every_s = 0.0 if frozenset(others) - self._told else _SAY_EVERY_S
            names = ", ".join(sorted(others))
            self._node.say.warn(self._words, every_s=every_s, topic=self._topic, others=names)
        self._told = frozenset(others)

    def _others(self) -> list[str]:
        names = Counter(
            f"{one.node_namespace.rstrip('/')}/{one.node_name}"
            for one in self._node.get_publishers_info_by_topic(self._topic)
        )
        if self._own:
            names[self._own] -= 1
        now_s = time.monotonic()
        self._seen_s = {name: self._seen_s.get(name, now_s) for name in +names}
        return [self._called(name) for name, at_s in self._seen_s.items() if self._is_sure(name, at_s)]

    def _is_sure(self, name: str, seen_s: float) -> bool:
        now_s = time.monotonic()
        if name.endswith(_NAMELESS):
            return now_s - seen_s > _NAMED_WITHIN_S
        left_over = name == self._own and seen_s - self._began_s < _FOUND_WITHIN_S
        return not left_over or now_s - self._began_s > _FORGOTTEN_S

    def _called(self, name: str) -> str:
        if name.endswith(_NAMELESS):
            return self._node.say.text(_NO_NODE)
        return self._node.say.text(_NAMESAKE, name=name) if name == self._own else name
