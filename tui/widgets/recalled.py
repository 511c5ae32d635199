"""What was typed into a text field before: brought back with the up and down keys."""

from __future__ import annotations


class Recalled:
    """The newest texts, and the place among them; past the newest is what was begun."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._said: list[str] = []
        self._at = 0
        self._draft = ""

    @property
    def newest(self) -> str:
        """The last text that was kept, empty if there is none."""
        return self._said[-1] if self._said else ""

    def keep(self, text: str) -> None:
        """Add a text, unless it repeats the newest, and go to the end."""
        if text != self.newest:
            self._said = [*self._said, text][-self._most :]
        self._at, self._draft = len(self._said), ""

    def step(self, step: int, begun: str) -> str | None:
        """Go to an earlier (-1) or later (1) text; None at either end.

        `begun` is what stands in the field.
        """
        at = max(0, min(self._at + step, len(self._said)))
        if at == self._at:
            return None
        if self._at == len(self._said):
            self._draft = begun
        self._at = at
        return self._said[at] if at < len(self._said) else self._draft
