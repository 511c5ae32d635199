"""The probe: a short-lived process that reports which nodes, topics and services exist.

The supervisor does not load rclpy. While it waits for a node to become ready, this process, forked
from the spawn server, watches the graph for it and writes a line of JSON to its stdout for every
change. It ends with its stdin.

`met` lists the conditions that hold now, by their position in the list it was given; `seen` has
`[position, types, messages per second or null]` for each topic that is published but not as
required. `clashes` has `[topic, [[node, type], ...]]` for each topic that is used with several
types, and null as long as that is not known.
"""

from __future__ import annotations

import importlib
import json
import os
import select
import time
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

from text.nested import read_json

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.subscription import Subscription

EAGER_S = 10.0
"""It checks often for this long, because a start is in progress."""
EAGER_PERIOD_S = 0.03
CALM_PERIOD_S = 0.25
RATES_S = 1.0
"""A rate that is too low is reported no more often than this."""
CLASHES_S = 0.25
"""How often to look for topics of several types."""
KNOWN_AFTER_S = 1.5
"""By then it has found who was there before it: before, a topic may seem to have one type only."""
HIDDEN = "_"
COUNTED = 5
"""A rate is computed over this many recent messages."""
KEPT = 50
"""Most messages between two checks; a camera sends one every 30 to 100 ms."""
ENOUGH = 0.9
"""Fraction of the required rate that is enough: a 5 Hz timer never quite reaches 5 Hz."""


class ArrivalRate:
    """Counts the messages of one topic; all times are unix seconds."""

    def __init__(self) -> None:
        self._sent_s: deque[float] = deque(maxlen=COUNTED)
        self._received_s: deque[float] = deque(maxlen=COUNTED)

    def add(self, sent_s: float, received_s: float) -> None:
        """Count a message; `sent_s` is by its publisher's clock, 0 if the middleware hides it."""
        self._sent_s.append(sent_s)
        self._received_s.append(received_s)

    def hz(self, now_s: float) -> float:
        """Return messages per second; 0 until enough have arrived to compute it.

        Messages that were held up arrive together, and a publisher that has fallen silent does not
        keep its former rate: the longest of the times that they took counts.
        """
        if len(self._received_s) < COUNTED:
            return 0.0
        first_s, last_s = self._received_s[0], self._received_s[-1]
        due_s = now_s - (last_s - first_s) / (COUNTED - 1)
        lasted_s = max(max(last_s, due_s) - first_s, max(self._sent_s) - min(self._sent_s))
        return (COUNTED - 1) / lasted_s if lasted_s > 0 else 0.0


class MessageRates:
    """Counts the messages of each topic from the first request for it on."""

    def __init__(self, node: Node) -> None:
        """`node`: the node that subscribes."""
        self._node = node
        self._counted: dict[tuple[str, str], tuple[Subscription, ArrivalRate]] = {}

    def rate_hz(self, topic: str, type_name: str) -> float | None:
        """Return messages per second, 0 until enough have arrived; None if their type is not installed."""
        if (topic, type_name) not in self._counted:
            package, _, name = type_name.partition("/msg/")
            try:
                kind = getattr(importlib.import_module(f"{package}.msg"), name)
            except (ImportError, AttributeError):
                return None
            self._counted[topic, type_name] = self._subscribed(topic, kind), ArrivalRate()
        subscription, rate = self._counted[topic, type_name]
        while True:
            with subscription.handle:
                taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
            if taken is None:
                return rate.hz(time.time())
            rate.add(taken[1]["source_timestamp"] / 1e9, taken[1]["received_timestamp"] / 1e9)

    def _subscribed(self, topic: str, kind: type[Any]) -> Subscription:
        from rclpy.qos import QoSProfile, ReliabilityPolicy

        # This receives from reliable and best-effort publishers.
        quality = QoSProfile(depth=KEPT, reliability=ReliabilityPolicy.BEST_EFFORT)
        return self._node.create_subscription(kind, topic, lambda _message: None, quality, raw=True)


