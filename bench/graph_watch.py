"""`python -m bench.graph_watch NAME...`: report when all these nodes are in the ROS graph.

It prints `ready`, then the monotonic time at which it has seen them all, and ends when its stdin is
closed. If some nodes do not appear, it ends with a message that names them.
"""

from __future__ import annotations

import os
import select
import sys
import time

import rclpy

PERIOD_S = 0.005
WITHIN_S = 60.0


def main() -> None:
    """Watch until all nodes are there."""
    wanted = set(sys.argv[1:])
    rclpy.init()
    node = rclpy.create_node(f"_watch_{os.getpid()}", enable_rosout=False)
    print("ready", flush=True)
    deadline_s = time.monotonic() + WITHIN_S
    while missing := wanted - {name for name, _ in node.get_node_names_and_namespaces()}:
        if select.select([sys.stdin], [], [], PERIOD_S)[0]:
            return  # Nobody is waiting for the result any more.
        if time.monotonic() > deadline_s:
            sys.exit(f"not in the graph within {WITHIN_S:g} s: {', '.join(sorted(missing))}")
    print(time.monotonic(), flush=True)
    sys.stdin.read()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
