"""The obvious first solution: raw subscriptions whose callback writes the bytes to a file.

`python -m bench.recorders.bare DOMAIN FOLDER` answers each line on stdin with the number of
messages so far.
"""

from __future__ import annotations

import contextlib
import sys
import threading
from itertools import count
from pathlib import Path

from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import UInt8MultiArray

from bench.recorders.load import SIZES


def main() -> None:
    """Write messages until stdin is closed."""
    context = Context()
    context.init(args=[], domain_id=int(sys.argv[1]))
    node = Node("bare", context=context)
    numbers, newest = count(1), [0]
    Path(sys.argv[2]).mkdir(parents=True)

    def answer() -> None:
        print("ready", flush=True)
        for _line in sys.stdin:
            print(newest[0], flush=True)
        context.try_shutdown()

    with Path(sys.argv[2], "messages").open("wb") as file:

        def take(raw: bytes) -> None:
            file.write(raw)
            newest[0] = next(numbers)

        for topic in SIZES:
            node.create_subscription(UInt8MultiArray, topic, take, QoSProfile(depth=200), raw=True)
        threading.Thread(target=answer, daemon=True).start()
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        with contextlib.suppress(ExternalShutdownException):
            executor.spin()


if __name__ == "__main__":
    main()
