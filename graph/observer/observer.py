"""The observer: one ROS node on a thread of its own, in the screen's process.

It polls the graph and its queues a few times a second and hands over plain data. Messages do not
wake it, and no method of the observer waits for anything.
"""

from __future__ import annotations

import atexit
import logging
import threading
import time
from dataclasses import replace
from typing import TYPE_CHECKING

from graph.calls.timeouts import ANSWER_WITHIN_S
from graph.data import GraphUpdate, ParametersResult, SetResult
from graph.observer.inner import InnerStates
from graph.observer.interest import Interest
from graph.observer.node import LOOK_AT_GRAPH_S, ObserverNode
from graph.observer.requests import (
    Begin,
    CallService,
    ObserverError,
    Perform,
    PreparePublisher,
    RequestQueue,
    SendMessage,
)
from graph.ros import open_ros
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from concurrent.futures import Future

    from graph.data import CallResult, Value
    from graph.publishing.dead_man_switch import HeldCommand

logger = logging.getLogger(__name__)

STOP_WITHIN_S = 5.0


class Observer:
    """The ROS graph of one domain as plain data. All methods may be called from any thread."""

    def __init__(
        self,
        domain: int,
        discovery: str | tuple[str, ...] = "localhost",
        period_s: float = 0.1,
        graph_s: float = LOOK_AT_GRAPH_S,
        role: str = "observer",
    ) -> None:
        """Prepare for a domain; `discovery` is localhost, subnet, or the addresses of peers.

        `graph_s`: seconds between two looks at who is there, which cost more than those at messages
        `role`: part of the node's name, see `graph.ros.ONLY_LISTENING`
        """
        self._role = role
        self._domain = domain
        self._discovery = discovery
        self._period_s = period_s
        self._graph_s = graph_s
        self._interest = Interest()
        self._lock = threading.Lock()
        self._wake = threading.Event()
        self._requests = RequestQueue(self._wake)
        self.inner = InnerStates(self._requests)
        """Requests about lifecycles and log levels."""
        self._stopping = False
        self._thread: threading.Thread | None = None

    @property
    def period_s(self) -> float:
        """Seconds between two updates."""
        return self._period_s

    @period_s.setter
    def period_s(self, period_s: float) -> None:
        self._period_s = period_s
        self._wake.set()

    def start(self, on_update: Callable[[GraphUpdate], None]) -> None:
        """Start observing; `on_update` is called on the observer's own thread.

        Requests made earlier, or while rclpy is being imported, are served as soon as it is loaded.
        """
        self._thread = threading.Thread(
            target=self._run, args=(on_update,), name="deck-observer", daemon=True
        )
        # DDS threads must end before the interpreter does.
        atexit.register(self.stop)
        self._thread.start()

    def stop(self) -> None:
        """Leave the graph; what is under way fails. Always returns within a few seconds."""
        self._stopping = True
        self._wake.set()
        atexit.unregister(self.stop)
        if self._thread is None:
            self._requests.refuse(ObserverError(say("the observer was never started")))
        elif self._thread is not threading.current_thread():
            self._thread.join(STOP_WITHIN_S)

    def watch(self, topics: Iterable[str]) -> None:
        """Hand over the newest message of exactly these topics in each update."""
        self._look_at(watched=frozenset(topics))

    def follow(self, topics: Iterable[str]) -> None:
        """Hand over every message of exactly these topics, up to 200 of each in one update."""
        self._look_at(followed=frozenset(topics))

    def measure(self, all_topics: bool) -> None:
        """Measure the rates of all topics, or only of those watched and followed."""
        self._look_at(all_topics=all_topics)

    def watch_goals(self, actions: Iterable[str]) -> None:
        """Report in each update the goals that others have sent to exactly these actions."""
        self._look_at(actions=frozenset(actions))

    def watch_inner_states(self, wanted: bool) -> None:
        """Ask nodes for their lifecycle and containers for their components, or stop asking."""
        self._look_at(inner_states=wanted)

    def watch_frames(self, wanted: bool) -> None:
        """Report in each update the frames that are published on /tf and /tf_static, or none."""
        self._look_at(frames=wanted)

    def prepare_publisher(
        self, topic: str, type_name: str, *, latched: bool = False
    ) -> Future[None]:
        """Create a publisher now, so that its first message goes out at once."""
        request = PreparePublisher(topic, type_name, latched)
        self._requests.put(request)
        return request.future

    def publish(
        self, topic: str, type_name: str, value: Mapping[str, Value], *, latched: bool = False
    ) -> Future[int]:
        """Publish one message; the future returns how many subscribers it went to.

        A new publisher waits up to a second for its subscribers, or up to four seconds just after
        the start. A latched message goes out at once and stays for late subscribers; only the
        count waits. The future raises PublishError, UnknownTypeError, FieldError or
        ObserverError.
        """
        request = SendMessage(topic, type_name, value, latched)
        if latched:
            # An emergency stop is one of these.
            self._requests.hurry(request, lambda node: node.outbox.knows_latched(topic, type_name))
        else:
            self._requests.put(request)
        return request.future

    def take_back(self, topic: str, type_name: str) -> None:
        """Let a latched message, once published, reach no later subscriber."""

        def renew(node: ObserverNode) -> None:
            node.outbox.renew_latched(topic, type_name, node.ends(topic))

        self._requests.put(Perform(renew))

    def call(
        self,
        service: str,
        type_name: str,
        request: Mapping[str, Value],
        timeout_s: float = ANSWER_WITHIN_S,
    ) -> Future[CallResult]:
        """Call a service; the result holds the answer or the failure, the future never raises."""
        asked = CallService(service, type_name, request, timeout_s)
        self._requests.put(asked)
        return asked.future

    def start_publishing(
        self, topic: str, type_name: str, value: Mapping[str, Value], hz: float
    ) -> Future[int]:
        """Publish a message at 0.1 to 100 Hz until this, or the observer, is stopped.

        The future returns its number; it raises PublishError, UnknownTypeError, FieldError or
        ObserverError.
        """
        request = Begin[int](
            lambda node, future: node.publications.start(
                topic, type_name, value, hz, node.ends(topic), future
            )
        )
        self._requests.put(request)
        return request.future

    def stop_publishing(self, number: int) -> None:
        """Stop this publication; updates no longer report it."""
        self._requests.put(Perform(lambda node: node.publications.stop(number)))

    def stop_publishing_all(self) -> None:
        """Stop all periodic publications, even those asked for a moment ago."""
        self._now_and_in_turn(Perform(lambda node: node.publications.close()))

    def stop_commanding(self) -> None:
        """Release what is held, stop all periodic publications and cancel all goals."""
        self._now_and_in_turn(Perform(lambda node: node.stop_commanding()))

    def _now_and_in_turn(self, request: Perform) -> None:
        self._requests.hurry(request)
        # What was asked for but has not begun begins before the request's turn.
        self._requests.put(request)

    def prepare_hold(self, topic: str, type_name: str) -> Future[None]:
        """Create a publisher for `hold`, and publish nothing.

        The future raises PublishError, UnknownTypeError or ObserverError.
        """

        def prepare(node: ObserverNode, future: Future[None]) -> None:
            node.dead_man_switch.prepare(topic, type_name, node.ends(topic))
            future.set_result(None)

        request = Begin[None](prepare)
        self._requests.put(request)
        return request.future

    def hold(self, topic: str, type_name: str, command: HeldCommand) -> Future[int]:
        """Publish a message repeatedly until `command.until_s`, unless called again before that.

        Then `command.rest` is published, and nothing more. The future returns how many subscribers
        are matched now; it raises PublishError, UnknownTypeError, FieldError or ObserverError.
        """

        def hold(node: ObserverNode, future: Future[int]) -> None:
            if not node.dead_man_switch.knows(topic):
                node.dead_man_switch.prepare(topic, type_name, node.ends(topic))
            future.set_result(node.dead_man_switch.hold(topic, command))

        request = Begin[int](hold)
        self._requests.hurry(request, lambda node: node.dead_man_switch.knows(topic))
        return request.future

    def let_go(self, topic: str) -> None:
        """Publish the rest message of a held topic at once."""
        self._requests.hurry(Perform(lambda node: node.dead_man_switch.let_go(topic)))

    def send_goal(self, action: str, type_name: str, goal: Mapping[str, Value]) -> Future[int]:
        """Send a goal; the future returns its number, and updates report its progress.

        It raises GoalError, UnknownTypeError, FieldError or ObserverError.
        """
        request = Begin[int](
            lambda node, future: node.goals.send(
                action, type_name, goal, node.action(action), future
            )
        )
        self._requests.put(request)
        return request.future

    def cancel_goal(self, number: int) -> None:
        """Ask for a goal to be cancelled; updates report whether its server agrees."""
        self._requests.put(Perform(lambda node: node.goals.cancel(number)))

    def cancel_seen_goal(self, action: str, goal_id: str) -> None:
        """Ask for another client's goal to be cancelled; updates report the outcome."""
        self._requests.put(Perform(lambda node: node.seen_goals.cancel(action, goal_id)))

    def forget_goal(self, number: int) -> None:
        """Stop reporting a goal; one that has not ended is cancelled."""
        self._requests.put(Perform(lambda node: node.goals.forget(number)))

    def parameters(self, node: str, timeout_s: float = ANSWER_WITHIN_S) -> Future[ParametersResult]:
        """Read all parameters of a node, with descriptors; `timeout_s` is for each answer.

        The result holds them or why there are none, the future never raises.
        """
        asked_s = time.monotonic()
        request = Begin[ParametersResult](
            lambda own, future: own.parameters.read(node, timeout_s, asked_s, future),
            lambda error: ParametersResult(node, (), reason_of(error), time.monotonic() - asked_s),
        )
        self._requests.put(request)
        return request.future

    def set_parameters(
        self, node: str, values: Mapping[str, Value], timeout_s: float = ANSWER_WITHIN_S
    ) -> Future[SetResult]:
        """Set parameters, keeping their types, each independently.

        The result lists those that were refused, and why; the future never raises.
        """
        asked_s = time.monotonic()
        request = Begin[SetResult](
            lambda own, future: own.parameters.write(node, values, timeout_s, asked_s, future),
            lambda error: SetResult(node, {}, reason_of(error), time.monotonic() - asked_s),
        )
        self._requests.put(request)
        return request.future

    def _look_at(self, **changes: frozenset[str] | bool) -> None:
        with self._lock:
            wanted = replace(self._interest, **changes)  # type: ignore[arg-type]
            if wanted == self._interest:
                return
            self._interest = wanted
        self._wake.set()

    def _run(self, on_update: Callable[[GraphUpdate], None]) -> None:
        end = ObserverError(say("the observer has been stopped"))
        try:
            # This imports rclpy; the screen need not wait for it.
            node = ObserverNode(open_ros(self._domain, self._discovery, self._role), self._graph_s)
            node.serve_urgent = lambda: self._serve_urgent(node)
        except Exception as error:  # noqa: BLE001 - reported to the screen
            words = say("ROS cannot be used: {error}", error=str(error))
            end = ObserverError(words)
            self._tell(on_update, GraphUpdate(time.time(), error=words))
        else:
            try:
                self._observe(node, on_update)
            finally:
                node.close(end)
        finally:
            self._requests.refuse(end)

    def _observe(self, node: ObserverNode, on_update: Callable[[GraphUpdate], None]) -> None:
        next_look_s = 0.0
        interest = self._interest
        while not self._stopping:
            self._requests.carry_out(node)
            try:
                due_s = node.step()
                now_s = time.monotonic()
                if now_s >= next_look_s or self._interest is not interest:
                    interest = self._interest
                    period_s = self._graph_s if node.is_idle else self._period_s
                    # At a steady pace; an extra look out of turn does not delay the next.
                    next_look_s = max(now_s, min(next_look_s, now_s) + period_s)
                    self._look(node, interest, on_update)
            except Exception as error:
                # The graph changes while it is being scanned: the next look has another chance.
                logger.exception("a look at the graph failed")
                error_update = GraphUpdate(
                    time.time(), error=say("the ROS graph: {error}", error=str(error))
                )
                self._tell(on_update, error_update)
                next_look_s, due_s = time.monotonic() + LOOK_AT_GRAPH_S, None
            until_s = next_look_s if due_s is None else min(next_look_s, due_s)
            if self._wake.wait(max(0.0, until_s - time.monotonic())):
                self._wake.clear()

    def _serve_urgent(self, node: ObserverNode) -> None:
        """Serve what cannot wait for the end of a look: stops, and held topics."""
        self._requests.carry_out_urgent(node)
        node.dead_man_switch.step()

    def _look(
        self, node: ObserverNode, interest: Interest, on_update: Callable[[GraphUpdate], None]
    ) -> None:
        update = node.look(interest)
        if update is not None:
            self._tell(on_update, update)

    def _tell(self, on_update: Callable[[GraphUpdate], None], update: GraphUpdate) -> None:
        try:
            on_update(update)
        except Exception:
            # The screen is being closed; the observer is stopped next.
            logger.exception("an update was not taken")
