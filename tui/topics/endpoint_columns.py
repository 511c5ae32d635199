"""The columns of a topic's endpoints; those without room stand in a line below each endpoint."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from text.i18n import _
from text.plain import plain
from tui.topics.figures import UNKNOWN, seconds_text

if TYPE_CHECKING:
    from graph.data import EndpointInfo

LONGEST_NAME = 256
WIDEST_NODE = 44


@dataclass(frozen=True)
class EndpointColumn:
    """One column; `id` is the policy's name where it is one."""

    id: str
    title: str
    """The words of the policies are those of ROS in every language: they are what one types."""
    width: int
    text: Callable[[EndpointInfo], str]


def history_text(end: EndpointInfo) -> str:
    """`keep_last 10`, `keep_all`, or what is known of it."""
    if end.history == "keep_last" and end.depth:
        return f"{end.history} {end.depth}"
    if not end.history and end.depth:
        return str(end.depth)
    return end.history or UNKNOWN


def time_text(seconds: float | None) -> str:
    """A time that was asked for or offered, or that none was."""
    return _("none") if seconds is None else seconds_text(seconds)


def liveliness_text(end: EndpointInfo) -> str:
    """The kind, and for how long without a sign of life it is taken for alive."""
    if not end.liveliness:
        return UNKNOWN
    lease = "" if end.lease_s is None else f" {seconds_text(end.lease_s)}"
    return end.liveliness + lease


NODE = EndpointColumn("node", "", 20, lambda end: plain(end.node, LONGEST_NAME))
POLICIES = (
    EndpointColumn("reliability", "reliability", 11, lambda end: end.reliability or UNKNOWN),
    EndpointColumn("durability", "durability", 15, lambda end: end.durability or UNKNOWN),
    EndpointColumn("history", "history", 13, history_text),
    EndpointColumn("deadline", "deadline", 8, lambda end: time_text(end.deadline_s)),
    EndpointColumn("lifespan", "lifespan", 8, lambda end: time_text(end.lifespan_s)),
    EndpointColumn("liveliness", "liveliness", 22, liveliness_text),
)
"""In the order of the screen; the last go first when room is short."""


def columns_for(width: int) -> tuple[EndpointColumn, ...]:
    """The columns that fit into so many cells, one blank between them; the node takes the rest."""
    kept = list(POLICIES)
    while kept and NODE.width + sum(column.width + 1 for column in kept) > width:
        kept.pop()
    spare = width - sum(column.width + 1 for column in kept)
    return (replace(NODE, width=max(1, min(spare, WIDEST_NODE))), *kept)


def left_over(columns: Sequence[EndpointColumn]) -> tuple[EndpointColumn, ...]:
    """The policies that have no column."""
    return POLICIES[len(columns) - 1 :]
