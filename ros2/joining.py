"""The node of one command: joins the domain of the environment, and waits until it sees the others.

There is no daemon that knows the graph already. A command waits until nothing new has been found
for a moment, or, if it needs one thing, until that is there.
"""

from __future__ import annotations

import os
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from graph.ros import FAST_DDS_VARIABLES, RANGE, announcing

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Iterator

    from rclpy.executors import SingleThreadedExecutor
    from rclpy.node import Node
    from rclpy.task import Future

QUIET_S = 0.3
"""Without news for so long, the graph is taken to be complete: Deck's nodes announce each 0.2 s."""
ALONE_S = 0.8
"""So long must nobody else be found for the graph to be taken as empty."""
LONGEST_S = 3.0
"""A graph that never comes to rest is taken as it is."""
MISSING_S = 1.2
"""So long is one thing waited for that is named on the command line."""
READY_S = 5.0
"""So long may a service of a node that is there take to be found."""
LOOK_S = 0.01
SPIN_S = 0.1
"""How late Ctrl-C may be noticed: the middleware does not wake up for signals."""


class Guest:
    """A node in the graph, with what drives it."""

    def __init__(self, node: Node, executor: SingleThreadedExecutor) -> None:
        """Take both, open."""
        self.node = node
        self._executor = executor

    def spin_once(self, timeout_s: float = SPIN_S) -> None:
        """Take in what has come, or wait a moment for it."""
        self._executor.spin_once(timeout_sec=timeout_s)

    def finish(self, future: Future) -> None:
        """Wait for an answer."""
        while not future.done():
            self.spin_once()

    def call(self, service: str, kind: Any, owner: str, **fields: object) -> Any:  # noqa: ANN401
        """Call a service of the node `owner` and return the answer; RuntimeError without one."""
        client = self.node.create_client(kind, service)
        try:
            if not client.wait_for_service(timeout_sec=READY_S):
                raise RuntimeError("Wait for service timed out")
            future = client.call_async(kind.Request(**fields))
            self.finish(future)
            response = future.result()
            if response is None:
                why = future.exception()
                raise RuntimeError(f"Exception while calling service of node '{owner}': {why}")
            return response
        finally:
            self.node.destroy_client(client)

    def settle(self) -> None:
        """Wait until nothing new has been found for a moment."""
        alone = known = self._known()
        since = time.monotonic()
        end = since + LONGEST_S
        while (now := time.monotonic()) < min(
            since + (ALONE_S if known == alone else QUIET_S), end
        ):
            time.sleep(LOOK_S)
            found = self._known()
            if found != known:
                known, since = found, now

    def await_until(self, there: Callable[[], bool]) -> bool:
        """Wait for one thing, not for ever; return whether it is there."""
        end = time.monotonic() + MISSING_S
        while not (found := there()) and time.monotonic() < end:
            time.sleep(LOOK_S)
        return found

    def _known(self) -> tuple[object, ...]:
        node = self.node
        topics = node.get_topic_names_and_types()
        return (
            node.get_node_names_and_namespaces(),
            [
                (name, node.count_publishers(name), node.count_subscribers(name))
                for name, _ in topics
            ],
            node.get_service_names_and_types(),
        )


@contextmanager
def joined(args: argparse.Namespace, name: str = "", *, settled: bool = False) -> Iterator[Guest]:
    """Open the node of a command for the length of a `with`; `settled`: it sees everybody."""
    from rclpy.context import Context
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.node import Node
    from rclpy.parameter import Parameter

    context = Context()
    if os.environ.get(RANGE, "").upper() == "LOCALHOST":
        for variable, value in announcing("localhost").items():
            if value is not None and variable in FAST_DDS_VARIABLES:
                os.environ.setdefault(variable, value)
    context.init(args=[], initialize_logging=False)
    own = [Parameter("start_type_description_service", value=False)]
    if getattr(args, "use_sim_time", False):
        own.append(Parameter("use_sim_time", value=True))
    try:
        node = Node(
            name or f"_ros2cli_{os.getpid()}",
            context=context,
            use_global_arguments=False,
            start_parameter_services=False,
            parameter_overrides=own,
        )
    except Exception as error:
        context.try_shutdown()
        raise RuntimeError(str(error)) from error
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    try:
        me = Guest(node, executor)
        spin_s = getattr(args, "spin_time", None)
        if spin_s is not None:
            time.sleep(spin_s)
        elif settled:
            me.settle()
        yield me
    finally:
        executor.shutdown()
        node.destroy_node()
        context.try_shutdown()
