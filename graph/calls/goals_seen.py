"""Goals that other clients have sent, as every action server publishes them, and how they end or are cancelled.

A server publishes the status of all its goals, latched, and their feedback; the sender of a goal and any other
subscriber receive the same. So Deck needs no client until it is asked to cancel one.
"""

from __future__ import annotations

import logging
import math
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from graph.calls.action_client import FEEDBACKS, PolledActionClient, Servers, status_topic
from graph.calls.goals import LOST, NO_WORD_OF_CANCEL, REFUSED, STATUS
from graph.data import ANSWER_WITHIN_S, GoalStatus, SeenGoal
from graph.messages.fields import to_tree
from graph.messages.types import UnknownTypeError, load_action
from graph.ros import subscribe, taken, unsubscribe
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from rclpy.node import Node
    from rclpy.subscription import Subscription

    from graph.data import ActionRow


ID_BYTES = 16


class Cancelling:
    """One request to cancel, until it is answered; call `step` repeatedly, then `close`."""

    def __init__(self, node: Node, action: str, type_name: str, goal_id: str) -> None:
        """Make the client. Raises UnknownTypeError, ValueError, and what rclpy raises."""
        self.action = action
        self._id = bytes.fromhex(goal_id)
        # A request with an all-zero id cancels all goals (source: action_msgs/CancelGoal).
        if len(self._id) != ID_BYTES or not any(self._id):
            raise ValueError(f"{goal_id} is no id of a goal")
        self._client = PolledActionClient(node, action, type_name)
        self._began_s = time.monotonic()
        self._request: int | None = None

    def step(self, status: GoalStatus | None) -> str | None:
        """Continue; return the outcome: why it was refused, or an empty text; None while waiting.

        `status` is the goal's status by now: the server's answer may get lost, the status does not.
        """
        heard = self._client.take()
        if status is not None and (status.ended or status is GoalStatus.CANCELING):
            return ""
        if self._request is None:
            if self._client.is_ready:
                self._request = self._client.cancel(self._id)
        elif self._request in heard.cancelled:
            return "" if heard.cancelled[self._request] else say(REFUSED)
        if time.monotonic() - self._began_s < ANSWER_WITHIN_S:
            return None
        return say(NO_WORD_OF_CANCEL, seconds=f"{ANSWER_WITHIN_S:g}")

    def close(self) -> None:
        self._client.close()


logger = logging.getLogger(__name__)

LONGEST_S = 24 * 3600.0
"""A goal that seems older than this was dated by another clock, such as a simulation's."""
NANOSECONDS = 1e-9


@dataclass
class _Seen:
    """One goal of another client."""

    told: SeenGoal
    accepted_s: float
    """Unix time by its server's clock."""
    ended_s: float | None = None
    """When it was seen to end; None also if it had ended before Deck began to look."""

    def snapshot(self, error: str) -> SeenGoal:
        now_s = None if self.told.ended else time.time()
        age_s = (self.ended_s or now_s or math.inf) - self.accepted_s
        sane_s = age_s if 0 <= age_s <= LONGEST_S else None
        return replace(self.told, age_s=sane_s, error=error or self.told.error)


