"""Nodes with inner states, all in one process: lifecycles, a container, logger services.

Each lifecycle node is named after what its on_configure does. The container is a Python node that
serves what a container of rclcpp_components serves; there is none of those on a machine with pip.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import rclpy
from composition_interfaces.srv import ListNodes
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.node import Node

from tests import ports
from tests.ros.peer import DISCOVERY, ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

NAMES = ("good", "refusing", "raising", "hopeless", "hanging")


class Managed(LifecycleNode):
    """A node that configures as its name says; a log line tells of every transition."""

    def __init__(self, name: str, **options: Any) -> None:
        super().__init__(name, **options)
        self._kind = name

    def on_configure(self, state: Any) -> Any:
        del state
        self.get_logger().info("configuring")  # type: ignore[no-untyped-call]
        if self._kind == "refusing":
            return TransitionCallbackReturn.FAILURE
        if self._kind == "hanging":
            threading.Event().wait()
        if self._kind in {"raising", "hopeless"}:
            raise OSError("no such camera")
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: Any) -> Any:
        del state
        hopeless = self._kind == "hopeless"
        return TransitionCallbackReturn.FAILURE if hopeless else TransitionCallbackReturn.SUCCESS


class Container(Node):
    """Lists two components."""

    def __init__(self) -> None:
        super().__init__("container", namespace="/arm")
        self.create_service(ListNodes, "~/_container/list_nodes", self._list)

    def _list(self, _request: Any, response: Any) -> Any:
        response.full_node_names = ["/arm/gripper", "/good"]
        response.unique_ids = [2, 1]
        return response


@contextmanager
def started(domain: int, *names: str) -> Iterator[subprocess.Popen[bytes]]:
    """Run them in a process of their own for the length of a `with`."""
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.ros.managed_nodes", *names],
        cwd=ROOT,
        env={**os.environ, **DISCOVERY, "ROS_DOMAIN_ID": str(domain)},
    )
    try:
        yield process
    finally:
        held = ports.held_by([process.pid])
        process.kill()
        process.wait(10)
        ports.burn(held)


def main() -> None:
    """Spin the nodes that are named on the command line, or all."""
    named = [word for word in sys.argv[1:] if word in NAMES] or [*NAMES]
    rclpy.init(args=sys.argv)
    nodes: list[Any] = [Managed(name, enable_logger_service=True) for name in named]
    if len(named) == len(NAMES):
        nodes += [Container(), Node("ordinary")]
    executor = MultiThreadedExecutor(2 * len(nodes))
    for node in nodes:
        executor.add_node(node)
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        executor.spin()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
