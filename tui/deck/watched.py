"""The nodes that run in a domain in which Deck has not started anything."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import _, ngettext
from text.plain import plain
from tui.session.watching import robot_nodes

if TYPE_CHECKING:
    from graph.data import GraphUpdate

MOST_NAMES = 12
LONGEST_NAME = 60
"""The list on the Graph screen shows longer names in full."""


def watched_words(update: GraphUpdate, domain: int) -> str:
    """Return which nodes are there, and that Deck neither starts nor stops them."""
    names = [_shown(name.lstrip("/")) for name in robot_nodes(update)]
    if not names:
        words = _(
            "Nobody is here yet. Start a node with ROS_DOMAIN_ID={domain}, or look elsewhere:"
            " deck watch --domain N, and --discovery subnet for other machines."
        )
        return words.format(domain=domain)
    more = f" +{len(names) - MOST_NAMES}" if len(names) > MOST_NAMES else ""
    count = ngettext("{n} node runs here", "{n} nodes run here", len(names)).format(n=len(names))
    ours = _("Deck has started nothing here and stops nothing when it leaves.")
    return f"{ours} {count}: {', '.join(names[:MOST_NAMES])}{more}"


def _shown(name: str) -> str:
    return plain(name if len(name) <= LONGEST_NAME else name[: LONGEST_NAME - 1] + "…")
