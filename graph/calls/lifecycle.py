"""The lifecycles of all nodes that have one, followed live and changed; and what containers of components hold.

A node publishes its transitions, whoever asked for them, but neither the state before that nor what is possible then;
so each node is asked when it appears, after a transition, and once in a while.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from graph.calls.exchanges import NodeRequest, ServiceSet, full_name
from graph.data import ANSWER_WITHIN_S
from graph.inner_states import ComponentRow, ContainerRow, LifecycleRow, TransitionResult
from graph.messages.types import load_message
from graph.ros import subscribe, taken, unsubscribe
from text.i18n import N_
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable, Mapping
    from concurrent.futures import Future

    from rclpy.node import Node
    from rclpy.subscription import Subscription

    from graph.calls.exchanges import Exchange, Exchanges
    from graph.data import NodeRow, ServiceRow, Value


CHANGE_WITHIN_S = 20.0
"""How long a transition may take; a driver that looks for its camera takes its time."""
INNER_FROM = 10
"""Numbers of transitions that a node makes by itself. Source: lifecycle_msgs/msg/Transition."""
GET_STATE = "get_state"
GET_STATE_TYPE = "lifecycle_msgs/srv/GetState"
SERVICES = ServiceSet(
    {
        GET_STATE: GET_STATE_TYPE,
        "get_available_transitions": "lifecycle_msgs/srv/GetAvailableTransitions",
        "change_state": "lifecycle_msgs/srv/ChangeState",
    },
    N_("{node} has no lifecycle: it is an ordinary node, at work as long as it runs"),
)


@dataclass
class LifecycleFacts:
    """What a node has told."""

    state: str = ""
    transitions: dict[str, int] = field(default_factory=dict)
    """Those possible in this state, with their numbers."""


@dataclass
class ChangeFacts:
    """What came of a transition."""

    transition: str
    """The name of it, or the number until the node has told which that is."""
    before: LifecycleFacts = field(default_factory=LifecycleFacts)
    after: LifecycleFacts = field(default_factory=LifecycleFacts)
    success: bool | None = None
    """The node's answer; None if it was not asked, since the transition is not possible."""


def read(facts: LifecycleFacts) -> Exchange:
    """Read state and possible transitions into `facts`."""
    answer = yield NodeRequest(GET_STATE, {})
    facts.state = str(answer["current_state"]["label"])
    answer = yield NodeRequest("get_available_transitions", {})
    facts.transitions = dict(_outer(answer))


def change(facts: ChangeFacts) -> Exchange:
    """Ask for the transition if it is possible now; what comes of it is in `facts`."""
    yield from read(facts.before)
    names = {str(number): name for name, number in facts.before.transitions.items()}
    facts.transition = names.get(facts.transition, facts.transition)
    number = facts.before.transitions.get(facts.transition)
    if number is None:
        facts.after = facts.before
        return
    wanted: Value = {"id": number, "label": facts.transition}
    answer = yield NodeRequest("change_state", {"transition": wanted}, CHANGE_WITHIN_S)
    facts.success = bool(answer["success"])
    yield from read(facts.after)


def why_not(node: str, facts: ChangeFacts, *, erred: bool) -> str:
    """Say why a transition was not done, empty if it was.

    `erred`: the node was seen to process an error meanwhile, which its answer does not tell.
    """
    before, after, transition = facts.before, facts.after, facts.transition
    if facts.success:
        return ""
    words = {"node": node, "transition": transition, "state": after.state, "before": before.state}
    if facts.success is None:
        if not before.transitions:
            return say("{node} is {state}: nothing leads out of that state", **words)
        possible = ", ".join(before.transitions)
        return say(
            "{node} is {state}: {transition} is not possible there, only {possible}", possible=possible, **words
        )
    if after.state == "finalized" and transition != "shutdown":
        return say(
            "{transition} failed with an error that {node} could not recover from: it is "
            "finalized, and has to be restarted; its log may say why",
            **words,
        )
    if erred or after.state != before.state:
        return say(
            "{transition} failed with an error in {node}, which is now {state}; its log may say "
            "why, but rclpy itself logs no exception raised there",
            **words,
        )
    return say("{node} refuses to {transition} and stays {state}; its log may say why", **words)


def _outer(answer: Mapping[str, Any]) -> Generator[tuple[str, int], None, None]:
    for each in answer["available_transitions"]:
        number = int(each["transition"]["id"])
        if number < INNER_FROM:
            yield str(each["transition"]["label"]), number


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
            unsubscribe(self._node, self._followed.pop(name).subscription)
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

    def change(self, node: str, transition: str, future: Future[TransitionResult]) -> None:
        """Have a node make a transition; the result says in words why it was not made."""
        node = full_name(node)
        facts = ChangeFacts(transition)
        asked_s = time.monotonic()

        def end(error: str) -> None:
            followed = self._followed.get(node)
            erred = False
            if followed is not None:
                self._take_events(followed)
                followed.again = True
                erred = followed.erred_s >= asked_s
            why = error or why_not(node, facts, erred=erred)
            future.set_result(TransitionResult(node, transition, facts.after.state, why))

        self._exchanges.begin(node, change(facts), SERVICES, ANSWER_WITHIN_S, end)

    def close(self) -> None:
        while self._followed:
            unsubscribe(self._node, self._followed.popitem()[1].subscription)

    def _listen(self, name: str) -> Subscription:
        return subscribe(self._node, load_message(EVENT_TYPE), f"{name}/{EVENT}", EVENTS)

    def _take_events(self, followed: _Followed) -> None:
        for event, _info in taken(followed.subscription, EVENTS):
            state = str(event.goal_state.label)
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


LIST_NODES = "_container/list_nodes"
LIST_NODES_TYPE = "composition_interfaces/srv/ListNodes"
CONTAINER_SERVICES = ServiceSet({LIST_NODES: LIST_NODES_TYPE}, N_("{node} holds no components"))
LIST_AGAIN_S = 10.0
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
            asked.next_s = time.monotonic() + LIST_AGAIN_S
            if error:
                asked.row = replace(asked.row, error=error)
            else:
                asked.row = ContainerRow(name, tuple(found))

        self._exchanges.begin(name, read_components(found), CONTAINER_SERVICES, ANSWER_WITHIN_S, end)


def containers(services: Iterable[ServiceRow]) -> set[str]:
    """Return the full names of the containers."""
    return {
        row.name.removesuffix(f"/{LIST_NODES}")
        for row in services
        if row.name.endswith(f"/{LIST_NODES}") and LIST_NODES_TYPE in row.type_names
    }


def read_components(found: list[ComponentRow]) -> Exchange:
    """Put what a container holds into `found`, sorted by number."""
    answer: Mapping[str, Any] = yield NodeRequest(LIST_NODES, {})
    ids = [int(number) for number in answer["unique_ids"]]
    names = [str(name) for name in answer["full_node_names"]]
    found += sorted(
        (ComponentRow(number, name) for number, name in zip(ids, names, strict=True)), key=lambda row: row.unique_id
    )
