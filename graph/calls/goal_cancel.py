"""Cancels one goal that another client has sent: a client for this alone, and its answer."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from graph.calls.action_client import PolledActionClient
from graph.calls.goal_life import NO_WORD_OF_CANCEL, REFUSED
from graph.data import ANSWER_WITHIN_S, GoalStatus
from text.sentences import say

if TYPE_CHECKING:
    from rclpy.node import Node

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
