"""The observer: it watches the graph for the screen, by a process of its own.

That process polls the graph and its queues a few times a second and hands over plain data. Messages
do not wake it. No method of the observer waits for anything, whatever the middleware does.
"""

from __future__ import annotations

import atexit
import os
import time
from typing import TYPE_CHECKING

from graph.calls.timeouts import ANSWER_WITHIN_S
from graph.data import CallResult, ParametersResult, SetResult
from graph.observer.client import ObserverClient
from graph.observer.inner import InnerStates
from graph.observer.settings import LOOK_AT_GRAPH_S, ObserverSettings
from text.sentences import reason_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from concurrent.futures import Future

    from graph.data import GraphUpdate, Value
    from graph.publishing.dead_man_switch import HeldCommand


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
        self._client = ObserverClient(ObserverSettings(domain, discovery, graph_s, role, os.getpid()))
        self.inner = InnerStates(self._client)
        """Requests about lifecycles and log levels."""
        self.period_s = period_s

    @property
    def period_s(self) -> float:
        """Seconds between two updates."""
        return self._period_s

    @period_s.setter
    def period_s(self, period_s: float) -> None:
        self._period_s = period_s
        self._client.want("set_period", period_s)

    def start(self, on_update: Callable[[GraphUpdate], None]) -> None:
        """Start observing; `on_update` is called on a thread of the observer.

        Requests made earlier, or while rclpy is being imported, are served as soon as it is loaded.
        """
        # It leaves the graph properly, while there is time for that.
        atexit.register(self.stop)
        self._client.start(on_update)

    def stop(self) -> None:
        """Leave the graph; what is under way fails. Always returns within a few seconds."""
        atexit.unregister(self.stop)
        self._client.stop()

    def watch(self, topics: Iterable[str]) -> None:
        """Hand over the newest message of exactly these topics in each update."""
        self._client.want("watch", frozenset(topics))

    def follow(self, topics: Iterable[str]) -> None:
        """Hand over every message of exactly these topics, up to 200 of each in one update."""
        self._client.want("follow", frozenset(topics))

    def watch_pictures(self, topics: Iterable[str]) -> None:
        """Hand over the newest picture of exactly these topics in each update.

        Where the same pictures are offered compressed they are taken from there: the samples are
        those of the topic asked for, and of another type.
        """
        self._client.want("watch_pictures", frozenset(topics))

    def measure(self, all_topics: bool, *, images: bool = True, fast: bool = True) -> None:
        """Measure the rates of all topics, or only of those watched and followed.

        Without `images`, of none that carries any; never of those of another machine's. Without `fast`, of none
        that costs much to follow, which is for the time while nobody looks: the rate of a fast one is known in a
        moment, that of a slow one is not.
        """
        self._client.want("measure", (all_topics, images, fast))

    def watch_goals(self, actions: Iterable[str]) -> None:
        """Report in each update the goals that others have sent to exactly these actions."""
        self._client.want("watch_goals", frozenset(actions))

    def watch_inner_states(self, wanted: bool) -> None:
        """Ask nodes for their lifecycle and containers for their components, or stop asking."""
        self._client.want("watch_inner_states", wanted)

    def watch_frames(self, wanted: bool) -> None:
        """Report in each update the frames that are published on /tf and /tf_static, or none."""
        self._client.want("watch_frames", wanted)

    def prepare_publisher(self, topic: str, type_name: str, *, latched: bool = False) -> Future[None]:
        """Create a publisher now, so that its first message goes out at once."""
        return self._client.ask("prepare_publisher", topic, type_name, latched)

    def publish(
        self, topic: str, type_name: str, value: Mapping[str, Value], *, latched: bool = False
    ) -> Future[int]:
        """Publish one message; the future returns how many subscribers it went to.

        A new publisher waits up to a second for its subscribers, or up to four seconds just after
        the start. A latched message goes out at once and stays for late subscribers; only the
        count waits. The future raises PublishError, UnknownTypeError, FieldError or
        ObserverError.
        """
        return self._client.ask("publish", topic, type_name, value, latched)

    def take_back(self, topic: str, type_name: str) -> None:
        """Let a latched message, once published, reach no later subscriber."""
        self._client.tell("take_back", topic, type_name)

    def call(
        self, service: str, type_name: str, request: Mapping[str, Value], timeout_s: float = ANSWER_WITHIN_S
    ) -> Future[CallResult]:
        """Call a service; the result holds the answer or the failure, the future never raises."""
        asked_s = time.monotonic()

        def refusal(error: Exception) -> CallResult:
            elapsed_s = time.monotonic() - asked_s
            return CallResult(service, False, None, reason_of(error), elapsed_s)

        return self._client.ask("call", service, type_name, request, timeout_s, refusal=refusal)

    def start_publishing(self, topic: str, type_name: str, value: Mapping[str, Value], hz: float) -> Future[int]:
        """Publish a message at 0.1 to 100 Hz until this, or the observer, is stopped.

        The future returns its number; it raises PublishError, UnknownTypeError, FieldError or
        ObserverError.
        """
        return self._client.ask("start_publishing", topic, type_name, value, hz)

    def stop_publishing(self, number: int) -> None:
        """Stop this publication; updates no longer report it."""
        self._client.tell("stop_publishing", number)

    def stop_publishing_all(self) -> None:
        """Stop all periodic publications, even those asked for a moment ago."""
        self._client.tell("stop_publishing_all")

    def stop_commanding(self) -> None:
        """Release what is held, stop all periodic publications and cancel all goals."""
        self._client.tell("stop_commanding")

    def prepare_hold(self, topic: str, type_name: str) -> Future[None]:
        """Create a publisher for `hold`, and publish nothing.

        The future raises PublishError, UnknownTypeError or ObserverError.
        """
        return self._client.ask("prepare_hold", topic, type_name)

    def hold(self, topic: str, type_name: str, command: HeldCommand) -> Future[int]:
        """Publish a message repeatedly until `command.until_s`, unless called again before that.

        Then `command.rest` is published, and nothing more. The future returns how many subscribers
        are matched now; it raises PublishError, UnknownTypeError, FieldError or ObserverError.
        """
        return self._client.ask("hold", topic, type_name, command)

    def let_go(self, topic: str) -> None:
        """Publish the rest message of a held topic at once."""
        self._client.tell("let_go", topic)

    def send_goal(self, action: str, type_name: str, goal: Mapping[str, Value]) -> Future[int]:
        """Send a goal; the future returns its number, and updates report its progress.

        It raises GoalError, UnknownTypeError, FieldError or ObserverError.
        """
        return self._client.ask("send_goal", action, type_name, goal)

    def cancel_goal(self, number: int) -> None:
        """Ask for a goal to be cancelled; updates report whether its server agrees."""
        self._client.tell("cancel_goal", number)

    def cancel_seen_goal(self, action: str, goal_id: str) -> None:
        """Ask for another client's goal to be cancelled; updates report the outcome."""
        self._client.tell("cancel_seen_goal", action, goal_id)

    def forget_goal(self, number: int) -> None:
        """Stop reporting a goal; one that has not ended is cancelled."""
        self._client.tell("forget_goal", number)

    def parameters(self, node: str, timeout_s: float = ANSWER_WITHIN_S) -> Future[ParametersResult]:
        """Read all parameters of a node, with descriptors; `timeout_s` is for each answer.

        The result holds them or why there are none, the future never raises.
        """
        asked_s = time.monotonic()

        def refusal(error: Exception) -> ParametersResult:
            return ParametersResult(node, (), reason_of(error), time.monotonic() - asked_s)

        return self._client.ask("parameters", node, timeout_s, refusal=refusal)

    def set_parameters(
        self, node: str, values: Mapping[str, Value], timeout_s: float = ANSWER_WITHIN_S
    ) -> Future[SetResult]:
        """Set parameters, keeping their types, each independently.

        The result lists those that were refused, and why; the future never raises.
        """
        asked_s = time.monotonic()

        def refusal(error: Exception) -> SetResult:
            return SetResult(node, {}, reason_of(error), time.monotonic() - asked_s)

        return self._client.ask("set_parameters", node, values, timeout_s, refusal=refusal)
