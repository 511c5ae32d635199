"""The head of a detail: a name, and a few lines of facts about it."""

from __future__ import annotations

from collections.abc import Sequence

from textual.content import Content
from textual.widgets import Static

from text.plain import plain

LONGEST = 300


class NameHead(Static):
    """The name in bold, and lines of facts below it."""

    DEFAULT_CSS = """
    NameHead { width: 1fr; height: auto; max-height: 4; background: $panel; padding: 0 1; }
    """

    said: tuple[str, ...] = ()

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id, markup=False)

    def show(self, name: str, *facts: str) -> None:
        said: tuple[str, ...] = (name, *(fact for fact in facts if fact))
        if said != self.said:
            self.said = said
            lines = [Content.styled(plain(name, LONGEST), "bold")]
            lines += [Content.styled(plain(fact, LONGEST), "$text-muted") for fact in said[1:]]
            self.update(Content("\n").join(lines))

    def show_lines(self, lines: Sequence[Content]) -> None:
        """Show lines with styles of their own in the place of name and facts."""
        said = tuple(line.markup for line in lines)
        if said != self.said:
            self.said = said
            self.update(Content("\n").join(lines))
