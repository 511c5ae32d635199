"""One line of tabs inside a screen, each with a number; a click chooses one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, NamedTuple

from textual.content import Content
from textual.geometry import Size
from textual.message import Message
from textual.style import Style
from textual.widget import Widget


class TabEntry(NamedTuple):
    """One tab: its key, what it says, and the meaning of its colour (`bad`, `warn` or none)."""

    key: str
    words: str
    meaning: str = ""


class TabLine(Widget):
    """Shows the tabs; the one in front is bold."""

    class Selected(Message):
        """A tab was clicked."""

        def __init__(self, key: str) -> None:
            super().__init__()
            self.key = key

    COMPONENT_CLASSES: ClassVar[set[str]] = {f"tab-line--{part}" for part in ("tab", "front", "bad", "warn")}
    DEFAULT_CSS = """
    TabLine {
        width: auto; height: 1; background: $panel;
        link-style: none; link-color: $foreground; link-background: transparent;
        link-style-hover: reverse;
        .tab-line--tab { color: $foreground; }
        .tab-line--front { color: $foreground; text-style: bold reverse; }
        .tab-line--bad { color: $text-error; text-style: bold; }
        .tab-line--warn { color: $text-warning; text-style: bold; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._front = ""
        self._entries: tuple[TabEntry, ...] = ()

    def show_tabs(self, front: str, entries: Sequence[TabEntry]) -> None:
        if (front, tuple(entries)) != (self._front, self._entries):
            self._front, self._entries = front, tuple(entries)
            self.refresh(layout=True)

    def get_content_width(self, container: Size, viewport: Size) -> int:
        del container, viewport
        return self.render().cell_length

    def action_choose(self, key: str) -> None:
        self.post_message(self.Selected(key))

    def render(self) -> Content:
        parts = []
        for entry in self._entries:
            name = "front" if entry.key == self._front else entry.meaning or "tab"
            click = Style.from_meta({"@click": f"choose({entry.key!r})"})
            style = self.get_visual_style(f"tab-line--{name}") + click
            parts.append(Content.styled(f" {entry.words} ", style))
        return Content("").join(parts)
