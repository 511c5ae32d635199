"""A page of text: headings, paragraphs, and entries with a column of their own on the left."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, NamedTuple

from rich.cells import cell_len
from rich.segment import Segment
from textual.geometry import Size
from textual.scroll_view import ScrollView
from textual.strip import Strip

LEFT = 14
"""Cells of the left column."""
WIDEST = 110
"""Longer lines are hard to read."""


class PageEntry(NamedTuple):
    """A paragraph, beside its `left` if there is one; a `name` starts it in bold.

    A name without a text is a heading.
    """

    text: str = ""
    name: str = ""
    left: str = ""


class Page(ScrollView, can_focus=True):
    """Shows entries, wrapped to its width."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"page--heading", "page--name", "page--text"}
    DEFAULT_CSS = """
    Page {
        width: 1fr; height: 1fr; overflow-x: hidden; scrollbar-size-vertical: 1;
        &> .page--heading { color: $text-accent; text-style: bold; }
        &> .page--name { text-style: bold; }
        &> .page--text { color: $foreground 85%; }
    }
    """

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self._entries: Sequence[PageEntry] = ()
        self._lines: list[list[tuple[str, str]]] = []

    def show(self, entries: Sequence[PageEntry]) -> None:
        self._entries = entries
        self._fold()

    @property
    def text(self) -> str:
        """The whole text as wrapped now."""
        return "\n".join("".join(text for text, _look in line) for line in self._lines)

    def on_resize(self) -> None:
        """Wrap to the new width."""
        self._fold()

    def render_line(self, y: int) -> Strip:
        at, base = y + self.scroll_offset.y, self.rich_style
        if at >= len(self._lines):
            return Strip.blank(self.size.width, base)
        looks = {
            look: base + self.get_component_rich_style(f"page--{look}", partial=True)
            for look in ("heading", "name", "text")
        }
        segments = [Segment(text, looks[look]) for text, look in self._lines[at]]
        return Strip(segments).adjust_cell_length(self.size.width, base)

    def _fold(self) -> None:
        width = min(WIDEST, self.scrollable_content_region.width or self.size.width)
        if width <= LEFT:
            return
        self._lines = [line for entry in self._entries for line in _folded(entry, width)]
        self.virtual_size = Size(width, len(self._lines))
        self.refresh()


def _folded(entry: PageEntry, width: int) -> list[list[tuple[str, str]]]:
    if entry.name and not entry.text:
        return [[], [(entry.name, "heading")]]
    indent = LEFT if entry.left else 0
    words = [(word, "name") for word in entry.name.split()]
    words += [("·", "text")] if entry.name else []
    words += [(word, "text") for word in entry.text.split()]
    lines: list[list[tuple[str, str]]] = [[(entry.left.ljust(indent), "name")]]
    room = width - indent
    for word, look in words:
        if cell_len(word) + 1 > room and len(lines[-1]) > 1:
            lines.append([(" " * indent, "text")])
            room = width - indent
        lines[-1].append((f"{word} ", look))
        room -= cell_len(word) + 1
    return lines
