"""Nodes with a lifecycle and logger services, in one process; each configures as its name says."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.node import Node

from tests.ros.peer import DISCOVERY, ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

NAMES = ("good", "refusing")


class Managed(LifecycleNode):
    """A node that configures as its name says."""

    def __init__(self, name: str, **options: Any) -> None:
        super().__init__(name, **options)
        self._kind = name

    def on_configure(self, state: Any) -> Any:
        del state
        refuses = self._kind == "refusing"
        return TransitionCallbackReturn.FAILURE if refuses else TransitionCallbackReturn.SUCCESS


@contextmanager
def started(domain: int) -> Iterator[subprocess.Popen[bytes]]:
    """Run them in a process of their own for the length of a `with`."""
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.ros.managed_nodes"],
        cwd=ROOT,
        env={**os.environ, **DISCOVERY, "ROS_DOMAIN_ID": str(domain)},
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait(10)


def main() -> None:
    rclpy.init(args=sys.argv)
    executor = MultiThreadedExecutor(4)
    for node in [*(Managed(name, enable_logger_service=True) for name in NAMES), Node("ordinary")]:
        executor.add_node(node)
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        executor.spin()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
