"""`ros2 topic hz`: how often messages arrive."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from ros2 import listening, options
from ros2.figures import Window
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Print the average receiving rate to screen"
WINDOW = 10_000
EVERY_S = 1.0


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_node(parser)
    add = parser.add_argument
    add("topic_name", help="Name of the ROS topic to listen to (e.g. '/chatter')")
    add(
        "--window",
        "-w",
        dest="window_size",
        type=options.positive_int,
        default=WINDOW,
        metavar="WINDOW",
        help=f"window size, in # of messages, for calculating rate (default: {WINDOW})",
    )
    add(
        "--filter",
        dest="filter_expr",
        metavar="EXPR",
        help="only measure messages matching the specified Python expression",
    )
    add(
        "--wall-time",
        action="store_true",
        help="calculates rate using wall time which can be helpful when clock is not published during simulation",
    )
    options.qos(parser, "subscribe", "sensor_data")
    options.hidden_topics(parser)


def main(args: argparse.Namespace) -> int | str | None:
    """Print the rate each second in which a message has come."""
    expression = compile(args.filter_expr, "<filter>", "eval") if args.filter_expr else None
    with joined(args) as me:
        cls = listening.awaited_type(me, args.topic_name)
        qos = listening.matching_qos(me, args.topic_name, words=False)
        if options.asks_for_qos(args):
            qos = options.chosen_qos(args, qos)
        gaps, last, printed = Window(args.window_size), 0.0, 0.0

        def hear(message: Any) -> None:  # noqa: ANN401 - generated
            nonlocal last
            # Whoever types the command may run any Python here anyway.
            if expression and not eval(expression, {}, {"m": message}):
                return
            now = _now()
            if last:
                gaps.add(now - last)
            last = now

        def _now() -> float:
            if args.use_sim_time and not args.wall_time:
                return float(me.node.get_clock().now().nanoseconds) / 1e9
            return time.monotonic()

        me.node.create_subscription(cls, args.topic_name, hear, qos, raw=expression is None)
        while True:
            me.spin_once()
            if gaps.values and not printed:
                printed = last
            elif gaps.values and last >= printed + EVERY_S:
                printed = last
                mean = gaps.mean
                print(f"average rate: {1 / mean if mean > 0 else 0:.3f}\n\t{gaps.spread}", flush=True)
