"""A ROS node in a process of its own that does what a test tells it: an order a line on stdin.

Each order, a JSON object, is answered by a JSON line on stdout; what a subscription or a service
receives comes as lines too, with the key `heard` or `served`. `Orders` has what can be ordered.
"""

from __future__ import annotations

import contextlib
import json
import queue
import sys
import threading
import time
from typing import Any

import rclpy
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import serialize_message

from graph.messages.making import to_message
from graph.messages.types import load_message, load_service
from tests.ros.told_actions import ActionOrders

IDLE_S = 0.02


def tell(**words: object) -> None:
    sys.stdout.write(json.dumps(words) + "\n")
    sys.stdout.flush()


def qos(
    reliability: str = "reliable",
    durability: str = "volatile",
    depth: int = 10,
    liveliness: str = "automatic",
    **seconds: float,
) -> QoSProfile:
    """A profile; `seconds` are deadline, lifespan and liveliness_lease_duration."""
    return QoSProfile(
        depth=depth,
        reliability=ReliabilityPolicy[reliability.upper()],
        durability=DurabilityPolicy[durability.upper()],
        liveliness=LivelinessPolicy[liveliness.upper()],
        **{name: Duration(seconds=duration) for name, duration in seconds.items()},
    )


class Timed:
    """A publisher at a fixed rate; late ones are caught up, so that the mean rate is exact."""

    def __init__(self, publish: Any, hz: float) -> None:
        self.publish = publish
        self.period_s = 1.0 / hz
        self.next_s = time.monotonic()

    def step(self, now_s: float) -> None:
        while self.next_s <= now_s:
            self.publish()
            self.next_s += self.period_s


class Orders(ActionOrders):
    """What a test can order."""

    def __init__(self, node: Node) -> None:
        super().__init__()
        self.node = node
        self.publishers: dict[str, Any] = {}
        self.subscriptions: dict[str, Any] = {}
        self.services: dict[str, Any] = {}
        self.clients: dict[str, Any] = {}
        self.timed: dict[str, Timed] = {}

    def advertise(self, topic: str, type_name: str, **policies: Any) -> None:
        self.publishers[topic] = self.node.create_publisher(load_message(type_name), topic, qos(**policies))

    def publish(self, topic: str, value: dict[str, Any], times: int = 1) -> None:
        """Publish so many times; the value "NUMBER" stands for the number of the message."""
        publisher = self.publishers[topic]
        for number in range(times):
            numbered = {k: number if v == "NUMBER" else v for k, v in value.items()}
            publisher.publish(to_message(publisher.msg_type, numbered))

    def repeat(self, topic: str, value: dict[str, Any], hz: float, pad: int = 0) -> None:
        """Publish at this rate; `pad` is a number of bytes for the field `data`."""
        publisher = self.publishers[topic]
        value = {**value, "data": bytes(pad)} if pad else value
        raw = serialize_message(to_message(publisher.msg_type, value))
        self.timed[topic] = Timed(lambda: publisher.publish(raw), hz)

    def silence(self, topic: str) -> None:
        self.timed.pop(topic, None)

    def withdraw(self, topic: str) -> None:
        self.silence(topic)
        self.node.destroy_publisher(self.publishers.pop(topic))

    def listeners(self, topic: str) -> int:
        return int(self.publishers[topic].get_subscription_count())

    def listen(self, topic: str, type_name: str, **policies: Any) -> None:
        def take(message: Any) -> None:
            tell(heard=topic, value=str(message.data))

        self.subscriptions[topic] = self.node.create_subscription(
            load_message(type_name), topic, take, qos(**policies)
        )

    def serve(self, topic: str, after_s: float = 0.0) -> None:
        """Serve AddTwoInts under this name, each answer `after_s` late."""

        def answer(request: Any, response: Any) -> Any:
            time.sleep(after_s)
            response.sum = request.a + request.b
            tell(served=topic)
            return response

        self.services[topic] = self.node.create_service(
            load_service("example_interfaces/srv/AddTwoInts"), topic, answer
        )

    def use(self, topic: str) -> None:
        """Have a client of AddTwoInts under this name."""
        add_two_ints = load_service("example_interfaces/srv/AddTwoInts")
        self.clients[topic] = self.node.create_client(add_two_ints, topic)

    def stop_using(self, topic: str) -> None:
        self.node.destroy_client(self.clients.pop(topic))

    def names(self) -> list[str]:
        return [f"{ns.rstrip('/')}/{name}" for name, ns in self.node.get_node_names_and_namespaces()]


def obey(orders: Orders, lines: queue.SimpleQueue[str]) -> bool:
    """Do what has been ordered; false at the end of the test."""
    while not lines.empty():
        line = lines.get()
        if not line:
            return False
        order = json.loads(line)
        tell(done=getattr(orders, order.pop("order"))(**order))
    return True


def main() -> None:
    rclpy.init()
    node = Node(sys.argv[1], start_parameter_services="--parameters" in sys.argv)
    orders = Orders(node)
    lines: queue.SimpleQueue[str] = queue.SimpleQueue()

    def read() -> None:
        for line in sys.stdin:
            lines.put(line)
        # The test has ended, perhaps by being killed.
        lines.put("")

    threading.Thread(target=read, daemon=True).start()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    tell(done="ready")
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        while obey(orders, lines):
            now_s = time.monotonic()
            for timed in orders.timed.values():
                timed.step(now_s)
            due_s = min((t.next_s for t in orders.timed.values()), default=now_s + IDLE_S)
            executor.spin_once(timeout_sec=max(0.0, min(IDLE_S, due_s - time.monotonic())))
    # A node that goes without a word is missed only after its lease of 20 s.
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
