"""The lines of a message's tree on the screen: drawn from the first character that changed."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.cells import cell_len
from rich.segment import Segment
from textual.geometry import Region
from textual.scroll_view import ScrollView
from textual.strip import Strip

from tui.widgets.one_style import OneStyle
from tui.widgets.words import cut, word_strips

if TYPE_CHECKING:
    from collections.abc import Mapping

    from tui.topics.echo_lines import EchoLine, Path

OPEN, CLOSED, LEAF = "▾ ", "▸ ", "  "
INDENT = 2


class EchoRows(OneStyle, ScrollView, can_focus=True):
    """Draws `_lines`, or `_words` while there are none."""

    ALLOW_SELECT = False
    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "echo-tree--key",
        "echo-tree--number",
        "echo-tree--text",
        "echo-tree--bytes",
        "echo-tree--note",
        "echo-tree--mark",
        "echo-tree--cursor",
    }
    DEFAULT_CSS = """
    EchoRows {
        width: 1fr; height: 1fr; overflow-x: hidden; scrollbar-size-vertical: 1;
        &> .echo-tree--key { color: $text-primary; }
        &> .echo-tree--text { color: $text-success; }
        &> .echo-tree--bytes { color: $text-warning; }
        &> .echo-tree--note { color: $foreground; text-style: italic dim; }
        &> .echo-tree--mark { color: $text-accent; text-style: bold; }
        &> .echo-tree--cursor {
            color: $block-cursor-foreground; background: $block-cursor-background;
        }
    }
    """

    def __init__(self, *, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._lines: list[EchoLine] = []
        self._cursor = 0
        self._words = ("", "")
        self._marks: Mapping[Path, str] = {}
        """Letters behind the keys of lines, by their paths."""

    def render_line(self, y: int) -> Strip:
        """One line of the tree, or of the words."""
        width = self.scrollable_size.width
        if not self._lines:
            strips = word_strips(self._words, width, self.rich_style, self.app.console)
            return strips[y] if y < len(strips) else Strip.blank(width, self.rich_style)
        index = y + self.scroll_offset.y
        if index >= len(self._lines):
            return Strip.blank(width, self.rich_style)
        line = self._lines[index]
        segments = self._segments(line)
        if index == self._cursor and self.has_focus:
            cursor = self.get_component_rich_style("echo-tree--cursor")
            return cut([Segment(text, cursor) for text, _, _ in segments], width, cursor)
        return cut(segments, width, self.rich_style)

    def on_resize(self) -> None:
        """Draw again at the new width."""
        self.refresh()

    def on_focus(self) -> None:
        """Draw the cursor as that of the focused widget."""
        self.refresh_line(self._cursor)

    def on_blur(self) -> None:
        """Draw the cursor as that of a widget in the background."""
        self.refresh_line(self._cursor)

    def _refresh_difference(self, index: int, before: EchoLine, after: EchoLine) -> None:
        if before is after or before == after:
            return
        same = _same_cells(_line_text(before), _line_text(after))
        width = self.scrollable_size.width
        if same < width:
            self.refresh(Region(same, index - self.scroll_offset.y, width - same, 1))

    def _segments(self, line: EchoLine) -> list[Segment]:
        base = self.rich_style
        key = base + self.get_component_rich_style("echo-tree--key", partial=True)
        kind = base
        if line.kind not in ("branch", "number"):
            kind = base + self.get_component_rich_style(f"echo-tree--{line.kind}", partial=True)
        elif line.kind == "branch":
            kind = base + self.get_component_rich_style("echo-tree--note", partial=True)
        mark = base + self.get_component_rich_style("echo-tree--mark", partial=True)
        return [
            Segment(_margin(line), base),
            Segment(f"{line.label} " if line.label else "", key),
            Segment(line.text, kind),
            Segment(f"  ◂ {self._marks[line.path]}" if line.path in self._marks else "", mark),
        ]


def _same_cells(before: str, after: str) -> int:
    """Cells at the beginning that two lines have in common."""
    for index, (old, new) in enumerate(zip(before, after, strict=False)):
        if old != new:
            return cell_len(after[:index])
    return cell_len(after[: len(before)])


def _margin(line: EchoLine) -> str:
    mark = LEAF if line.open is None else OPEN if line.open else CLOSED
    return " " * (INDENT * line.depth) + mark


def _line_text(line: EchoLine) -> str:
    return f"{_margin(line)}{line.label} {line.text}" if line.label else _margin(line) + line.text
