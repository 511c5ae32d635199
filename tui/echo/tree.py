"""The newest message of a topic as a folding tree that keeps its layout while values change.

A line is redrawn from the first character that has changed.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.binding import Binding, BindingType
from textual.events import Click
from textual.geometry import Region
from textual.message import Message
from textual.strip import Strip

from graph.data import Value
from tui.echo.lines import EchoLine, Path, echo_lines
from tui.widgets.rows import Cell, Column, Row, Rows
from tui.widgets.words import cut, word_strips

OPEN, CLOSED, LEAF = "▾ ", "▸ ", "  "
INDENT = 2


class EchoTree(Rows):
    """Shows a message as a tree, or words where there is none.

    The folding belongs to the topic and outlives single messages. While the tree is paused it keeps
    showing the same message.
    """

    class PauseChanged(Message):
        """The tree was paused or resumed."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        f"echo-tree--{name}" for name in ("key", "number", "text", "bytes", "note", "mark", "cursor")
    }
    DEFAULT_CSS = """
    EchoTree {
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
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("right,l", "unfold", show=False),
        Binding("left,h", "fold", show=False),
    ]

    def __init__(self) -> None:
        super().__init__(header=False)
        self._topic = ""
        self.message: Mapping[str, Value] | None = None
        self._waiting: Mapping[str, Value] | None = None
        """The newest message that came while it was paused."""
        self.paused = False
        """Whether newer messages are held back."""
        self._folds: dict[str, dict[Path, bool]] = {}
        self._lines: list[EchoLine] = []
        self._marks: Mapping[Path, str] = {}
        """Letters after the keys of lines, by path."""
        self._words = ("", "")

    def show_message(self, topic: str, message: Mapping[str, Value]) -> None:
        """Show a message of a topic; a different topic ends a pause."""
        if topic != self._topic:
            self._begin(topic)
        if self.paused and self.message is not None:
            self._waiting = message
            return
        self._words = ("", "")
        self.message = message
        self._flatten()

    def show_words(self, topic: str, headline: str, detail: str = "") -> None:
        if topic != self._topic:
            self._begin(topic)
        elif (headline, detail) == self._words and self.message is None:
            return
        self.message, self._lines = None, []
        self._words = (headline, detail)
        self.show([Column("")], ())
        self.refresh()

    def pause(self, paused: bool) -> None:
        if paused == self.paused:
            return
        self.paused = paused
        if not paused and self._waiting is not None:
            self.message, self._waiting = self._waiting, None
            self._flatten()
        self.post_message(self.PauseChanged())

    @property
    def _line(self) -> EchoLine | None:
        """The line at the cursor."""
        index = self._index(self.chosen)
        return None if index is None else self._lines[index]

    @property
    def at_cursor(self) -> Path | None:
        return None if self._line is None else self._line.path

    def mark(self, marks: Mapping[Path, str]) -> None:
        """Show these letters after the keys of the lines at these paths."""
        if marks != self._marks:
            self._marks = dict(marks)
            self.refresh()

    def on_language_changed(self) -> None:
        self._flatten()
        self.refresh()

    def action_open(self) -> None:
        """Fold or unfold the branch at the cursor."""
        line = self._line
        if line is not None and line.open is not None:
            self._set_open(line.path, not line.open)

    def action_unfold(self) -> None:
        """Unfold the branch at the cursor, or enter it."""
        line = self._line
        if line is not None and line.open is False:
            self._set_open(line.path, True)
        elif line is not None and line.open:
            self.action_move(1)

    def action_fold(self) -> None:
        """Fold the branch at the cursor, or go to its parent."""
        line = self._line
        if line is not None and line.open:
            self._set_open(line.path, False)
        elif line is not None:
            self.choose(_key(line.path[:-1]))

    def on_click(self, event: Click) -> None:
        index = event.y + self.scroll_offset.y
        event.prevent_default()
        if index < len(self._lines) and self._rows[index].key:
            self._choose(index)
            self.action_open()

    def on_rows_highlighted(self, event: Rows.Highlighted) -> None:
        """Keep it to itself: to move here chooses nothing."""
        event.stop()

    def _begin(self, topic: str) -> None:
        self._topic = topic
        self.message = self._waiting = None
        # The rows stay until others are shown: by them it is known how many there were.
        self._lines, self.chosen = [], ""
        self.pause(False)
        self.scroll_to(0, 0, animate=False, immediate=True)

    def _flatten(self) -> None:
        if self.message is not None:
            self._lines = echo_lines(self.message, self._folds.setdefault(self._topic, {}).get)
            texts = (f"{_margin(line)}{line.label} {line.text}" for line in self._lines)
            rows = [Row(_key(line.path), (Cell(text),)) for line, text in zip(self._lines, texts, strict=True)]
            self.show([Column("")], rows, near=self._index(self.chosen) or 0)

    def _set_open(self, path: Path, opened: bool) -> None:
        self._folds.setdefault(self._topic, {})[path] = opened
        self._flatten()

    # Drawing

    def render_line(self, y: int) -> Strip:
        width = self.scrollable_size.width
        if not self._lines:
            strips = word_strips(self._words, width, self.rich_style, self.app.console)
            return strips[y] if y < len(strips) else Strip.blank(width, self.rich_style)
        index = y + self.scroll_offset.y
        if index >= len(self._lines):
            return Strip.blank(width, self.rich_style)
        segments = self._segments(self._lines[index])
        if self.chosen and self._rows[index].key == self.chosen and self.has_focus:
            cursor = self.get_component_rich_style("echo-tree--cursor")
            return cut([Segment(text, cursor) for text, _, _ in segments], width, cursor)
        return cut(segments, width, self.rich_style)

    def _refresh_changed(self, before: tuple[Row, ...]) -> None:
        """Redraw each line in sight from the first character that has changed."""
        top, width = self.scroll_offset.y, self.scrollable_size.width
        for index in range(top, min(top + self.size.height, len(self._rows), len(before))):
            old, new = before[index].cells[0].text, self._rows[index].cells[0].text
            same = 0 if before[index].key != self._rows[index].key else _same_cells(old, new)
            if old != new and same < width:
                self.refresh(Region(same, index - top, width - same, 1))

    def _segments(self, line: EchoLine) -> list[Segment]:
        def part(name: str) -> Style:
            return base + self.get_component_rich_style(f"echo-tree--{name}", partial=True)

        base = self.rich_style
        return [
            Segment(_margin(line), base),
            Segment(f"{line.label} " if line.label else "", part("key")),
            Segment(line.text, part("note" if line.kind == "branch" else line.kind)),
            Segment(f"  ◂ {self._marks[line.path]}" if line.path in self._marks else "", part("mark")),
        ]


def _key(path: Path) -> str:
    return "\0".join(map(str, path))


def _same_cells(before: str, after: str) -> int:
    """Number of cells that are equal at the start of two lines."""
    for index, (old, new) in enumerate(zip(before, after, strict=False)):
        if old != new:
            return cell_len(after[:index])
    return cell_len(after[: len(before)])


def _margin(line: EchoLine) -> str:
    mark = LEAF if line.open is None else OPEN if line.open else CLOSED
    return " " * (INDENT * line.depth) + mark
