"""The lifecycles of all nodes that have one: followed live, and changed.

A node publishes its transitions, whoever asked for them, but neither the state before that nor what
is possible then; so each node is asked when it appears, after a transition, and once in a while.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from graph.calls.exchanges import full_name
from graph.calls.lifecycle_exchange import (
    GET_STATE,
    GET_STATE_TYPE,
    SERVICES,
    ChangeFacts,
    LifecycleFacts,
    change,
    read,
    why_not,
)
from graph.data import ANSWER_WITHIN_S
from graph.inner_states import LifecycleRow, TransitionResult
from graph.messages.types import load_message

if TYPE_CHECKING:
    from collections.abc import Iterable
    from concurrent.futures import Future

    from rclpy.node import Node
    from rclpy.subscription import Subscription

    from graph.calls.exchanges import Exchanges
    from graph.data import NodeRow, ServiceRow

EVENT = "transition_event"
EVENT_TYPE = "lifecycle_msgs/msg/TransitionEvent"
EVENTS = 20
"""Queue between two looks."""
ASK_AGAIN_S = 5.0
"""A node that publishes no transitions, or hangs, is noticed after this long."""
ERROR_PROCESSING = "errorprocessing"


@dataclass
class _Followed:
    """A node whose state is followed."""

    subscription: Subscription
    row: LifecycleRow
    processes: tuple[int, ...]
    asking: bool = False
    again: bool = False
    """Whether its state may have changed since it was asked."""
    next_s: float = 0.0
    erred_s: float = -math.inf
    """When it was last seen to process an error."""


class Lifecycles:
    """Follows the nodes that have a lifecycle."""

    def __init__(self, node: Node, exchanges: Exchanges) -> None:
        """Listen through `node`, ask through `exchanges`."""
        self._node = node
        self._exchanges = exchanges
        self._followed: dict[str, _Followed] = {}

    def rows(self) -> tuple[LifecycleRow, ...]:
        """Return a row for each followed node, sorted by name."""
        return tuple(followed.row for _, followed in sorted(self._followed.items()))

    def tune(self, nodes: Iterable[NodeRow], services: Iterable[ServiceRow]) -> None:
        """Follow exactly the nodes that have a lifecycle in this graph."""
        there = managed(services)
        for name in self._followed.keys() - there:
            self._node.destroy_subscription(self._followed.pop(name).subscription)
        processes = {row.name: row.processes for row in nodes}
        for name in there:
            now = processes.get(name, ())
            followed = self._followed.get(name)
            if followed is None:
                self._followed[name] = _Followed(self._listen(name), LifecycleRow(name), now)
            elif now != followed.processes:
                # Another process has taken the name, and begins anew.
                followed.processes = now
                followed.again = True

    def look(self) -> None:
        """Take the transitions that were published, and ask where that is due."""
        for name, followed in self._followed.items():
            self._take_events(followed)
            due = followed.again or time.monotonic() >= followed.next_s
            if due and not followed.asking:
                self._ask(name, followed)

    def change(self, node: str, transition: str, timeout_s: float, future: Future[TransitionResult]) -> None:
        """Have a node make a transition; the result says in words why it was not made."""
        node = full_name(node)
        facts = ChangeFacts()
        asked_s = time.monotonic()

        def end(error: str) -> None:
            followed = self._followed.get(node)
            erred = False
            if followed is not None:
                self._take_events(followed)
                followed.again = True
                erred = followed.erred_s >= asked_s
            why = error or why_not(node, transition, facts, erred=erred)
            future.set_result(TransitionResult(node, transition, facts.after.state, why))

        self._exchanges.begin(node, change(transition, facts), SERVICES, timeout_s, end)

    def close(self) -> None:
        while self._followed:
            self._node.destroy_subscription(self._followed.popitem()[1].subscription)

    def _listen(self, name: str) -> Subscription:
        return self._node.create_subscription(
            load_message(EVENT_TYPE), f"{name}/{EVENT}", lambda _event: None, EVENTS
        )

    def _take_events(self, followed: _Followed) -> None:
        subscription: Any = followed.subscription
        while True:
            with subscription.handle:
                taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
            if taken is None:
                return
            state = str(taken[0].goal_state.label)
            followed.row = replace(followed.row, state=state, transitions=(), error="")
            followed.again = True
            if state == ERROR_PROCESSING:
                followed.erred_s = time.monotonic()

    def _ask(self, name: str, followed: _Followed) -> None:
        followed.asking, followed.again = True, False
        facts = LifecycleFacts()

        def end(error: str) -> None:
            followed.asking = False
            followed.next_s = time.monotonic() + ASK_AGAIN_S
            if error:
                followed.row = replace(followed.row, transitions=(), error=error)
            elif not followed.again:
                followed.row = LifecycleRow(name, facts.state, tuple(facts.transitions))

        self._exchanges.begin(name, read(facts), SERVICES, ANSWER_WITHIN_S, end)


def managed(services: Iterable[ServiceRow]) -> set[str]:
    """Return the full names of the nodes that have a lifecycle."""
    return {
        row.name.removesuffix(f"/{GET_STATE}")
        for row in services
        if row.name.endswith(f"/{GET_STATE}")
        and GET_STATE_TYPE in row.type_names
        and row.name.removesuffix(f"/{GET_STATE}") in row.nodes
    }
