"""How to observe; plain data."""

from __future__ import annotations

from dataclasses import dataclass

LOOK_AT_GRAPH_S = 0.25
"""Often enough for a reader of the screen."""


@dataclass(frozen=True)
class ObserverSettings:
    """What an observer gets at its start."""

    domain: int
    discovery: str | tuple[str, ...] = "localhost"
    """`localhost`, `subnet`, or the addresses of peers."""
    graph_s: float = LOOK_AT_GRAPH_S
    """Seconds between two looks at who is there."""
    role: str = "observer"
    """Part of its node's name, see `graph.ros.ONLY_LISTENING`."""
    owner: int = 0
    """The process that it is for, by whose number its node is called; 0 for its own."""
