"""The head of a detail: a name, and what is to be said of it in a few lines."""

from __future__ import annotations

from textual.content import Content
from textual.widgets import Static

from text.plain import plain

LONGEST = 300


class NameHead(Static):
    """The name, bold, and lines of facts below."""

    DEFAULT_CSS = """
    NameHead { width: 1fr; height: auto; max-height: 4; background: $panel; padding: 0 1; }
    """

    def __init__(self) -> None:
        super().__init__(markup=False)
        self._said: tuple[str, ...] = ()

    def show(self, name: str, *facts: str) -> None:
        """Show these, harmless, each fact in a line of its own."""
        said = (name, *(fact for fact in facts if fact))
        if said != self._said:
            self._said = said
            lines = [Content.styled(plain(name, LONGEST), "bold")]
            lines += [Content.styled(plain(fact, LONGEST), "$text-muted") for fact in said[1:]]
            self.update(Content("\n").join(lines))
