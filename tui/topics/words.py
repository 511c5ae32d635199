"""A topic in sentences: its activity, and its endpoints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.cells import cell_len

from graph.data import TopicRow, Trouble
from graph.housekeeping import is_housekeeping
from text.i18n import _, decimal, localized, ngettext
from text.plain import plain
from tui.frame import title
from tui.topics.actions import show_housekeeping
from tui.topics.table import age_text, bandwidth_text, hz_text
from tui.widgets.figures import count_text, seconds_text
from tui.widgets.trouble import names, no_data_words

if TYPE_CHECKING:
    from tui.frame.host import Host

KILO = 1000
BETWEEN = " · "
LONGEST = 200
OURSELVES = "Deck"


def figures(row: TopicRow, size_bytes: int | None) -> list[str]:
    """Rate, bandwidth, age, jitter, latency, losses and size, or why there are none."""
    if row.pictures_from:
        parts = [_("pictures from {topic}").format(topic=plain(row.pictures_from, LONGEST))]
    elif not row.measured:
        parts = [_("not measured: Deck is not subscribed")]
    elif row.trouble is Trouble.QUIET and row.age_s is not None:
        parts = [no_data_words(row.age_s)]
    elif row.hz is None:
        parts = [_("no rate yet: it takes two messages")] if row.trouble is None else []
    else:
        parts = [
            f"{hz_text(row.hz)} {_('Hz')}",
            bandwidth_text(row.bytes_per_s),
            _("age {time}").format(time=age_text(row.age_s)),
            _("jitter {time}").format(time=seconds_text(row.jitter_s)),
            _("latency {time}").format(time=seconds_text(row.latency_s)),
            _("lost {n}").format(n=count_text(row.lost)),
        ]
    if size_bytes is not None:
        parts.append(_("{size} a message").format(size=size_text(size_bytes)))
    return parts


def packed(parts: Sequence[str], width: int) -> list[str]:
    """The parts in lines of at most `width` cells, each line as full as possible."""
    lines: list[str] = []
    for part in parts:
        if lines and cell_len(lines[-1]) + len(BETWEEN) + cell_len(part) <= width:
            lines[-1] += BETWEEN + part
        else:
            lines.append(part)
    return lines


def size_text(size_bytes: int) -> str:
    """A size with three significant digits and its unit."""
    if size_bytes < KILO:
        return _("{n} B").format(n=size_bytes)
    if size_bytes < KILO * KILO:
        return _("{n} kB").format(n=decimal(f"{size_bytes / KILO:.1f}"))
    return _("{n} MB").format(n=decimal(f"{size_bytes / KILO / KILO:.1f}"))


def ends(row: TopicRow) -> str:
    """Who publishes and who subscribes, by name where known."""
    publishers = names(row.published_by, counted=True)
    if not publishers and (row.publishers or not row.own_publishers):
        publishers = ngettext("{n} publisher", "{n} publishers", row.publishers).format(n=row.publishers)
    if row.own_publishers:
        publishers = f"{publishers}, {OURSELVES}" if publishers else OURSELVES
    subscribers = names(row.subscribed_by, counted=True) or ngettext(
        "{n} subscriber", "{n} subscribers", row.subscribers
    ).format(n=row.subscribers)
    return f"{publishers} → {subscribers}"


def why_empty(deck: Host, listed: Sequence[TopicRow]) -> tuple[str, str]:
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