class SeenAction:
    """What is known of the goals of one action."""

    def __init__(self, node: Node, action: str, type_name: str) -> None:
        """Subscribe. Raises what rclpy raises for an invalid name."""
        from action_msgs.msg import GoalStatusArray
        from rclpy.qos import QoSProfile, qos_profile_action_status_default

        self.action = action
        self.type_name = type_name
        self._node = node
        self._servers = Servers(node, action)
        self._since_s = time.time()
        self._before: frozenset[bytes] = frozenset()
        self._goals: dict[bytes, _Seen] = {}
        self._status = subscribe(node, GoalStatusArray, status_topic(action), qos_profile_action_status_default)
        self._feedback: Subscription | None = None
        try:
            kind: Any = load_action(type_name)
        except UnknownTypeError:
            # The type of its feedback is unknown here; its status has the same type everywhere.
            return
        self._feedback = subscribe(
            node, kind.Impl.FeedbackMessage, f"{action}/_action/feedback", QoSProfile(depth=FEEDBACKS)
        )

    def take(self) -> None:
        for message, _info in taken(self._status, 2 * FEEDBACKS):
            self._hear_status(message.status_list)
        for message, _info in taken(self._feedback, 2 * FEEDBACKS) if self._feedback else ():
            seen = self._goals.get(bytes(message.goal_id.uuid))
            if seen is not None:
                count = seen.told.feedback_count + 1
                feedback = to_tree(message.feedback)
                seen.told = replace(seen.told, feedback=feedback, feedback_count=count)
        servers = self._servers.now()
        if self._before - servers:
            self._lose()
        self._before = servers

    def rows(self, is_own: Callable[[bytes], bool], errors: Mapping[str, str]) -> Iterable[SeenGoal]:
        """Yield the goals of others, in the order in which they were accepted."""
        for goal_id, seen in sorted(self._goals.items(), key=lambda item: item[1].accepted_s):
            if not is_own(goal_id):
                yield seen.snapshot(errors.get(seen.told.goal_id, ""))

    def status_of(self, goal_id: str) -> GoalStatus | None:
        """Return the status of this goal; None if nothing is known of it."""
        seen = self._goals.get(bytes.fromhex(goal_id))
        return None if seen is None else seen.told.status

    def close(self) -> None:
        for subscription in filter(None, (self._status, self._feedback)):
            unsubscribe(self._node, subscription)

    def _hear_status(self, listed: Iterable[Any]) -> None:
        """Process a status list; goals that the server no longer lists are forgotten here, too."""
        before, self._goals = self._goals, {}
        for each in listed:
            status = STATUS.get(each.status)
            goal_id = bytes(each.goal_info.goal_id.uuid)
            if status is None:
                continue
            stamp = each.goal_info.stamp
            seen = before.get(goal_id) or _Seen(
                SeenGoal(self.action, self.type_name, goal_id.hex(), status), stamp.sec + stamp.nanosec * NANOSECONDS
            )
            self._goals[goal_id] = seen
            self._end(seen, status)

    def _lose(self) -> None:
        for seen in self._goals.values():
            if not seen.told.ended:
                self._end(seen, GoalStatus.FAILED)
                seen.told = replace(seen.told, error=say(LOST))

    def _end(self, seen: _Seen, status: GoalStatus) -> None:
        # A very short goal may be noticed only after it has ended.
        goes_on = not seen.told.ended or seen.accepted_s >= self._since_s
        seen.told = replace(seen.told, status=status)
        if seen.told.ended and seen.ended_s is None and goes_on:
            seen.ended_s = time.time()


class SeenGoals:
    """The actions that are watched."""

    def __init__(self, node: Node, is_own: Callable[[bytes], bool]) -> None:
        """`is_own` returns whether Deck itself has sent the goal with this id."""
        self._node = node
        self._is_own = is_own
        self._actions: dict[str, SeenAction] = {}
        self._cancelling: dict[str, Cancelling] = {}
        self._errors: dict[str, str] = {}
        """Id to why that goal was not cancelled."""

    def tune(self, wanted: frozenset[str], known: Iterable[ActionRow]) -> None:
        """Subscribe to exactly the actions that are wanted and known."""
        types = {row.name: row.type_names[0] for row in known if row.name in wanted}
        for name, action in list(self._actions.items()):
            if name not in wanted or types.get(name, action.type_name) != action.type_name:
                self._actions.pop(name).close()
        for name, type_name in types.items():
            if name not in self._actions:
                try:
                    self._actions[name] = SeenAction(self._node, name, type_name)
                except Exception:
                    # Only other programs allow this name; the rest of the graph is still reported.
                    logger.exception("the goals of %s cannot be seen", name)

    def step(self) -> bool:
        """Take what has arrived; return whether the answer to a request to cancel is due."""
        for action in self._actions.values():
            action.take()
        for goal_id, cancelling in list(self._cancelling.items()):
            action_of = self._actions.get(cancelling.action)
            error = cancelling.step(None if action_of is None else action_of.status_of(goal_id))
            if error is not None:
                self._errors[goal_id] = error
                self._cancelling.pop(goal_id).close()
        return bool(self._cancelling)

    def rows(self) -> tuple[SeenGoal, ...]:
        """Return the goals of other clients."""
        return tuple(
            row for _name, action in sorted(self._actions.items()) for row in action.rows(self._is_own, self._errors)
        )

    def cancel(self, action: str, goal_id: str, type_name: str = "") -> None:
        """Ask for a goal to be cancelled; without a type only if its action is watched and it has not ended."""
        if not type_name:
            seen = self._actions.get(action)
            status = None if seen is None else seen.status_of(goal_id)
            if seen is None or status is None or status.ended:
                return
            type_name = seen.type_name
        if goal_id in self._cancelling:
            return
        self._errors.pop(goal_id, None)
        try:
            self._cancelling[goal_id] = Cancelling(self._node, action, type_name, goal_id)
        except Exception as error:  # noqa: BLE001 - an unknown type, or what rclpy raises
            self._errors[goal_id] = say("it cannot be cancelled: {error}", error=str(error))

    def close(self) -> None:
        for action in self._actions.values():
            action.close()
        for cancelling in self._cancelling.values():
            cancelling.close()
        self._actions.clear()
        self._cancelling.clear()
