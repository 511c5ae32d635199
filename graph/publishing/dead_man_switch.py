"""A dead-man's switch: messages that are repeated only while somebody holds a key.

Each command carries the moment until which it is valid. When that moment passes without another
command, the rest message goes out a few times, and then nothing. The observer's thread watches the
time, as whoever holds the key may hang or vanish.
"""

from __future__ import annotations

import contextlib
import logging
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from graph.messages.making import to_message
from graph.messages.types import load_message
from graph.publishing.outbox import PublishError, open_publisher, refuse_other_type
from graph.qos import Qos, to_be_heard

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.node import Node
    from rclpy.publisher import Publisher

    from graph.data import Value
    from graph.scan import TopicEnds

logger = logging.getLogger(__name__)

RESTS = 3
"""How often the rest message goes out: a subscriber may be best effort."""
DEPTH = 1
"""Lifespan: no message may arrive after a newer one was made, however slow the network."""
LONGEST_S = 2.0
"""No command is valid for longer than this, whatever it says."""


class HeldCommand(NamedTuple):
    """The newest command of whoever holds the key."""

    value: Mapping[str, Value]
    """Published repeatedly while the command is valid."""
    rest: Mapping[str, Value]
    """Published when the command has expired."""
    hz: float
    until_s: float
    """On the monotonic clock."""


class CommandRepeater:
    """Decides what to send on one topic, and when. `send` publishes, and may raise anything."""

    def __init__(self, send: Callable[[Mapping[str, Value]], object]) -> None:
        self._send = send
        self._command: HeldCommand | None = None
        self._rest: Mapping[str, Value] = {}
        self._rests = 0
        self._period_s = 0.0
        self._due_s = 0.0

    @property
    def is_held(self) -> bool:
        """Whether anything but the rest message goes out."""
        return self._command is not None

    def hold(self, command: HeldCommand, now_s: float) -> None:
        """Continue with this command; an expired one changes nothing."""
        until_s = min(command.until_s, now_s + LONGEST_S)
        if until_s <= now_s:
            return
        if self._command is None or self._command.value != command.value:
            self._due_s = now_s
        self._command, self._rests = command._replace(until_s=until_s), 0
        self._rest, self._period_s = command.rest, 1.0 / command.hz
        self.step(now_s)

    def let_go(self, now_s: float) -> None:
        """Send the rest message from now on."""
        if self._command is not None:
            self._command = self._command._replace(until_s=now_s)
            self.step(now_s)

    def step(self, now_s: float) -> float | None:
        """Publish what is due; return when to call again, None if nothing is left."""
        command = self._command
        if command is not None and now_s >= command.until_s:
            self._command, self._rests, self._due_s = None, RESTS, now_s
        if self._command is None and not self._rests:
            return None
        if now_s >= self._due_s:
            self._due_s += self._period_s
            if self._due_s <= now_s:
                # Missed messages are not made up for.
                self._due_s = now_s + self._period_s
            self._publish()
        if self._command is not None:
            return min(self._due_s, self._command.until_s)
        return self._due_s if self._rests else None

    def _publish(self) -> None:
        value = self._rest if self._command is None else self._command.value
        self._rests -= 1 if self._command is None else 0
        try:
            self._send(value)
        except Exception:
            # A message that cannot be published is not retried.
            self._command, self._rests = None, 0
            raise


@dataclass
class _HeldTopic:
    """One topic with its publisher."""

    publisher: Publisher
    type_name: str
    cls: type[Any]
    qos: Qos
    repeater: CommandRepeater


class DeadManSwitch:
    """Every held message; each topic has a publisher, created on first use and kept."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._lines: dict[str, _HeldTopic] = {}

    def knows(self, topic: str) -> bool:
        return topic in self._lines

    def prepare(self, topic: str, type_name: str, ends: TopicEnds | None) -> None:
        """Create the publisher, and publish nothing. Raises PublishError or UnknownTypeError."""
        if topic in self._lines:
            return
        refuse_other_type(topic, type_name, ends)
        cls = load_message(type_name)
        qos = to_be_heard(ends.subscribers if ends else ())
        publisher = open_publisher(self._node, topic, cls, qos, DEPTH)
        repeater = CommandRepeater(lambda value: self._send(topic, value))
        self._lines[topic] = _HeldTopic(publisher, type_name, cls, qos, repeater)

    def hold(self, topic: str, command: HeldCommand) -> int:
        """Publish until the command expires; return how many subscribers are matched now.

        The topic must have been prepared. Raises PublishError, UnknownTypeError or FieldError.
        """
        line = self._lines[topic]
        line.repeater.hold(command, time.monotonic())
        return line.publisher.get_subscription_count()

    def let_go(self, topic: str) -> None:
        """Send the rest message at once."""
        if topic in self._lines:
            self._lines[topic].repeater.let_go(time.monotonic())

    def tune(self, topics: Mapping[str, TopicEnds]) -> None:
        """Adapt the offered QoS to new subscribers; never while a topic is held."""
        for topic, line in self._lines.items():
            ends = topics.get(topic)
            qos = to_be_heard(ends.subscribers if ends else ())
            if qos == line.qos or line.repeater.is_held:
                continue
            with contextlib.suppress(PublishError):
                publisher = open_publisher(self._node, topic, line.cls, qos, DEPTH)
                self._node.destroy_publisher(line.publisher)
                line.publisher, line.qos = publisher, qos

    def step(self) -> float | None:
        """Publish what is due; return when the next is, on the monotonic clock."""
        dues_s = [self._step(line) for line in self._lines.values()]
        return min((due_s for due_s in dues_s if due_s is not None), default=None)

    def _step(self, line: _HeldTopic) -> float | None:
        try:
            return line.repeater.step(time.monotonic())
        except Exception:
            # It is no longer held; the next `hold` reports the error to its caller.
            logger.exception("what is held cannot be published")
            return None

    def close(self) -> None:
        """Release everything, with a last rest message."""
        for topic in self._lines:
            with contextlib.suppress(PublishError):
                self.let_go(topic)

    def _send(self, topic: str, value: Mapping[str, Value]) -> None:
        line = self._lines[topic]
        message = to_message(line.cls, value)
        if hasattr(message, "header"):
            message.header.stamp = self._node.get_clock().now().to_msg()
        try:
            line.publisher.publish(message)
        except Exception as error:
            raise PublishError(f"{topic}: {error}") from error
