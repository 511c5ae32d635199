"""What is said of a frame in its row, as texts with their meaning; the command line says it too."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.data import FrameRow
from graph.frames.findings import is_stale
from text.figures import elapsed, figure
from text.i18n import _, localized
from text.plain import plain

if TYPE_CHECKING:
    from graph.frames.tree import TreeLine

LONGEST = 120
DEEPEST = 24
"""Cells for the lines that lead to a frame; deeper ones begin with `…`."""
FRESH_S = 1.0

Words = tuple[str, str]
"""A text and its meaning: `good`, `warn`, `bad`, `dim` or none."""


def heard_of(line: TreeLine) -> FrameRow | None:
    """Return what was heard of it; None for a root.

    Of two topics it is the one that moves: what is fixed has neither rate nor age worth a look.
    """
    return line.heard[0] if line.heard else None


def name(line: TreeLine) -> str:
    branch = line.branch
    shown = branch if len(branch) <= DEEPEST else f"…{branch[-DEEPEST:]}"
    return f"{shown}{plain(line.frame, LONGEST)}"


def state(line: TreeLine) -> Words:
    """Return how it comes, in a word or as a rate; what is wrong stands first."""
    if line.again:
        return _("↑ see above"), "dim"
    heard = heard_of(line)
    if heard is None:
        return _("root"), "dim"
    if heard.count == heard.faults:
        return _("✗ refused"), "bad"
    if is_stale(heard):
        return _("✗ stale"), "bad"
    return _("static") if heard.is_static else _rate(heard.hz), ""


def age(line: TreeLine) -> Words:
    heard = heard_of(line)
    if heard is None:
        return "", ""
    # A number that changes with every look would be sent to the terminal for every frame.
    if heard.age_s < FRESH_S:
        return _("< 1 s"), ""
    words = _("{n} s").format(n=elapsed(min(heard.age_s, 99_999.0)))
    return words, "bad" if is_stale(heard) else "dim"


def publisher(line: TreeLine) -> Words:
    """Return who publishes it; with a ? if it may also be one of several others."""
    heard = heard_of(line)
    if heard is None:
        return "", ""
    if not heard.publishers:
        return _("gone"), "bad" if heard.age_s > FRESH_S else "dim"
    first, *others = (localized(node).removeprefix("/") for node in heard.publishers)
    if not others:
        return first, ""
    if set(others) == {first}:
        return f"{first} ×{len(others) + 1}", ""
    return f"{first}{'' if heard.certain else '?'} +{len(others)}", ""


def _rate(hz: float | None) -> str:
    return _("once") if hz is None else _("{n} Hz").format(n=figure(hz, 0 if hz >= 9.95 else 1))
