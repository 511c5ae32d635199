"""Why nothing is listed, and what to do about it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import _, said
from tui.graph.place import Kind

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tui.graph.index import Entry
    from tui.session.feed import Feed


def why_empty(feed: Feed, kind: Kind, listed: Sequence[Entry], *, all_key: str) -> tuple[str, str]:
    """Return headline and way out for a list that shows none of `listed`."""
    update = feed.update
    if feed.link is None:
        return _("no lesson is running"), ""
    if update is None:
        return _("the graph is being looked at"), _("Nodes are starting.")
    if update.error:
        return feed.blind, said(update.error)
    if any(not entry.housekeeping for entry in listed):
        return _("nothing fits the filter"), _("Escape in the filter shows all again.")
    if listed:
        return _("only what ROS itself needs is here"), _("{key} shows it.").format(key=all_key)
    return _none(kind)


def _none(kind: Kind) -> tuple[str, str]:
    if kind is Kind.NODE:
        return _("no node in this domain"), _(
            "Nodes of another domain number, or of another computer while discovery is localhost, "
            "are not seen."
        )
    if kind is Kind.SERVICE:
        return _("nobody serves a service"), _("Start a node that does: head_controller is one.")
    if kind is Kind.ACTION:
        return _("nobody serves an action"), _("Start a node that does: drive_to_point is one.")
    return _("no type is in use"), _("Types are those of topics, services and actions.")
