"""A ROS node of the test's own: it hears, speaks and calls, while the test waits for conditions."""

from __future__ import annotations

import contextlib
import threading
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

import pytest
import rclpy
from rclpy.action import ActionClient
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation as rclpy_c
from rclpy.logging import LoggingSeverity
from rclpy.qos import DurabilityPolicy, QoSProfile

from tests.waiting import DEADLINE_S, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rclpy.publisher import Publisher
    from rclpy.subscription import Subscription
    from rclpy.task import Future
    from typing_extensions import Self

T = TypeVar("T")

ROOT = Path(__file__).parents[2]
ASKED_AGAIN_LOOKS = 300
"""Six seconds, of which those do not count in which the whole machine stood."""
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
DISCOVERY = {
    "ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT",
    "FASTRTPS_DEFAULT_PROFILES_FILE": str(ROOT / "graph" / "fastdds.xml"),
}
"""As Deck's own processes have it: found in tenths of a second, not in three."""


class Peer:
    """A node on its own context and thread; to be closed, or used in a `with`."""

    def __init__(self, domain: int, name: str = "peer") -> None:
        self._context = Context()
        # A fixture that outlives a test does not see that test's environment.
        with pytest.MonkeyPatch.context() as environment:
            for key, value in DISCOVERY.items():
                environment.setenv(key, value)
            rclpy.init(context=self._context, domain_id=domain)
            self.node = rclpy.create_node(name, context=self._context)
        # An observer of Deck's in this process silences all loggers without a level of their own.
        self.node.get_logger().set_level(LoggingSeverity.INFO)
        self._publishers: dict[str, Publisher] = {}
        self._subscriptions: list[Subscription] = []
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._closing = False
        self._thread = threading.Thread(target=self._spin, name="peer", daemon=True)
        self._thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        self._closing = True
        self._executor.create_task(lambda: None)
        self._thread.join()
        self._executor.shutdown()
        # Clients of actions, which would keep its participant in the domain.
        for waitable in list(self.node.waitables):
            if isinstance(waitable, ActionClient):
                waitable.destroy()
        self.node.destroy_node()
        self._context.try_shutdown()

    def hear(self, topic: str, kind: type, qos: QoSProfile | int = 100) -> list[Any]:
        """A list that grows with every message of the topic from now on."""
        heard: list[Any] = []
        self._subscriptions.append(self.node.create_subscription(kind, topic, heard.append, qos))
        return heard

    def publisher(self, topic: str, kind: type, qos: QoSProfile | int = 10) -> Publisher:
        if topic not in self._publishers:
            self._publishers[topic] = self.node.create_publisher(kind, topic, qos)
        return self._publishers[topic]

    def retire(self, topic: str) -> None:
        """Publish that topic no more, so that nobody counts on this node for it."""
        publisher = self._publishers.pop(topic, None)
        if publisher is not None:
            self.node.destroy_publisher(publisher)

    def say(self, topic: str, message: Any, *, listeners: int = 1, qos: QoSProfile | int = 10) -> None:
        """Publish, once so many subscriptions are matched that the message cannot get lost."""
        publisher = self.publisher(topic, type(message), qos)
        wait_until(lambda: publisher.get_subscription_count() >= listeners, f"{listeners} subscribers of {topic}")
        publisher.publish(message)

    @contextlib.contextmanager
    def saying(self, topic: str, message: Any, every_s: float = 0.05) -> Iterator[None]:
        """Publish it again and again within the `with`, as who measures something does."""
        publisher = self.publisher(topic, type(message))
        timer = self.node.create_timer(every_s, lambda: publisher.publish(message))
        try:
            yield
        finally:
            self.node.destroy_timer(timer)

    def ask(self, service: str, kind: Any, request: Any, within_s: float = DEADLINE_S) -> Any:
        client = self.node.create_client(kind, service)
        try:
            wait_until(client.service_is_ready, f"service {service}", within_s)
            return self.insist(lambda: client.call_async(request), f"an answer of {service}", within_s)
        finally:
            self.node.destroy_client(client)

    def insist(self, ask: Callable[[], Future], what: str, within_s: float = DEADLINE_S) -> Any:
        """Ask, anew after a while, and return the first answer.

        An answer is lost for good if the server's middleware has not found within 100 ms who
        asked, which happens in the first moments of a node ("client will not receive response").
        """
        asked: list[Future] = []
        looks = count()

        def answered() -> Future | None:
            if next(looks) % ASKED_AGAIN_LOOKS == 0:
                asked.append(ask())
            return next((future for future in asked if future.done()), None)

        return wait_until(answered, what, within_s).result()

    def on_its_thread(self, call: Callable[[], T], what: str) -> T:
        """Call on the thread that spins, and return what comes back.

        For an ActionClient: it keeps no lock between sending a request and remembering it, so that
        an answer that is quick is dropped if another thread takes it in (rclpy issue 1123).
        """
        return cast("T", self.answer(self._executor.create_task(call), what))

    def answer(self, future: Future, what: str, within_s: float = DEADLINE_S) -> Any:
        wait_until(future.done, what, within_s)
        return future.result()

    def sees(self, node: str) -> bool:
        """Whether a node of that name is in the graph."""
        return node in self.node.get_node_names()

    def _spin(self) -> None:
        # Not until its context is shut down: that fails now and then in the middle of a callback.
        with contextlib.suppress(ExternalShutdownException):
            while not self._closing:
                # A test may destroy a publisher in the moment in which its events are asked for.
                with contextlib.suppress(rclpy_c.InvalidHandle):
                    self._executor.spin_once()
