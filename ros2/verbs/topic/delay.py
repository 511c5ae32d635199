"""`ros2 topic delay`: how old messages are when they arrive, by the stamp in their header."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from ros2 import listening, options
from ros2.figures import Window
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Display delay of topic from timestamp in header"
WINDOW = 10_000


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_node(parser)
    add = parser.add_argument
    add("topic", help="Topic name to calculate the delay for")
    add(
        "--window",
        "-w",
        type=options.positive_int,
        default=WINDOW,
        help=f"window size, in # of messages, for calculating rate, string to (default: {WINDOW})",
    )
    options.hidden_topics(parser)


def main(args: argparse.Namespace) -> int | str | None:
    """Print the mean each second."""
    with joined(args) as me:
        cls = listening.awaited_type(me, args.topic)
        delays, is_new = Window(args.window), False

        def hear(message: Any) -> None:  # noqa: ANN401 - generated
            nonlocal is_new
            if not hasattr(message, "header"):
                raise RuntimeError("msg does not have header")
            stamp = message.header.stamp
            now = me.node.get_clock().now().nanoseconds
            delays.add((now - stamp.sec * 10**9 - stamp.nanosec) / 1e9)
            is_new = True

        qos = listening.matching_qos(me, args.topic, words=False)
        me.node.create_subscription(cls, args.topic, hear, qos)
        due = time.monotonic() + 1
        while True:
            me.spin_once(max(0.0, min(0.1, due - time.monotonic())))
            if time.monotonic() < due:
                continue
            due += 1
            if is_new:
                print(f"average delay: {delays.mean:.3f}\n\t{delays.spread}", flush=True)
            elif delays.values:
                print("no new messages", flush=True)
            is_new = False
