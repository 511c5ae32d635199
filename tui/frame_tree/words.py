"""What the Frames screen says in lines: where one frame is in another, what is wrong, and why there is no frame."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rich.cells import cell_len

from graph.data import FrameRow, GraphUpdate, Trouble
from graph.findings.finding import GraphFinding
from graph.frames.book import FRAME_TOPICS
from graph.frames.findings import by_whom
from space.buffer import NoTransformError, TransformBuffer
from space.transform import Transform
from text import ros2_words
from text.i18n import _, decimal, localized, ngettext
from text.plain import plain
from text.ros_names import TF, TF_STATIC
from text.sentences import reason_of
from tui.frame import title
from tui.frame.host import Host
from tui.widgets.trouble import advice

if TYPE_CHECKING:
    from graph.frames.tree import TreeLine


LONGEST = 60
METRES, QUATERNION, DEGREES = 8, 7, 6
"""Cells of a number: -999.999, -0.7071, -180.0."""


@dataclass(frozen=True)
class FramePair:
    """A frame, the one that it is given in, and where it is."""

    source: str
    target: str
    transform: Transform | None = None
    """None if nothing is known of it."""
    remark: str = ""
    """Why it is not known, or for which time it is; a sentence."""


class FramePairs:
    """Answers where one frame is in another, from the newest transforms of all."""

    def __init__(self) -> None:
        self._buffer = TransformBuffer()
        self._newest = TransformBuffer()

    def clear(self) -> None:
        self._buffer.clear()
        self._newest.clear()

    def take(self, rows: Sequence[FrameRow]) -> None:
        good = [row.newest for row in rows if row.count > row.faults]
        self._buffer.add(good)
        self._newest.clear()
        # As if all were of one time: what is shown while they have no time in common.
        self._newest.add(type(one)(one.parent, one.child, one.stamp_s, one.transform, static=True) for one in good)

    def find(self, target: str, source: str) -> FramePair:
        try:
            return FramePair(source, target, self._buffer.find(target, source))
        except NoTransformError as error:
            remark = reason_of(error)
        try:
            return FramePair(source, target, self._newest.find(target, source), remark)
        except NoTransformError:
            return FramePair(source, target, None, remark)


def publisher_line(heard: Sequence[FrameRow]) -> str:
    """Return who publishes a frame, or may do so, with the whole names."""
    gone = next((one.gone for one in heard if one.gone), "")
    if gone and not any(one.publishers for one in heard):
        return _("published by {node}, which has gone").format(node=localized(gone))
    return _("published by {nodes}").format(nodes=localized(by_whom(heard)))


def pair_lines(pair: FramePair, room: int) -> list[str]:
    """Return what is shown of it: the two names, metres, the quaternion, degrees, a remark.

    Numbers that do not fit beside their name in `room` cells have a line of their own. A line is as
    long for all frames of a robot, so that nothing below jumps while it moves.
    """
    head = _("{source} in {target}").format(source=plain(pair.source, LONGEST), target=plain(pair.target, LONGEST))
    if pair.transform is None:
        return [head, localized(pair.remark)]
    if pair.source == pair.target:
        return [head, _("Enter on another frame shows this one, and all others, relative to it.")]
    moved, turned, rpy = _numbers(pair.transform)
    lines = [
        head,
        *_named(_("x, y, z, m:"), moved, METRES, room),
        *_named(_("quaternion:"), turned, QUATERNION, room),
        *_named(_("roll, pitch, yaw, °:"), rpy, DEGREES, room),
    ]
    if pair.remark:
        lines.append(_("the newest of each: {reason}").format(reason=localized(pair.remark)))
    return lines


def pair_text(pair: FramePair) -> str:
    """Return it as text to be pasted: with points in numbers, whatever the language."""
    if pair.transform is None:
        return ""
    moved, turned, rpy = map("  ".join, _numbers(pair.transform))
    command = ros2_words.static_transform(
        pair.target, pair.source, pair.transform.translation, pair.transform.rotation
    )
    return (
        f"{plain(pair.source)} in {plain(pair.target)}\n"
        f"translation x, y, z [m]: {moved}\n"
        f"rotation x, y, z, w: {turned}\n"
        f"roll, pitch, yaw [deg]: {rpy}\n"
        f"{plain(command)}\n"
    )


def _named(name: str, numbers: Sequence[str], width: int, room: int) -> list[str]:
    texts = " ".join(decimal(number).rjust(width) for number in numbers)
    line = f"{name} {texts}"
    return [line] if cell_len(line) <= room else [name, f" {texts}"]


def _numbers(transform: Transform) -> tuple[tuple[str, ...], ...]:
    return (
        tuple(f"{_positive(number, 3):.3f}" for number in transform.translation),
        tuple(f"{_positive(number, 4):.4f}" for number in transform.rotation),
        tuple(f"{_positive(math.degrees(angle), 1):.1f}" for angle in transform.rpy_rad),
    )


def _positive(number: float, digits: int) -> float:
    """Return the number, but 0 in place of what would be written as -0."""
    return round(number, digits) + 0.0


NARROWEST = 16
SHOWN = 30
"""Findings that are written out; the others are counted."""


def fits(line: TreeLine, parts: Sequence[str]) -> bool:
    heard = (node for one in line.heard for node in (*one.publishers, one.gone))
    text = " ".join((line.frame, *heard)).casefold()
    return all(part in text for part in parts)


def finding_lines(findings: Sequence[GraphFinding], frame: str, width: int) -> list[tuple[str, str]]:
    """Return what is wrong, line by line, each with its meaning; what is about `frame` first."""
    if not findings:
        return [(_("✓ nothing is wrong with the frames"), "good")]
    count = len(findings)
    lines = [(ngettext("{n} finding", "{n} findings", count).format(n=count), "bad")]
    for one in sorted(findings, key=lambda one: frame not in one.nodes)[:SHOWN]:
        lines += [(line, "bad") for line in _wrapped("✗ ", localized(one.what), width)]
        lines += [(line, "") for line in _wrapped("  → ", localized(one.mend), width)]
    if count > SHOWN:
        lines.append((_("… and {n} more").format(n=count - SHOWN), ""))
    return lines


def _wrapped(mark: str, text: str, width: int) -> list[str]:
    indent = " " * len(mark)
    room = max(NARROWEST, width)
    return textwrap.wrap(text, room, initial_indent=mark, subsequent_indent=indent)


def why_no_frames(deck: Host, update: GraphUpdate | None) -> tuple[str, str]:
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
