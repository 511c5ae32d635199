"""`python -m bench.graph_watch NAME...`: says when all these nodes are in the ROS graph.

Prints `ready`, then after each line on stdin waits until the graph has none of the nodes
(`gone`) or all of them (the monotonic time at which it saw them).
"""

from __future__ import annotations

import os
import sys
import time

import rclpy
from rclpy.node import Node

PERIOD_S = 0.005


def names_in(node: Node) -> set[str]:
    """Return the names of all nodes in the graph."""
    return {name for name, _namespace in node.get_node_names_and_namespaces()}


def main() -> None:
    """Watch until stdin ends."""
    wanted = set(sys.argv[1:])
    rclpy.init()
    node = rclpy.create_node(f"_watch_{os.getpid()}", enable_rosout=False)
    print("ready", flush=True)
    for line in sys.stdin:
        if line == "all\n":
            while not wanted <= names_in(node):
                time.sleep(PERIOD_S)
            print(time.monotonic(), flush=True)
        else:
            while wanted & names_in(node):
                time.sleep(PERIOD_S)
            print("gone", flush=True)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