class _Wanted(NamedTuple):
    """The counterpart of `launcher.profile.node.Ready`."""

    kind: str
    name: str
    type: str
    rate_hz: float


@dataclass
class _Report:
    met: list[int] = field(default_factory=list)
    seen: list[tuple[int, list[str], float | None]] = field(default_factory=list)
    clashes: list[tuple[str, list[tuple[str, str]]]] | None = None
    """None as long as they are not known."""

    @property
    def lasting(self) -> object:
        """All but the rates, which change all the time."""
        return self.met, self.clashes, [seen[:2] for seen in self.seen]


@contextmanager
def hidden_node(name: str) -> Iterator[tuple[Node, int]]:
    """Make a node for the length of a `with`; yields it, and where to write reports to the supervisor."""
    # Fast DDS prints its errors to stdout.
    reports = os.dup(1)
    os.dup2(2, 1)

    import rclpy
    from rclpy.signals import SignalHandlerOptions

    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    # A leading underscore hides a node from the usual lists.
    node = rclpy.create_node(
        f"_{name}_{os.getpid()}", use_global_arguments=False, enable_rosout=False, start_parameter_services=False
    )
    try:
        yield node, reports
    finally:
        node.destroy_node()
        rclpy.shutdown()


def probe(argv: Sequence[str]) -> None:
    """Watch until stdin ends; `argv` is a single JSON list of `[kind, name, type, rate]`."""
    conditions = [_Wanted(*fields) for fields in read_json(argv[0])]
    with hidden_node("deck_probe") as (node, reports):
        _watch(node, conditions, MessageRates(node), reports)


def _watch(node: Node, conditions: Sequence[_Wanted], arrivals: MessageRates, reports: int) -> None:
    started = time.monotonic()
    told: _Report | None = None
    told_at = 0.0
    clashes, clashes_at = None, started + KNOWN_AFTER_S
    while True:
        now = time.monotonic()
        report = _look(node, conditions, arrivals)
        if now >= clashes_at:
            clashes, clashes_at = _clashes(node), now + CLASHES_S
        report.clashes = clashes
        if told is None or report.lasting != told.lasting or (report != told and now > told_at + RATES_S):
            os.write(reports, json.dumps(vars(report)).encode() + b"\n")
            told, told_at = report, now
        eager = now - started < EAGER_S
        if select.select([0], [], [], EAGER_PERIOD_S if eager else CALM_PERIOD_S)[0]:
            return


def _look(node: Node, conditions: Sequence[_Wanted], arrivals: MessageRates) -> _Report:
    names = {f"{space.rstrip('/')}/{name}" for name, space in node.get_node_names_and_namespaces()}
    report = _Report()
    for position, wanted in enumerate(conditions):
        rate_hz, types = None, []
        if wanted.kind == "node":
            met = f"/{wanted.name.lstrip('/')}" in names
        elif wanted.kind == "service":
            met = node.count_services(wanted.name) > 0
        elif not node.count_publishers(wanted.name):
            met = False
        else:
            types = sorted({end.topic_type for end in node.get_publishers_info_by_topic(wanted.name)})
            met = bool(types) and wanted.type in ("", *types)
            if met and wanted.rate_hz:
                rate_hz = arrivals.rate_hz(wanted.name, wanted.type or types[0])
                met = rate_hz is not None and rate_hz >= ENOUGH * wanted.rate_hz
        if met:
            report.met.append(position)
        elif types:
            report.seen.append((position, types, rate_hz))
    return report


def _clashes(node: Node) -> list[tuple[str, list[tuple[str, str]]]]:
    """Return the topics that have several types, with who uses which."""
    found = []
    for topic, types in node.get_topic_names_and_types():
        if len(types) > 1:
            ends = (*node.get_publishers_info_by_topic(topic), *node.get_subscriptions_info_by_topic(topic))
            users = {
                (f"{end.node_namespace.rstrip('/')}/{end.node_name}", str(end.topic_type))
                for end in ends
                if not end.node_name.startswith(HIDDEN)
            }
            if len({kind for _, kind in users}) > 1:
                found.append((str(topic), sorted(users)))
    return sorted(found)
