"""What a told node can be ordered about actions: each of its goals waits for the test's word."""

from __future__ import annotations

from typing import Any

from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.node import Node

from graph.messages.making import to_message
from graph.messages.types import load_action

DRIVE = "deck_interfaces/action/DriveToPoint"


class Served:
    """One action server, its goals in the order in which they were accepted."""

    def __init__(self, node: Node, name: str, reject: bool, refuse_cancel: bool) -> None:
        self.handles: list[Any] = []
        self.cancels = 0
        self.rejects = reject
        self.refuses_cancel = refuse_cancel
        self.kind = load_action(DRIVE)
        self.server = ActionServer(
            node,
            self.kind,
            name,
            lambda _: None,
            goal_callback=self._asked,
            handle_accepted_callback=self._accepted,
            cancel_callback=self._asked_to_cancel,
        )

    def _asked(self, _goal: Any) -> GoalResponse:
        return GoalResponse.REJECT if self.rejects else GoalResponse.ACCEPT

    def _asked_to_cancel(self, _handle: Any) -> CancelResponse:
        self.cancels += 1
        return CancelResponse.REJECT if self.refuses_cancel else CancelResponse.ACCEPT

    def _accepted(self, handle: Any) -> None:
        """Have it executed by nobody: a coroutine for each goal would starve the executor."""
        handle._update_state(_rclpy.GoalEvent.EXECUTE)
        self.handles.append(handle)

    def end(self, goal: int, how: str, result: Any) -> None:
        handle = self.handles[goal]
        getattr(handle, how)()
        self.server.notify_execute(handle, lambda _: result)


class Asked:
    """The client of one action: what it was told of its goals, in the order of their sending."""

    def __init__(self, node: Node, name: str) -> None:
        self.client = ActionClient(node, load_action(DRIVE), name)
        self.ends: dict[int, int] = {}
        self.sent = 0

    def send(self, x: float) -> None:
        assert self.client.wait_for_server(20)
        number, self.sent = self.sent, self.sent + 1
        sent = self.client.send_goal_async(load_action(DRIVE).Goal(x=x))
        sent.add_done_callback(lambda future: self._answered(number, future.result()))

    def _answered(self, number: int, handle: Any) -> None:
        result = handle.get_result_async()
        result.add_done_callback(lambda f: self.ends.__setitem__(number, f.result().status))


class ActionOrders:
    """What a test can order about actions; the type is DriveToPoint."""

    node: Node

    def __init__(self) -> None:
        self.served_actions: dict[str, Served] = {}
        self.asked_actions: dict[str, Asked] = {}

    def serve_action(self, topic: str, reject: bool = False, refuse_cancel: bool = False) -> None:
        self.served_actions[topic] = Served(self.node, topic, reject, refuse_cancel)

    def goals(self, topic: str) -> list[list[float]]:
        """The goals that are at work or have ended, as x and y."""
        return [[h.request.x, h.request.y] for h in self.served_actions[topic].handles]

    def cancels(self, topic: str) -> int:
        return self.served_actions[topic].cancels

    def feedback(self, topic: str, goal: int, distance: float) -> None:
        served = self.served_actions[topic]
        served.handles[goal].publish_feedback(served.kind.Feedback(distance=distance))

    def finish(self, topic: str, goal: int, how: str, **result: Any) -> None:
        """End a goal: `succeed`, `abort` or `canceled`, with these fields in its result."""
        served = self.served_actions[topic]
        served.end(goal, how, to_message(served.kind.Result, result))

    def send_drive(self, topic: str, x: float) -> None:
        if topic not in self.asked_actions:
            self.asked_actions[topic] = Asked(self.node, topic)
        self.asked_actions[topic].send(x)

    def ends(self, topic: str) -> dict[int, int]:
        """The numbers of action_msgs/GoalStatus by which the goals that were sent have ended."""
        return self.asked_actions[topic].ends
