"""What the observer can be asked for, as requests to its loop. `Observer` says what each means."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from graph.data import ParametersResult, SetResult
from graph.inner_states import LevelResult, TransitionResult
from graph.observer.requests import Begin, CallService, Perform, PreparePublisher, SendMessage
from text.sentences import reason_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from concurrent.futures import Future

    from graph.data import CallResult, Value
    from graph.observer.node import ObserverNode
    from graph.observer.requests import RequestQueue
    from graph.publishing.dead_man_switch import HeldCommand


class Orders:
    """Every order, by the name of the method of `Observer`; they may come from any thread."""

    def __init__(self, requests: RequestQueue) -> None:
        """Queue them for the observer's loop."""
        self._requests = requests

    def prepare_publisher(self, topic: str, type_name: str, latched: bool) -> Future[None]:
        request = PreparePublisher(topic, type_name, latched)
        self._requests.put(request)
        return request.future

    def publish(self, topic: str, type_name: str, value: Mapping[str, Value], latched: bool) -> Future[int]:
        request = SendMessage(topic, type_name, value, latched)
        if latched:
            # An emergency stop is one of these.
            self._requests.hurry(request, lambda node: node.outbox.knows_latched(topic, type_name))
        else:
            self._requests.put(request)
        return request.future

    def take_back(self, topic: str, type_name: str) -> None:
        """Let a latched message reach no later subscriber."""

        def renew(node: ObserverNode) -> None:
            node.outbox.renew_latched(topic, type_name, node.ends(topic))

        self._requests.put(Perform(renew))

    def call(
        self, service: str, type_name: str, request: Mapping[str, Value], timeout_s: float
    ) -> Future[CallResult]:
        asked = CallService(service, type_name, request, timeout_s)
        self._requests.put(asked)
        return asked.future

    def start_publishing(self, topic: str, type_name: str, value: Mapping[str, Value], hz: float) -> Future[int]:
        request = Begin[int](
            lambda node, future: node.publications.start(topic, type_name, value, hz, node.ends(topic), future)
        )
        self._requests.put(request)
        return request.future

    def stop_publishing(self, number: int) -> None:
        self._requests.put(Perform(lambda node: node.publications.stop(number)))

    def stop_publishing_all(self) -> None:
        self._now_and_in_turn(Perform(lambda node: node.publications.close()))

    def stop_commanding(self) -> None:
        """Release what is held, stop all periodic publications and cancel all goals."""
        self._now_and_in_turn(Perform(lambda node: node.stop_commanding()))

    def _now_and_in_turn(self, request: Perform) -> None:
        self._requests.hurry(request)
        # What was asked for but has not begun begins before the request's turn.
        self._requests.put(request)

    def prepare_hold(self, topic: str, type_name: str) -> Future[None]:
        """Create a publisher for `hold`."""

        def prepare(node: ObserverNode, future: Future[None]) -> None:
            node.dead_man_switch.prepare(topic, type_name, node.ends(topic))
            future.set_result(None)

        request = Begin[None](prepare)
        self._requests.put(request)
        return request.future

    def hold(self, topic: str, type_name: str, command: HeldCommand) -> Future[int]:
        """Publish repeatedly while it is valid."""

        def hold(node: ObserverNode, future: Future[int]) -> None:
            if not node.dead_man_switch.knows(topic):
                node.dead_man_switch.prepare(topic, type_name, node.ends(topic))
            future.set_result(node.dead_man_switch.hold(topic, command))

        request = Begin[int](hold)
        self._requests.hurry(request, lambda node: node.dead_man_switch.knows(topic))
        return request.future

    def let_go(self, topic: str) -> None:
        """Publish the rest message."""
        self._requests.hurry(Perform(lambda node: node.dead_man_switch.let_go(topic)))

    def send_goal(self, action: str, type_name: str, goal: Mapping[str, Value]) -> Future[int]:
        request = Begin[int](
            lambda node, future: node.goals.send(action, type_name, goal, node.action(action), future)
        )
        self._requests.put(request)
        return request.future

    def cancel_goal(self, number: int) -> None:
        self._requests.put(Perform(lambda node: node.goals.cancel(number)))

    def cancel_seen_goal(self, action: str, goal_id: str) -> None:
        """Ask for another client's goal to be cancelled."""
        self._requests.put(Perform(lambda node: node.seen_goals.cancel(action, goal_id)))

    def cancel_lost_goal(self, action: str, type_name: str, goal_id: str) -> None:
        """Ask for a goal to be cancelled whose sender is gone."""
        self._requests.put(Perform(lambda node: node.seen_goals.cancel_lost(action, type_name, goal_id)))

    def forget_goal(self, number: int) -> None:
        self._requests.put(Perform(lambda node: node.goals.forget(number)))

    def parameters(self, node: str, timeout_s: float) -> Future[ParametersResult]:
        asked_s = time.monotonic()
        request = Begin[ParametersResult](
            lambda own, future: own.parameters.read(node, timeout_s, asked_s, future),
            lambda error: ParametersResult(node, (), reason_of(error), time.monotonic() - asked_s),
        )
        self._requests.put(request)
        return request.future

    def set_parameters(self, node: str, values: Mapping[str, Value], timeout_s: float) -> Future[SetResult]:
        asked_s = time.monotonic()
        request = Begin[SetResult](
            lambda own, future: own.parameters.write(node, values, timeout_s, asked_s, future),
            lambda error: SetResult(node, {}, reason_of(error), time.monotonic() - asked_s),
        )
        self._requests.put(request)
        return request.future

    def change_state(self, node: str, transition: str, timeout_s: float) -> Future[TransitionResult]:
        """Have a node with a lifecycle make a transition."""
        request = Begin[TransitionResult](
            lambda own, future: own.lifecycles.change(node, transition, timeout_s, future),
            lambda error: TransitionResult(node, transition, error=reason_of(error)),
        )
        self._requests.put(request)
        return request.future

    def logger_level(self, node: str, timeout_s: float) -> Future[LevelResult]:
        """Read from which severity on a node logs."""
        request = Begin[LevelResult](
            lambda own, future: own.logger_levels.read(node, timeout_s, future),
            lambda error: LevelResult(node, error=reason_of(error)),
        )
        self._requests.put(request)
        return request.future

    def set_logger_level(self, node: str, level: str, timeout_s: float) -> Future[LevelResult]:
        request = Begin[LevelResult](
            lambda own, future: own.logger_levels.write(node, level, timeout_s, future),
            lambda error: LevelResult(node, error=reason_of(error)),
        )
        self._requests.put(request)
        return request.future
