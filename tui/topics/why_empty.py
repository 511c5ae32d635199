"""What the table says when there is no topic in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.housekeeping import is_housekeeping
from text.i18n import _, localized
from tui.frame import title
from tui.topics.actions import show_housekeeping

if TYPE_CHECKING:
    from collections.abc import Sequence

    from graph.data import TopicRow
    from tui.frame.host import Host


def why_empty(deck: Host, listed: Sequence[TopicRow]) -> tuple[str, str]:
    """Return headline and detail for a table that shows none of the topics that are `listed`."""
    feed = deck.feed
    if feed.link is None:
        return _("no lesson is running"), ""
    if feed.update is not None and feed.update.error:
        return feed.blind, localized(feed.update.error)
    if title.starting(deck):
        return _("no topics yet"), _("Nodes are starting.")
    if feed.update is None or not all(is_housekeeping(row.name) for row in listed):
        return _("no topics yet"), ""
    if not listed:
        return _("no topics"), _("Nobody publishes anything, and nobody listens.")
    key = deck.keys_of(show_housekeeping)[0]
    words = _("There are only those of ROS itself: {key} shows them.").format(key=key)
    return _("no topics of the robot"), words
