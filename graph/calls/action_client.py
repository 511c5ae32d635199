"""The client side of one action: sends requests and takes what has arrived, without blocking.

rclpy's own ActionClient needs an executor to wake it; this one holds the same rcl handle and is
polled a few times a second.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from graph.messages.types import load_action

if TYPE_CHECKING:
    from rclpy.node import Node

FEEDBACKS = 100
"""Queue between two polls."""
LOOK_AT_SERVERS_S = 0.25


@dataclass
class GoalAnswers:
    """What has arrived since the previous poll; responses by the number of their request."""

    accepted: dict[int, bool] = field(default_factory=dict)
    results: dict[int, Any] = field(default_factory=dict)
    cancelled: dict[int, bool] = field(default_factory=dict)
    """Whether the server agreed to cancel, or the goal has just ended."""
    feedback: dict[bytes, list[Any]] = field(default_factory=dict)
    """By the goal's id, oldest first."""
    status: dict[bytes, int] = field(default_factory=dict)
    """Numbers of action_msgs/GoalStatus by the goal's id."""


class Servers:
    """Who serves an action, looked up a few times a second at most."""

    def __init__(self, node: Node, action: str) -> None:
        self._node = node
        self._status_topic = status_topic(action)
        self._servers: frozenset[bytes] = frozenset()
        self._looked_s = 0.0

    def now(self) -> frozenset[bytes]:
        """Return an identifier of each existing server; a restarted server has a new one."""
        now_s = time.monotonic()
        if now_s - self._looked_s >= LOOK_AT_SERVERS_S:
            self._looked_s = now_s
            ends = self._node.get_publishers_info_by_topic(self._status_topic)
            self._servers = frozenset(bytes(end.endpoint_gid) for end in ends)
        return self._servers


def status_topic(action: str) -> str:
    """Return the topic on which the servers of an action publish the status of all goals."""
    return f"{action}/_action/status"


class PolledActionClient:
    """The client of one action."""

    def __init__(self, node: Node, action: str, type_name: str) -> None:
        """Create the client. Raises UnknownTypeError, and what rclpy raises for an invalid name."""
        from rclpy.impl.implementation_singleton import rclpy_implementation
        from rclpy.qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default

        self.type: Any = load_action(type_name)
        self.servers = Servers(node, action).now
        services = qos_profile_services_default.get_c_qos_profile()
        with node.handle:
            self._handle: Any = rclpy_implementation.ActionClient(
                node.handle,
                self.type,
                action,
                services,
                services,
                services,
                QoSProfile(depth=FEEDBACKS).get_c_qos_profile(),
                qos_profile_action_status_default.get_c_qos_profile(),
            )

    @property
    def is_ready(self) -> bool:
        """Whether a server exists and is matched."""
        ready: bool = self._handle.is_action_server_available()
        return ready

    def send(self, goal_id: bytes, goal: Any) -> int:  # noqa: ANN401 - generated
        """Send a goal; return the number of the request."""
        request = self.type.Impl.SendGoalService.Request()
        request.goal_id.uuid = list(goal_id)
        request.goal = goal
        number: int = self._handle.send_goal_request(request)
        return number

    def ask_result(self, goal_id: bytes) -> int:
        """Ask for the result of a goal, once there is one; return the number of the request."""
        request = self.type.Impl.GetResultService.Request()
        request.goal_id.uuid = list(goal_id)
        number: int = self._handle.send_result_request(request)
        return number

    def cancel(self, goal_id: bytes) -> int:
        """Ask for a goal to be cancelled; return the number of the request."""
        request = self.type.Impl.CancelGoalService.Request()
        request.goal_info.goal_id.uuid = list(goal_id)
        number: int = self._handle.send_cancel_request(request)
        return number

    def take(self) -> GoalAnswers:
        heard = GoalAnswers()
        impl, handle = self.type.Impl, self._handle
        for number, response in _all(handle.take_goal_response, impl.SendGoalService.Response):
            heard.accepted[number] = response.accepted
        for number, response in _all(handle.take_cancel_response, impl.CancelGoalService.Response):
            has_ended = response.return_code == response.ERROR_GOAL_TERMINATED
            heard.cancelled[number] = bool(response.goals_canceling) or has_ended
        heard.results.update(_all(handle.take_result_response, impl.GetResultService.Response))
        while (message := handle.take_feedback(impl.FeedbackMessage)) is not None:
            of_goal = heard.feedback.setdefault(bytes(message.goal_id.uuid), [])
            of_goal.append(message.feedback)
        while (message := handle.take_status(impl.GoalStatusMessage)) is not None:
            heard.status |= {bytes(each.goal_info.goal_id.uuid): each.status for each in message.status_list}
        return heard

    def close(self) -> None:
        self._handle.destroy_when_not_in_use()


def _all(take: Any, kind: type[Any]) -> list[tuple[int, Any]]:  # noqa: ANN401 - a C method
    """Take responses until there are none."""
    taken: list[tuple[int, Any]] = []
    while True:
        number, response = take(kind)
        if response is None:
            return taken
        taken.append((number, response))
