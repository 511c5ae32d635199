"""The exchange with a node about its lifecycle: its state, and what leads out of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from graph.calls.exchanges import NodeRequest, ServiceSet
from text.i18n import N_
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping

    from graph.calls.exchanges import Exchange

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


def change(transition: str, facts: ChangeFacts) -> Exchange:
    """Ask for a transition by its name, if it is possible now; what comes of it is in `facts`."""
    yield from read(facts.before)
    number = facts.before.transitions.get(transition)
    if number is None:
        facts.after = facts.before
        return
    answer = yield NodeRequest("change_state", {"transition": {"id": number, "label": transition}}, CHANGE_WITHIN_S)
    facts.success = bool(answer["success"])
    yield from read(facts.after)


def why_not(node: str, transition: str, facts: ChangeFacts, *, erred: bool) -> str:
    """Say why a transition was not done, empty if it was.

    `erred`: the node was seen to process an error meanwhile, which its answer does not tell.
    """
    before, after = facts.before, facts.after
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
