"""The tree of frames as rows: how each is indented, how often it comes, how old it is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from text.i18n import _
from tui.frame_tree import cells
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from graph.frames.tree import TreeLine

STATE, AGE = 11, 7
NARROW, WIDE = 18, 30
"""Width of the publisher."""
BETWEEN = "\0"
"""Between parent and frame in the key of a row: in no name."""


def key_of(line: TreeLine) -> str:
    return f"{line.parent}{BETWEEN}{line.frame}"


def frame_of(key: str) -> str:
    return key.partition(BETWEEN)[2]


class FrameTable(Rows):
    """One row for each frame below each of its parents."""

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Leave Enter to the screen, whose footer says what it does."""
        return False if action == "open" else super().check_action(action, parameters)

    def show_tree(self, lines: Sequence[TreeLine], looks: Mapping[str, str], relative_to: str, *, wide: bool) -> None:
        """Show the tree; one frame has been marked, `looks` are `warn`, `dim` or none for each."""
        columns = [
            Column(_("frame")),
            Column(_("rate"), STATE, right=True),
            Column(_("age"), AGE, right=True),
            Column(_("publisher"), WIDE if wide else NARROW),
        ]
        rows = [_row(line, looks.get(line.frame, ""), relative_to) for line in lines]
        self.show(columns, rows or [Row("", (Cell(_("nothing matches the filter"), "dim"),))])


def _row(line: TreeLine, look: str, relative_to: str) -> Row:
    marks = (" ◎" if line.frame == relative_to else "") + (" !" if look == "warn" else "")
    return Row(
        key_of(line),
        (
            Cell(cells.name(line) + marks, look),
            Cell(*cells.state(line)),
            Cell(*cells.age(line)),
            Cell(*cells.publisher(line)),
        ),
    )
