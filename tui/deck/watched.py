"""The nodes that run in a domain in which Deck has not started anything."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import _, ngettext
from text.plain import plain
from tui import clock
from tui.session.watching import robot_nodes

if TYPE_CHECKING:
    from graph.data import GraphUpdate

MOST_NAMES = 12
LONGEST_NAME = 60
"""The list on the Graph screen shows longer names in full."""


class Watched:
    """Says who is there, and remembers that somebody was."""

    def __init__(self, domain: int, *, beyond: bool = False) -> None:
        """`beyond`: whether other machines are looked at as well."""
        self._domain, self._beyond = domain, beyond
        self._met = False
        self._gone_s: float | None = None
        """Since when nobody is seen, of those who were; Unix time."""

    def words(self, update: GraphUpdate) -> str:
        """Return which nodes are there, and that Deck neither starts nor stops them."""
        names = robot_nodes(update)
        if names:
            self._met, self._gone_s = True, None
            return _named([_shown(name.lstrip("/")) for name in names])
        if not self._met:
            return self._nobody_yet()
        if self._gone_s is None:
            self._gone_s = update.time_s
        words = (
            _("Nobody is seen any more since {time}: the network may be down, or all nodes have ended.")
            if self._beyond
            else _("Nobody is seen any more since {time}.")
        )
        return words.format(time=clock.time_of_day(self._gone_s))

    def _nobody_yet(self) -> str:
        words = (
            _(
                "Nobody is here yet. Start a node with ROS_DOMAIN_ID={domain}, here or on another"
                " machine that lets others in, or look elsewhere: deck watch --domain N."
            )
            if self._beyond
            else _(
                "Nobody is here yet. Start a node with ROS_DOMAIN_ID={domain}, or look elsewhere:"
                " deck watch --domain N, and --discovery subnet for other machines."
            )
        )
        return words.format(domain=self._domain)


def _named(names: list[str]) -> str:
    more = f" +{len(names) - MOST_NAMES}" if len(names) > MOST_NAMES else ""
    count = ngettext("{n} node runs here", "{n} nodes run here", len(names)).format(n=len(names))
    ours = _("Deck has started nothing here and stops nothing when it leaves.")
    return f"{ours} {count}: {', '.join(names[:MOST_NAMES])}{more}"


def _shown(name: str) -> str:
    return plain(name if len(name) <= LONGEST_NAME else name[: LONGEST_NAME - 1] + "…")
