"""What each node that obeys the emergency stop reports about it: /emergency_stop_state, read."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from safety.topics import EMERGENCY_STATE

if TYPE_CHECKING:
    from graph.data import GraphUpdate, Sample

GONE_S = 3.5
"""Nodes report once a second; one that is silent for longer and is not in the graph is gone."""
MOST = 64
"""Maximum number of nodes that are tracked: anybody may publish anything."""
PICO = "pico"
DECKS = "/_deck_"
"""Prefix of the names of Deck's own nodes."""


@dataclass(frozen=True)
class NodeStop:
    """The newest report of one node."""

    engaged: bool
    heard_s: float
    """When it was received, Unix time."""
    since_s: float = 0.0
    """Since when it holds or is released, Unix time by its clock; 0: it has held nothing yet."""
    held_s: float = -math.inf
    """When it last reported that it holds."""
    by: str = ""
    """What engaged it: `topic`, `pico`, empty if unknown."""
    publishers: tuple[str, ...] = ()
    """Full names of the nodes that may have published it on the topic."""
    contradicted: bool = False
    """Whether somebody releases it in vain, because another keeps giving it."""
    before: bool = False
    """Whether it already held when it started, or when it was first heard."""


def reported_stops(nodes: Mapping[str, NodeStop], update: GraphUpdate) -> dict[str, NodeStop]:
    """Return `nodes` updated with their new reports."""
    known = dict(nodes)
    for sample in update.samples.get(EMERGENCY_STATE, ()):
        for name, values in _statuses(sample):
            if name in known or len(known) < MOST:
                known[name] = _read(values, sample, known.get(name))
    return known


def present(nodes: Mapping[str, NodeStop], update: GraphUpdate) -> dict[str, NodeStop]:
    """Return the nodes that are still present."""
    names = {node.name for node in update.nodes}
    return {name: node for name, node in nodes.items() if name in names or update.time_s - node.heard_s < GONE_S}


def _statuses(sample: Sample) -> Iterator[tuple[str, dict[str, str]]]:
    statuses: Any = sample.value.get("status", ())
    for status in statuses if isinstance(statuses, (list, tuple)) else ():
        if not isinstance(status, Mapping) or not status.get("name"):
            continue
        pairs = status.get("values", ())
        values = {
            str(pair.get("key", "")): str(pair.get("value", ""))
            for pair in (pairs if isinstance(pairs, (list, tuple)) else ())
            if isinstance(pair, Mapping)
        }
        if values.get("engaged") in ("true", "false"):
            yield str(status["name"]), values


def _read(values: Mapping[str, str], sample: Sample, last: NodeStop | None) -> NodeStop:
    heard_s = sample.received_s
    if values["engaged"] == "false":
        held_s = -math.inf if last is None else last.held_s
        return NodeStop(False, heard_s, _seconds(values), held_s)
    before = values.get("remembered") == "true" or last is None or (last.engaged and last.before)
    return NodeStop(
        True,
        heard_s,
        _seconds(values),
        min(heard_s, sample.sent_s or heard_s),
        values.get("by", ""),
        tuple(values.get("publishers", "").split()),
        values.get("contradicted") == "true",
        before,
    )


def _seconds(values: Mapping[str, str]) -> float:
    try:
        seconds = float(values.get("since", ""))
    except ValueError:
        return 0.0
    return seconds if math.isfinite(seconds) else 0.0
