"""A topic has one type: a node that uses another neither hears the others nor is heard."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launcher.status import NodeFault
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from launcher.supervisor.readiness import Clash


def clash_of(node: str, file: str, clashes: Sequence[Clash]) -> NodeFault | None:
    """Return the first topic that this node (full name) uses with another type than others do."""
    for topic, users in clashes:
        own = [kind for user, kind in users if user == node]
        others = [(user, kind) for user, kind in users if user != node and kind not in own]
        if own and others:
            user, kind = others[0]
            return NodeFault(
                "warning",
                file,
                exception=say(
                    "{topic} is {own} here, and {other} in {node}", topic=topic, own=own[0], other=kind, node=user
                ),
                meaning=say("A topic has one type: messages of another do not arrive."),
            )
    return None
