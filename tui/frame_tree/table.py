"""The tree of frames as rows: how each is indented, how often it comes, how old it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import _
from tui.frame_tree import cells
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from space.tree.tree import TreeLine

STATE, AGE = 11, 7
NARROW, WIDE = 18, 30
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

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Leave Enter to the screen, whose footer says what it does."""
        return False if action == "open" else super().check_action(action, parameters)

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
    is_wrong = line.frame in wrong
    marks = (" ◎" if line.frame == relative_to else "") + (" !" if is_wrong else "")
    return Row(
        key_of(line),
        (
            Cell(cells.name(line) + marks, "warn" if is_wrong else ""),
            Cell(*cells.state(line)),
            Cell(*cells.age(line)),
            Cell(*cells.publisher(line)),
        ),
    )
