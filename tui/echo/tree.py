"""The newest message of a topic as a folding tree that keeps its layout while values change.

A line is redrawn from the first character that has changed.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, ClassVar

from rich.cells import cell_len
from rich.segment import Segment
from textual.binding import Binding, BindingType
from textual.events import Click
from textual.geometry import Region, Size
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.strip import Strip

from tui.echo.lines import EchoLine, Path, echo_lines
from tui.widgets.one_style import OneStyle
from tui.widgets.words import cut, word_strips

if TYPE_CHECKING:
    from graph.data import Value

HUGE_JUMP = 1_000_000
OPEN, CLOSED, LEAF = "▾ ", "▸ ", "  "
INDENT = 2


class EchoTree(OneStyle, ScrollView, can_focus=True):
    """Shows a message as a tree, or words where there is none.

    The folding belongs to the topic and outlives single messages. While the tree is paused it keeps
    showing the same message.
    """

    class PauseChanged(Message):
        """The tree was paused or resumed."""

        def __init__(self, paused: bool) -> None:
            super().__init__()
            self.paused = paused

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
    EchoTree {
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

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k", "move(-1)", show=False),
        Binding("down,j", "move(1)", show=False),
        Binding("pageup", "page(-1)", show=False),
        Binding("pagedown", "page(1)", show=False),
        Binding("home", f"move(-{HUGE_JUMP})", show=False),
        Binding("end", f"move({HUGE_JUMP})", show=False),
        Binding("enter", "toggle_fold", show=False),
        Binding("right,l", "unfold", show=False),
        Binding("left,h", "fold", show=False),
    ]

    def __init__(self) -> None:
        super().__init__()
        self._topic = ""
        self._message: Mapping[str, Value] | None = None
        self._waiting: Mapping[str, Value] | None = None
        """The newest message that came while it was paused."""
        self._paused = False
        self._folds: dict[str, dict[Path, bool]] = {}
        self._lines: list[EchoLine] = []
        self._cursor = 0
        self._marks: Mapping[Path, str] = {}
        """Letters after the keys of lines, by path."""
        self._words = ("", "")
        """Why there is no message."""

    def show(self, topic: str, message: Mapping[str, Value]) -> None:
        """Show a message of a topic; a different topic ends a pause."""
        if topic != self._topic:
            self._begin(topic)
        if self._paused and self._message is not None:
            self._waiting = message
            return
        self._words = ("", "")
        self._message = message
        self._flatten()

    def show_words(self, topic: str, headline: str, detail: str = "") -> None:
        if topic != self._topic:
            self._begin(topic)
        elif (headline, detail) == self._words and self._message is None:
            return
        self._message, self._lines, self._cursor = None, [], 0
        self._words = (headline, detail)
        self.virtual_size = Size(0, 0)
        self.refresh()

    @property
    def message(self) -> Mapping[str, Value] | None:
        return self._message

    @property
    def paused(self) -> bool:
        """Whether newer messages are held back."""
        return self._paused

    def pause(self, paused: bool) -> None:
        if paused == self._paused:
            return
        self._paused = paused
        if not paused and self._waiting is not None:
            self._message, self._waiting = self._waiting, None
            self._flatten()
        self.post_message(self.PauseChanged(paused))

    @property
    def at_cursor(self) -> Path | None:
        line = self._line_at(self._cursor)
        return None if line is None else line.path

    def mark(self, marks: Mapping[Path, str]) -> None:
        """Show these letters after the keys of the lines at these paths."""
        if marks != self._marks:
            self._marks = dict(marks)
            self.refresh()

    def on_language_changed(self) -> None:
        self._flatten()
        self.refresh()

    def action_move(self, by: int) -> None:
        self._move_to(self._cursor + by)

    def action_page(self, pages: int) -> None:
        self._move_to(self._cursor + pages * max(1, self.size.height - 1))

    def action_toggle_fold(self) -> None:
        line = self._line_at(self._cursor)
        if line is not None and line.open is not None:
            self._set_open(line.path, not line.open)

    def action_unfold(self) -> None:
        line = self._line_at(self._cursor)
        if line is not None and line.open is False:
            self._set_open(line.path, True)
        elif line is not None and line.open:
            self.action_move(1)

    def action_fold(self) -> None:
        """Fold the branch at the cursor, or go to its parent."""
        line = self._line_at(self._cursor)
        if line is None:
            return
        if line.open:
            self._set_open(line.path, False)
            return
        parents = [i for i, other in enumerate(self._lines) if other.path == line.path[:-1]]
        if parents:
            self._move_to(parents[0])

    def on_click(self, event: Click) -> None:
        index = event.y + self.scroll_offset.y
        if self._line_at(index) is not None:
            self._move_to(index)
            self.action_toggle_fold()

    def _begin(self, topic: str) -> None:
        self._topic = topic
        self._message = self._waiting = None
        self._lines, self._cursor = [], 0
        self.pause(False)
        self.scroll_to(0, 0, animate=False, immediate=True)

    def _flatten(self) -> None:
        if self._message is None:
            return
        folds = self._folds.setdefault(self._topic, {})
        before = self._lines
        at = before[self._cursor].path if self._cursor < len(before) else None
        self._lines = echo_lines(self._message, folds.get)
        if len(before) != len(self._lines):
            self.virtual_size = Size(0, len(self._lines))
            self._cursor = self._find(at)
            self.refresh()
            return
        top = self.scroll_offset.y
        for index in range(top, min(top + self.size.height, len(self._lines))):
            self._refresh_difference(index, before[index], self._lines[index])

    def _find(self, path: Path | None) -> int:
        for index, line in enumerate(self._lines):
            if line.path == path:
                return index
        return max(0, min(self._cursor, len(self._lines) - 1))

    def _line_at(self, index: int) -> EchoLine | None:
        return self._lines[index] if 0 <= index < len(self._lines) else None

    def _set_open(self, path: Path, opened: bool) -> None:
        self._folds.setdefault(self._topic, {})[path] = opened
        self._flatten()

    def _move_to(self, index: int) -> None:
        index = max(0, min(index, len(self._lines) - 1))
        if index != self._cursor:
            self.refresh_line(self._cursor)
            self._cursor = index
            self.refresh_line(index)
        self.scroll_to_region(Region(0, index, 1, 1), animate=False, immediate=True)

    # Drawing

    def render_line(self, y: int) -> Strip:
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
        self.refresh()

    def on_focus(self) -> None:
        self.refresh_line(self._cursor)

    def on_blur(self) -> None:
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
    """Number of cells that are equal at the start of two lines."""
    for index, (old, new) in enumerate(zip(before, after, strict=False)):
        if old != new:
            return cell_len(after[:index])
    return cell_len(after[: len(before)])


def _margin(line: EchoLine) -> str:
    mark = LEAF if line.open is None else OPEN if line.open else CLOSED
    return " " * (INDENT * line.depth) + mark


def _line_text(line: EchoLine) -> str:
    return f"{_margin(line)}{line.label} {line.text}" if line.label else _margin(line) + line.text
