"""The probe: a short-lived process that tells which nodes, topics and services the graph has.

The supervisor has no rclpy. While some node's readiness is awaited, this process, forked from
the spawn server, watches the graph for it: a line of JSON on stdout for every change, the list
of the conditions that hold now, by their position in the list it was given.
"""

from __future__ import annotations

import json
import os
import select
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rclpy.node import Node

EAGER_S = 10.0
"""For so long it looks often: a start is under way."""
EAGER_PERIOD_S = 0.03
CALM_PERIOD_S = 0.25


def probe(argv: Sequence[str]) -> None:
    """Watch until stdin ends; `argv` is one JSON list of `[kind, name]` conditions."""
    import rclpy
    from rclpy.signals import SignalHandlerOptions

    conditions = [(str(kind), str(name)) for kind, name in json.loads(argv[0])]
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    # A leading underscore hides a node from people's lists.
    node = rclpy.create_node(
        f"_deck_probe_{os.getpid()}",
        use_global_arguments=False,
        enable_rosout=False,
        start_parameter_services=False,
    )
    try:
        _watch(node, conditions)
    finally:
        node.destroy_node()
        rclpy.shutdown()


def _watch(node: Node, conditions: Sequence[tuple[str, str]]) -> None:
    started = time.monotonic()
    told: list[int] | None = None
    while True:
        names = {
            f"{space.rstrip('/')}/{name}" for name, space in node.get_node_names_and_namespaces()
        }
        met = [
            position
            for position, (kind, name) in enumerate(conditions)
            if _holds(node, names, kind, name)
        ]
        if met != told:
            os.write(1, json.dumps(met).encode() + b"\n")
            told = met
        eager = time.monotonic() - started < EAGER_S
        if select.select([0], [], [], EAGER_PERIOD_S if eager else CALM_PERIOD_S)[0]:
            return


def _holds(node: Node, names: set[str], kind: str, name: str) -> bool:
    if kind == "node":
        return f"/{name.lstrip('/')}" in names
    if kind == "topic":
        return node.count_publishers(name) > 0
    return node.count_services(name) > 0
