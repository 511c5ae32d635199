"""`python -m bench.graph_watch NAME...`: says when all these nodes are in the ROS graph.

Prints `ready`, then the monotonic time at which it has seen them all, and ends with its stdin.
"""

from __future__ import annotations

import os
import sys
import time

import rclpy

PERIOD_S = 0.005


def main() -> None:
    """Watch until all are there."""
    wanted = set(sys.argv[1:])
    rclpy.init()
    node = rclpy.create_node(f"_watch_{os.getpid()}", enable_rosout=False)
    print("ready", flush=True)
    while not wanted <= {name for name, _namespace in node.get_node_names_and_namespaces()}:
        time.sleep(PERIOD_S)
    print(time.monotonic(), flush=True)
    sys.stdin.read()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
