"""A text field with its own colouring, and errors underlined and marked."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import ClassVar, NamedTuple

from rich.segment import Segment
from rich.style import Style
from rich.text import Text
from textual.document._document import EditResult
from textual.document._edit import Edit
from textual.events import Paste
from textual.geometry import Offset
from textual.message import Message
from textual.strip import Strip
from textual.widgets import TextArea

from text.plain import replaced

MARK = "✗"
PARTS = ("key", "string", "number", "word", "mark", "comment", "bad", "problem", "gutter")
MARGIN = 2
"""Cells that `TextArea` leaves between a line's number and its text."""

LONGEST_COLOURED = 4096
"""Limit in characters of a line: a wrapped line is coloured again for each of its rows."""


class TextPlace(NamedTuple):
    """The position of an error, counted from 1."""

    line: int
    column: int


class Token(NamedTuple):
    """One token of a line; columns in characters from 0."""

    start: int
    end: int
    kind: str
    """`key`, `string`, `number`, `word`, `mark`, `comment`, or `bad` for what is not allowed."""


class MarkedEditor(TextArea):
    """Edits text line by line; Enter starts a new line, and nothing here sends anything.

    All of its text is visible: characters that would be invisible, or interpreted by the terminal,
    become escapes, which mean the same between double quotes in both YAML and JSON.

    A subclass provides the tokens of a line. Highlighting is based on `get_line`, which is meant to
    be overridden, rather than on tree-sitter, which with a grammar is 2.5 MB of compiled code.
    """

    class TooLong(Message):
        """A paste was rejected because the text would become too long."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {f"marked-editor--{part}" for part in PARTS}
    DEFAULT_CSS = """
    MarkedEditor {
        border: none; padding: 0; height: 1fr; scrollbar-size: 1 1;
        &:focus { border: none; }
        & .marked-editor--key { color: $text-primary; }
        & .marked-editor--string { color: $text-success; }
        & .marked-editor--number { color: $text-warning; }
        & .marked-editor--word { color: $text-accent; }
        & .marked-editor--mark { color: $foreground; text-style: dim; }
        & .marked-editor--comment { color: $foreground; text-style: dim; }
        & .marked-editor--bad { color: $text-error; }
        & .marked-editor--problem { color: $text-error; text-style: bold underline; }
        & .marked-editor--gutter { color: $text-error; text-style: bold; }
    }
    """

    longest: ClassVar[int] = 64 * 1024
    """Maximum length of the text in characters; a longer one would block the whole screen."""

    def __init__(self, text: str = "", *, id: str | None = None) -> None:
        super().__init__(
            self.shown(text), id=id, soft_wrap=True, show_line_numbers=True, tab_behavior="focus", compact=True
        )
        self.indent_width = 2
        # A blinking cursor would send bytes twice a second for as long as the screen is open.
        self.cursor_blink = False
        self._places: tuple[TextPlace, ...] = ()

    def tokens_of(self, line: str) -> Iterable[Token]:
        """Return the tokens of a line in order; accepts any text."""
        del line
        return ()

    def escaped(self, character: str) -> str:
        """Return the escape for a character that must not be shown as it is."""
        return json.dumps(character)[1:-1]

    def shown(self, text: str) -> str:
        """Return a text as it appears in this field, split into lines."""
        lines = text.replace("\r\n", "\n").replace("\r", "\n")
        return replaced(lines, lambda one: one if one in "\n\t" else self.escaped(one))

    def load_text(self, text: str) -> None:
        super().load_text(self.shown(text))

    def edit(self, edit: Edit) -> EditResult:
        """Take an edit, whether typed, pasted or set by the program."""
        edit.text = self.shown(edit.text)
        return super().edit(edit)

    def show_problems(self, places: Iterable[TextPlace]) -> None:
        """Underline the text at these places and mark their lines; with none, clear the marks."""
        shown = tuple(places)
        if shown != self._places:
            self._places = shown
            self.notify_style_update()
            self.refresh()

    def go_to(self, place: TextPlace) -> None:
        """Move the cursor to a place, as near as the text allows."""
        row = max(0, min(place.line - 1, self.document.line_count - 1))
        column = max(0, min(place.column - 1, len(self.document.get_line(row))))
        self.move_cursor((row, column), center=True)
        self.focus()

    def replace_all(self, text: str) -> None:
        """Replace the whole text in a way that can be undone."""
        self.replace(text, self.document.start, self.document.end)
        self.move_cursor((0, 0))

    def on_paste(self, event: Paste) -> None:
        if len(self.shown(event.text)) + len(self.text) > self.longest:
            event.prevent_default().stop()
            self.post_message(self.TooLong())

    def get_line(self, line_index: int) -> Text:
        source = self.document.get_line(line_index)
        line = Text(source, no_wrap=True)
        line.end = ""
        for token in self.tokens_of(source) if len(source) <= LONGEST_COLOURED else ():
            line.stylize(self._style(token.kind), token.start, token.end)
        for place in self._places:
            if place.line - 1 == line_index:
                line.stylize(self._style("problem"), *self._token_at(source, place.column - 1))
        return line

    def render_line(self, y: int) -> Strip:
        strip = super().render_line(y)
        if not self._places:
            return strip
        row, column = self.wrapped_document.offset_to_location(Offset(0, y + self.scroll_offset.y))
        beyond = y + self.scroll_offset.y >= self.wrapped_document.height
        if column or beyond or not any(place.line - 1 == row for place in self._places):
            return strip
        before, after = self.gutter_width - MARGIN, self.gutter_width - MARGIN + 1
        mark = Strip([Segment(MARK, self._style("gutter"))], 1)
        return Strip.join([strip.crop(0, before), mark, strip.crop(after)])

    def get_component_rich_style(self, *names: str, partial: bool = False, default: Style | None = None) -> Style:
        """Give the cursor's line only a background, so that its tokens keep their colours."""
        style = super().get_component_rich_style(*names, partial=partial, default=default)
        if "text-area--cursor-line" in names:
            return type(style)(bgcolor=style.bgcolor)
        return style

    def _token_at(self, line: str, column: int) -> tuple[int, int]:
        """Start and end of the token at a column, at least one character wide."""
        for token in self.tokens_of(line):
            if token.start <= column < token.end:
                return token.start, token.end
        return column, column + 1

    def _style(self, kind: str) -> Style:
        return self.get_component_rich_style(f"marked-editor--{kind}", partial=True)
