"""What the Frames screen says: what is wrong, and why there is no frame."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

from graph.data import GraphUpdate, Trouble
from graph.frames.book import FRAME_TOPICS
from text.i18n import _, localized, ngettext
from text.plain import plain
from text.ros_names import TF, TF_STATIC
from tui.frame import title
from tui.widgets.trouble import advice

if TYPE_CHECKING:
    from graph.frames.findings import FrameFinding
    from graph.frames.tree import TreeLine
    from tui.frame.host import Host

NARROWEST = 16
SHOWN = 30
"""Findings that are written out; the others are counted."""


def fits(line: TreeLine, parts: Sequence[str]) -> bool:
    """Return whether frame or publishers contain all parts, which are in small letters."""
    heard = (node for one in line.heard for node in (*one.publishers, one.gone))
    text = " ".join((line.frame, *heard)).casefold()
    return all(part in text for part in parts)


def finding_lines(findings: Sequence[FrameFinding], frame: str, width: int) -> list[tuple[str, str]]:
    """Return what is wrong, line by line, each with its meaning; what is about `frame` first."""
    if not findings:
        return [(_("✓ nothing is wrong with the frames"), "good")]
    count = len(findings)
    lines = [(ngettext("{n} finding", "{n} findings", count).format(n=count), "bad")]
    for one in sorted(findings, key=lambda one: frame not in one.frames)[:SHOWN]:
        lines += [(line, "bad") for line in _wrapped("✗ ", localized(one.text), width)]
        lines += [(line, "") for line in _wrapped("  → ", localized(one.advice), width)]
    if count > SHOWN:
        lines.append((_("… and {n} more").format(n=count - SHOWN), ""))
    return lines


def _wrapped(mark: str, text: str, width: int) -> list[str]:
    indent = " " * len(mark)
    room = max(NARROWEST, width)
    return textwrap.wrap(text, room, initial_indent=mark, subsequent_indent=indent)


def why_no_frames(deck: Host, update: GraphUpdate | None) -> tuple[str, str]:
    """Return headline and detail for a screen without any frame."""
    if not deck.feed.opened:
        return _("no lesson is running"), ""
    if update is None or title.starting(deck):
        return _("no frames yet"), _("Nodes are starting.") if title.starting(deck) else ""
    if update.error:
        return deck.feed.blind, localized(update.error)
    return _why_none_come(deck, update)


def _why_none_come(deck: Host, update: GraphUpdate) -> tuple[str, str]:
    for row in update.topics:
        if row.name in FRAME_TOPICS and row.trouble not in {None, Trouble.NO_PUBLISHER}:
            headline, detail = advice(row)
            return f"{row.name}: {headline}", plain(detail)
    if deck.feed.replay is not None:
        return _("no frames in this recording so far"), _(
            "It has no message on {moving} or {static} up to here."
        ).format(moving=TF, static=TF_STATIC)
    return _("no frames"), _(
        "Nobody publishes {moving} or {static}. Lesson 5 shows how: deck run 05-tf2. A robot that "
        "has a URDF gets its frames from robot_state_publisher."
    ).format(moving=TF, static=TF_STATIC)
