"""The tree of frames as rows: how each is indented, how often it comes, how old it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from space.tree.heard import is_stale
from text.figures import elapsed, figure
from text.i18n import _, localized
from text.plain import plain
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from space.tree.heard import HeardFrame
    from space.tree.tree import TreeLine

LONGEST = 120
DEEPEST = 24
"""Cells for the lines that lead to a frame; deeper ones begin with `…`."""
FRESH_S = 1.0
STATE, AGE = 12, 7
NARROW, WIDE = 22, 30
"""Width of the publisher."""
BETWEEN = "\0"
"""Between parent and frame in the key of a row: in no name."""


def key_of(line: TreeLine) -> str:
    """Return the key of its row."""
    return f"{line.parent}{BETWEEN}{line.frame}"


def frame_of(key: str) -> str:
    """Return the frame whose row has this key."""
    return key.partition(BETWEEN)[2]


class FrameTable(Rows):
    """One row for each frame below each of its parents."""

    def show_tree(
        self, lines: Sequence[TreeLine], wrong: Collection[str], relative_to: str, *, wide: bool
    ) -> None:
        """Show the tree; `wrong` are frames that a finding is about, one has been marked."""
        columns = [
            Column(_("frame")),
            Column(_("rate"), STATE, right=True),
            Column(_("age"), AGE, right=True),
            Column(_("publisher"), WIDE if wide else NARROW),
        ]
        self.show(columns, [_row(line, wrong, relative_to) for line in lines])


def _row(line: TreeLine, wrong: Collection[str], relative_to: str) -> Row:
    # Of two topics the one that moves: what is fixed has neither rate nor age worth a look.
    heard = line.heard[0] if line.heard else None
    name = f"{_indented(line.branch)}{plain(line.frame, LONGEST)}"
    if line.frame == relative_to:
        name += " ◎"
    if line.frame in wrong:
        name += " !"
    cells = (
        Cell(name, "warn" if line.frame in wrong else ""),
        _state(line, heard),
        _age(heard),
        _publisher(heard),
    )
    return Row(key_of(line), cells)


def _indented(branch: str) -> str:
    return branch if len(branch) <= DEEPEST else f"…{branch[-DEEPEST:]}"


def _state(line: TreeLine, heard: HeardFrame | None) -> Cell:
    """Return how it comes, in a word or as a rate; what is wrong stands first."""
    if line.again:
        return Cell(_("↑ see above"), "dim")
    if heard is None:
        return Cell(_("root"), "dim")
    if heard.count == heard.faults:
        return Cell(_("✗ refused"), "bad")
    if is_stale(heard):
        return Cell(_("✗ stale"), "bad")
    return Cell(_("static") if heard.is_static else _rate(heard.hz))


def _rate(hz: float | None) -> str:
    return _("once") if hz is None else _("{n} Hz").format(n=figure(hz, 0 if hz >= 9.95 else 1))


def _age(heard: HeardFrame | None) -> Cell:
    if heard is None:
        return Cell("")
    # A number that changes with every look would be sent to the terminal for every frame.
    if heard.age_s < FRESH_S:
        return Cell(_("< 1 s"))
    words = _("{n} s").format(n=elapsed(min(heard.age_s, 99_999.0)))
    return Cell(words, "bad" if is_stale(heard) else "dim")


def _publisher(heard: HeardFrame | None) -> Cell:
    if heard is None:
        return Cell("")
    if not heard.publishers:
        return Cell(_("gone"), "bad" if heard.age_s > FRESH_S else "dim")
    first, *others = (localized(node).removeprefix("/") for node in heard.publishers)
    # Which of several it is, nobody says.
    return Cell(f"{first}? +{len(others)}" if others else first)
