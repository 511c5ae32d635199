"""`ros2 topic bw`: how many bytes of a topic arrive."""

from __future__ import annotations

import time
from collections import deque
from typing import TYPE_CHECKING

from ros2 import listening, options
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

SUMMARY = "Display bandwidth used by topic"
WINDOW = 100
UNITS = ((1e3, 1.0, ".0f", "B"), (1e6, 1e3, ".2f", "KB"), (float("inf"), 1e6, ".2f", "MB"))
"""Below so many bytes a second: by what to divide, digits and unit."""


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_node(parser)
    add = parser.add_argument
    add("topic", help="Topic name to monitor for bandwidth utilization")
    add(
        "--window",
        "-w",
        type=options.positive_int,
        default=WINDOW,
        metavar="WINDOW",
        help=f"maximum window size, in # of messages, for calculating rate (default: {WINDOW})",
    )
    options.qos(parser, "subscribe", "sensor_data")
    options.hidden_topics(parser)


def main(args: argparse.Namespace) -> int | str | None:
    """Print the bytes a second, each second."""
    with joined(args) as me:
        cls = listening.awaited_type(me, args.topic)
        qos = listening.matching_qos(me, args.topic, words=False)
        if options.asks_for_qos(args):
            qos = options.chosen_qos(args, qos)
        came: deque[tuple[float, int]] = deque(maxlen=args.window)
        me.node.create_subscription(
            cls,
            args.topic,
            lambda data: came.append((time.monotonic(), len(data))),  # type: ignore[arg-type]
            qos,
            raw=True,
        )
        print(f"Subscribed to [{args.topic}]", flush=True)
        due = time.monotonic() + 1
        while True:
            me.spin_once(max(0.0, min(0.1, due - time.monotonic())))
            if time.monotonic() >= due:
                due += 1
                if len(came) > 1:
                    print(_figures(came), flush=True)


def _figures(came: Sequence[tuple[float, int]]) -> str:
    sizes = [size for _, size in came]
    rate = sum(sizes) / (time.monotonic() - came[0][0])
    divisor, digits, unit = next(rest for below, *rest in UNITS if rate < below)

    def shown(size: float) -> str:
        return f"{size / divisor:{digits}} {unit}"  # type: ignore[operator]

    mean = sum(sizes) / len(sizes)
    return (
        f"{shown(rate)}/s from {len(sizes)} messages\n"
        f"\tMessage size mean: {shown(mean)} min: {shown(min(sizes))} max: {shown(max(sizes))}"
    )
