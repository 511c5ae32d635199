"""The node of one command: joins the domain of the environment, and waits until it sees the others.

There is no daemon that knows the graph already. A command waits until nothing new has been found for a while, or, if
it needs one thing, until that is found.
"""

from __future__ import annotations

import os
import socket
import time
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

from graph.messages.fields import to_tree
from graph.messages.making import to_message
from graph.messages.types import load_service
from graph.ros import FAST_DDS, FAST_DDS_VARIABLES, LOCALHOST_ONLY, PEERS, RANGE, announcing
from graph.scan import signature
from ros2.ending import was_interrupted
from ros2.verb import ANSWERED_WITHIN_S

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Iterator

    from rclpy.executors import SingleThreadedExecutor
    from rclpy.node import Node
    from rclpy.task import Future

    from graph.calls.exchanges import Exchange, ServiceSet

QUIET_S = 0.5
"""Without news for so long, all who are there are taken to be found."""
NEAR_S, NETWORK_S = 1.0, 3.3
"""So long at least is waited for others of this machine, and of a network, where each announces itself every 3 s."""
LONGEST_S = 10.0
"""A graph that never comes to rest is taken as it is."""
APPEARS_S = 3.0
"""So long at least is waited for one thing, as for a node that was just started."""
READY_S = 10.0
"""So long may a service of a node that is there take to be found."""
LOOK_S = 0.05
GONE_S = 1.0
"""A server that is not seen for so long has gone."""
SPIN_S = 0.1
"""How late Ctrl-C may be noticed: the middleware does not wake up for signals."""


class NoAnswerError(RuntimeError):
    """A node is there and does not answer, or has gone before it did."""


class Guest:
    """A node in the graph, with what drives it."""

    def __init__(self, node: Node, executor: SingleThreadedExecutor, timeout_s: float | None) -> None:
        """`timeout_s`: how long answers may take, if that was told."""
        self.node = node
        self._timeout_s = timeout_s
        self._executor = executor
        self._since_s = time.monotonic()

    def spin_once(self, timeout_s: float = SPIN_S) -> None:
        """Take in what has come, or wait a moment for it."""
        try:
            self._executor.spin_once(timeout_sec=timeout_s)
        except TypeError as error:
            if was_interrupted(error):
                raise KeyboardInterrupt from error
            raise

    def answer(self, future: Future, owner: str, is_there: Callable[[], bool], within_s: float | None = None) -> Any:  # noqa: ANN401 - generated
        """Wait for the answer of `owner`, as long as the option says unless told otherwise, and return it.

        Raises NoAnswerError if it has not come by then, or `is_there` has said no for a while; RuntimeError for what
        was raised in its place.
        """
        within_s = within_s or self._timeout_s or ANSWERED_WITHIN_S
        begun = there_at = time.monotonic()
        while not future.done():
            self.spin_once()
            now = time.monotonic()
            if is_there():
                there_at = now
            if now - there_at > GONE_S:
                raise NoAnswerError(f"{owner} has gone before it answered")
            if now - begun > within_s:
                raise NoAnswerError(
                    f"{owner} has not answered within {within_s:g} s: it may be stuck in a"
                    " callback, or before it spins, or be killed; --timeout waits longer"
                )
        if future.result() is None:
            raise RuntimeError(f"Exception while calling {owner}: {future.exception()!r}")
        return future.result()

    def call(self, service: str, kind: Any, owner: str, request: object = None, within_s: float | None = None) -> Any:  # noqa: ANN401
        """Call a service of the node `owner` and return the answer; RuntimeError without one."""
        client = self.node.create_client(kind, service)
        try:
            if not client.wait_for_service(timeout_sec=READY_S):
                raise RuntimeError("Wait for service timed out")
            asked = client.call_async(request or kind.Request())
            return self.answer(asked, owner, client.service_is_ready, within_s)
        finally:
            self.node.destroy_client(client)

    def carry_out(self, node: str, exchange: Exchange, services: ServiceSet) -> None:
        """Put an exchange's requests to a node's own services, and hand it the answers; RuntimeError without them."""
        with suppress(StopIteration):
            asked = next(exchange)
            while True:
                kind = load_service(services.types[asked.service])
                request = to_message(kind.Request, asked.value)
                within_s = self._timeout_s or asked.within_s
                answer = self.call(f"{node}/{asked.service}", kind, node, request, within_s)
                asked = exchange.send(to_tree(answer))

    def find(self, name: str, service: str) -> str:
        """Return the full name of a node once it serves this, as the relative name `get_parameters`, empty if not."""
        full = name if name.startswith("/") else f"/{name}"
        there = self.await_until(lambda: f"{full}/{service}" in dict(self.node.get_service_names_and_types()))
        return full if there else ""

    def settle(self, least_s: float = 0.0) -> None:
        """Wait until nothing new is found; `least_s` since the command began at least."""
        self._await(lambda: False, least_s)

    def await_until(self, there: Callable[[], bool]) -> bool:
        """Wait for one thing until it is there, or would be; return whether it is there."""
        return self._await(there, APPEARS_S)

    def _await(self, there: Callable[[], bool], least_s: float) -> bool:
        least_s = max(least_s, NETWORK_S if _is_wide() else NEAR_S)
        begun = news_at = time.monotonic()
        known: object = None
        while not there():
            found, now = signature(self.node), time.monotonic()
            if found != known:
                known, news_at = found, now
            settled = now - news_at >= QUIET_S and now - self._since_s >= least_s
            if settled or now - begun >= LONGEST_S:
                return False
            time.sleep(LOOK_S)
        return True

    def leave(self) -> None:
        self._executor.shutdown()
        self.node.destroy_node()


def _is_wide() -> bool:
    """Return whether participants of other machines can be found, by ROS's variables."""
    near = os.environ.get(LOCALHOST_ONLY) == "1" or os.environ.get(FAST_DDS_VARIABLES[0]) == str(FAST_DDS)
    if near or all(name == "lo" for _, name in socket.if_nameindex()):
        return False
    reach = os.environ.get(RANGE, "").upper()
    return reach != "OFF" and (reach != "LOCALHOST" or bool(os.environ.get(PEERS)))


@contextmanager
def joined(args: argparse.Namespace, *, settled: bool = False) -> Iterator[Guest]:
    """Open the node of a command for the length of a `with`; `settled`: it sees everybody."""
    from rclpy.context import Context
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.node import Node
    from rclpy.parameter import Parameter

    context = Context()
    if os.environ.get(RANGE, "").upper() == "LOCALHOST" and not os.environ.get(PEERS):
        os.environ.update({name: value for name, value in announcing("localhost").items() if value})
    context.init(args=[], initialize_logging=False)
    try:
        node = Node(
            f"_ros2cli_{os.getpid()}",
            context=context,
            use_global_arguments=False,
            start_parameter_services=False,
            parameter_overrides=[Parameter("start_type_description_service", value=False)],
        )
    except Exception as error:
        context.try_shutdown()
        raise RuntimeError(str(error)) from error
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    me = Guest(node, executor, getattr(args, "timeout", None))
    try:
        if settled:
            me.settle()
        yield me
    finally:
        me.leave()
        context.try_shutdown()
