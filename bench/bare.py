"""The obvious first solution: subscriptions to the load in a SingleThreadedExecutor.

`python -m bench.bare DOMAIN` answers each line on stdin with the rates of the topics since the
previous line, as JSON.
"""

from __future__ import annotations

import contextlib
import json
import sys
import threading
import time
from collections import Counter

from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import Image
from std_msgs.msg import Float32

from bench.load import IMAGE, RATES_HZ


def main() -> None:
    """Count messages until stdin is closed."""
    context = Context()
    context.init(args=[], domain_id=int(sys.argv[1]))
    node = Node("bare", context=context)
    counts: Counter[str] = Counter()

    def subscribe(topic: str) -> None:
        def count(_message: object) -> None:
            counts[topic] += 1

        node.create_subscription(Image if topic == IMAGE else Float32, topic, count, 10)

    for topic in RATES_HZ:
        subscribe(topic)

    def answer() -> None:
        before, before_s = Counter(counts), time.monotonic()
        print("ready", flush=True)
        for _ in sys.stdin:
            now_s = time.monotonic()
            rates = {t: (counts[t] - before[t]) / (now_s - before_s) for t in RATES_HZ}
            print(json.dumps(rates), flush=True)
            before, before_s = Counter(counts), now_s
        context.try_shutdown()

    threading.Thread(target=answer, daemon=True).start()
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    with contextlib.suppress(ExternalShutdownException):
        executor.spin()


if __name__ == "__main__":
    main()
