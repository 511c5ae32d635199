"""Actions: goal handles, feedback, results, and the two classes that stand outside of a node."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, Any

from launcher.faults.failure import Failure, is_from, is_message_class, name_of, shown
from launcher.faults.rules.attributes import expression
from launcher.faults.rules.own_attributes import wanted
from text.sentences import say
from text.suggestions import nearest

if TYPE_CHECKING:
    from text.sentences import Words

_MAKERS = {
    "create_action_client": "ActionClient(self, Fibonacci, 'name')",
    "create_action_server": "ActionServer(self, Fibonacci, 'name', self.execute)",
}
_RESULTS = ("result", "get_result")


def made_outside(failure: Failure) -> Words | None:
    """A node was asked to make an action's client or server, which have classes of their own."""
    found = wanted(failure)
    if found is None or found[1] not in _MAKERS or not is_from(found[0], "rclpy", "Node"):
        return None
    call = _MAKERS[found[1]]
    return say(
        "A node makes no actions; they have classes of their own: {call}, from rclpy.action import {name}.",
        call=call,
        name=call.partition("(")[0],
    )


def of_handle(failure: Failure) -> Words | None:
    """A goal's handle was taken for the goal, or for its result."""
    found = wanted(failure)
    if found is None:
        return None
    of, name = found
    node = expression(failure, name)
    what = shown(node.value) if node is not None else "goal_handle"
    if is_from(of, "rclpy", "ClientGoalHandle"):
        return _of_client(of, name, what)
    if is_from(of, "rclpy", "ServerGoalHandle"):
        return _of_server(of, name, what)
    return None


def _of_client(of: Any, name: str, what: str) -> Words | None:  # noqa: ANN401
    if name not in _RESULTS and nearest(name, [each for each in dir(of) if each[0] != "_"]):
        return None
    return say(
        "{what} is the goal's handle, not its result: {what}.get_result_async() gives a future, and"
        " in the done callback of that future.result().result is the result.",
        what=what,
    )


def _of_server(of: Any, name: str, what: str) -> Words | None:  # noqa: ANN401
    fields = list(of.request.get_fields_and_field_types())
    if name == "goal" or name in fields:
        return say(
            "{what} is the goal's handle; the goal itself is {what}.request: {what}.request.{field}.",
            what=what,
            field=name if name in fields else next(iter(fields), "x"),
        )
    return None


def result(failure: Failure) -> Words | None:
    """The callback of an action's server has not returned its result."""
    level = failure.inner
    if level is None or not isinstance(failure.error, AssertionError) or level.function != "result":
        return None
    kind = type(level.values.get("self")).__name__
    if not kind.endswith("_GetResult_Response"):
        return None
    action, value = kind.removesuffix("_GetResult_Response"), level.values.get("value")
    if value is None:
        return say(
            "The action's callback has to return the result in every case: return {action}.Result().", action=action
        )
    given: str = name_of(type(value))
    if isinstance(value, type):
        given = say("the class {name}", name=name_of(value))
    return say(
        "The action's callback has to return {action}.Result(), filled, and returns {given}.",
        action=action,
        given=given,
    )


def feedback(failure: Failure) -> Words | None:
    """`publish_feedback` was given something else than feedback."""
    level = next((each for each in failure.below("rclpy") if each.function == "publish_feedback"), None)
    if level is None or not isinstance(failure.error, (TypeError, AssertionError)):
        return None
    value = level.values.get("feedback")
    action = level.values["self"]._action_server.action_type  # noqa: SLF001 - nobody else knows
    if is_message_class(type(value)) and isinstance(value, action.Feedback):
        return None
    return say(
        "publish_feedback takes {action}.Feedback(), filled, and is given {given}.",
        action=action.__name__,
        given=name_of(value if isinstance(value, type) else type(value)),
    )


def ended(failure: Failure) -> Words | None:
    """A goal was ended twice, or cancelled without having been asked to."""
    if type(failure.error).__name__ != "RCLError" or not failure.first(ast.Call):
        return None
    level = next((each for each in failure.below("rclpy")), None)
    if level is None or level.function not in ("succeed", "abort", "canceled"):
        return None
    if level.function == "canceled":
        return say(
            "Only a goal that somebody has cancelled ends by canceled(): ask before, if"
            " goal_handle.is_cancel_requested."
        )
    return say("The goal has ended already: succeed, abort or canceled comes once, at the end.")


RULES = (made_outside, of_handle, feedback, ended)
