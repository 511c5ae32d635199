"""The emergency stop as a node obeys it: latched until it is released by an explicit false.

A stop takes effect first; then it is published on /emergency_stop_state, and then saved to disk,
from where the node restores it at its next start.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.event_handler import PublisherEventCallbacks
from std_msgs.msg import Bool

from nodes.parts.qos import DEPTH, LATCHED
from nodes.parts.stop_memory import KeptStop, StopMemory
from robot.topics import EMERGENCY_STATE, EMERGENCY_STOP
from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.topic_endpoint_info import TopicEndpointInfo

    from nodes.parts.node import LessonNode

TOPIC, PICO = "topic", "pico"
"""What engaged it."""
_TOLD_EVERY_S = 1.0
_UNKNOWN = "_UNKNOWN_"
"""In the names of a node whose endpoint is known but whose name is not yet (rmw)."""

_REMEMBERED = N_(
    "EMERGENCY STOP, given before this node was started ({at}): nothing moves until it is released"
)
_UNREADABLE = N_(
    "It is not known whether an emergency stop was given before ({problem}):"
    " nothing moves until one is released"
)
_NOT_KEPT = N_(
    "The emergency stop holds, but cannot be written to disk ({problem}): it would not outlive"
    " this node"
)
_NOT_FORGOTTEN = N_(
    "The emergency stop is released, but stays on disk ({problem}): the next start will be stopped"
)
_HELD = N_("emergency stop until it is released")
_FREE = N_("no emergency stop")


class EmergencyStopListener:
    """Subscribes to /emergency_stop, and remembers its state.

    There are two subscriptions: the latched one receives a stop from before this node, but ROS does
    not match it with a volatile publisher such as `ros2 topic pub`, which must stop the robot too.
    Messages from before this node can only stop: with two publishers, one may have released a stop
    long before the other sent the current one, and their messages arrive in any order.
    """

    def __init__(self, node: LessonNode, changed: Callable[[bool], None]) -> None:
        """Start with the saved stop, for which `changed` is not called."""
        self._node, self._changed = node, changed
        name = node.get_fully_qualified_name()
        self._memory = StopMemory(node.context.get_domain_id(), name)
        self._status = DiagnosticStatus(name=name)
        quiet = PublisherEventCallbacks(use_default_callbacks=False)
        self._publisher = node.create_publisher(
            DiagnosticArray, EMERGENCY_STATE, LATCHED, event_callbacks=quiet
        )
        self._released_s = 0.0
        self._suspects: set[bytes] = set()
        """Publishers of the topic at the time of the stop whose names are not known yet."""
        self._stop = self._memory.recall()
        if self._stop is not None:
            self._tell_remembered(self._stop)
        self._publish()
        node.create_subscription(Bool, EMERGENCY_STOP, self._hear_old, LATCHED)
        node.create_subscription(Bool, EMERGENCY_STOP, self._hear, DEPTH)
        node.every(_TOLD_EVERY_S, self._repeat)

    @property
    def active(self) -> bool:
        """Whether nothing may move."""
        return self._stop is not None

    def engage(self, by: str) -> None:
        """Stop until released, whatever the cause; call this on the node's own thread."""
        if self._stop is not None:
            return
        self._stop = KeptStop(time.time(), by)
        self._changed(True)
        if by == TOPIC:
            self._suspects = {bytes(one.endpoint_gid) for one in self._publishers()}
            self._name_suspects(self._stop)
        self._publish()
        self._keep(self._stop)

    def _release(self) -> None:
        stop, self._stop = self._stop, None
        self._suspects = set()
        if stop is not None:
            self._released_s = time.time()
            self._changed(False)
            self._publish()
        # Also the file of another node that could not receive the release any more.
        problem = self._memory.forget()
        if problem:
            self._node.say.error(_NOT_FORGOTTEN, every_s=10.0, problem=problem)

    def _hear_old(self, message: Bool) -> None:
        if message.data:
            self.engage(TOPIC)

    def _hear(self, message: Bool) -> None:
        if message.data:
            self.engage(TOPIC)
        else:
            self._release()

    def _repeat(self) -> None:
        if self._stop is not None and self._suspects:
            self._name_suspects(self._stop)
        self._publish()
        if self._stop is not None and not self._stop.unreadable:
            self._keep(self._stop)

    def _name_suspects(self, stop: KeptStop) -> None:
        """Report who may have sent it; the name of a new publisher is known a little later."""
        names = set(stop.publishers.split())
        unnamed = set()
        for one in self._publishers():
            gid = bytes(one.endpoint_gid)
            if gid in self._suspects and _UNKNOWN in one.node_name:
                unnamed.add(gid)
            elif gid in self._suspects:
                names.add(f"{one.node_namespace.rstrip('/')}/{one.node_name}")
        self._suspects = unnamed
        self._stop = stop._replace(publishers=" ".join(sorted(names)))

    def _publishers(self) -> list[TopicEndpointInfo]:
        return list(self._node.get_publishers_info_by_topic(EMERGENCY_STOP))

    def _keep(self, stop: KeptStop) -> None:
        problem = self._memory.keep(stop)
        if problem:
            self._node.say.error(_NOT_KEPT, every_s=10.0, problem=problem)

    def _tell_remembered(self, stop: KeptStop) -> None:
        if stop.unreadable:
            self._node.say.error(_UNREADABLE, problem=stop.unreadable)
        else:
            at = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(stop.since_s))
            self._node.say.error(_REMEMBERED, at=at)

    def _publish(self) -> None:
        stop, status = self._stop, self._status
        status.level = DiagnosticStatus.OK if stop is None else DiagnosticStatus.ERROR
        status.message = self._node.say.text(_FREE if stop is None else _HELD)
        values = _free(self._released_s) if stop is None else _held(stop)
        status.values = [KeyValue(key=key, value=value) for key, value in values.items()]
        message = DiagnosticArray(status=[status])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)


def _free(since_s: float) -> dict[str, str]:
    return {"engaged": "false", "since": f"{since_s:.3f}"}


def _held(stop: KeptStop) -> dict[str, str]:
    return {
        "engaged": "true",
        "since": f"{stop.since_s:.3f}",
        "by": stop.by,
        "publishers": stop.publishers,
        "remembered": str(stop.remembered).lower(),
    }
