"""A number that can be read from afar, and the word of the emergency stop."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.content import Content
from textual.widget import Widget

from text.plain import plain
from tui.wall.digits import digit_lines, size_for

if TYPE_CHECKING:
    from tui.wall.reading import WallNumber

LOOKS = {
    "": ("", ""),
    "good": ("$text-success", "$text-success"),
    "warn": ("$text-warning", "$text-warning"),
    "bad": ("$text-error", "$text-error"),
    "muted": ("$foreground 40%", "$text-warning"),
}
"""The colours of digits and note."""
WIDEST = "-0.00"
"""What has room always, so that no sign changes the size."""
LONGEST = 60
_LETTERS = {
    "S": ("▟███▙", "█▖   ", "▝███▖", "   ▝█", "▜███▛"),
    "T": ("█████", "  █  ", "  █  ", "  █  ", "  █  "),
    "O": ("▟███▙", "█   █", "█   █", "█   █", "▜███▛"),
    "P": ("████▙", "█   █", "████▛", "█    ", "█    "),
    "С": ("▟███▙", "█    ", "█    ", "█    ", "▜███▛"),
    "Т": ("█████", "  █  ", "  █  ", "  █  ", "  █  "),
    "О": ("▟███▙", "█   █", "█   █", "█   █", "▜███▛"),
    "П": ("█████", "█   █", "█   █", "█   █", "█   █"),
}
"""Letters five lines high: no seven segments make these."""


class BigNumber(Widget):
    """Label, digits as large as there is room, and a word below them."""

    DEFAULT_CSS = """
    BigNumber {
        width: 1fr; height: 1fr; padding: 0 1; content-align: left middle;
        text-wrap: nowrap; text-overflow: ellipsis;
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self.shown: WallNumber | None = None

    def show(self, number: WallNumber) -> None:
        """Show this number; redraws only if it is another."""
        if number != self.shown:
            self.shown = number
            self.refresh()

    def _room(self) -> tuple[int, int]:
        """Return the columns and rows for digits, those of the smallest number on the wall.

        What is left of a room divided by three or four would make some a little larger.
        """
        beside = [one.size for one in self.siblings if isinstance(one, BigNumber) and one.display]
        sizes = [self.size, *(size for size in beside if size.area)]
        return min(size.width for size in sizes), min(size.height for size in sizes) - 2

    def render(self) -> Content:
        """Draw the three below each other."""
        if self.shown is None:
            return Content("")
        value, (of_value, of_note) = plain(self.shown.value, LONGEST), LOOKS[self.shown.look]
        size = size_for((value, WIDEST), *self._room())
        lines = [value] if size is None else digit_lines(value, size)
        return Content("\n").join(
            [
                Content.styled(plain(self.shown.label, LONGEST), "$foreground 60%"),
                *(Content.styled(line, f"bold {of_value}") for line in lines),
                Content.styled(plain(self.shown.note, LONGEST), f"bold {of_note}"),
            ]
        )


def big_word(word: str) -> str:
    """Return a word in letters five lines high; one that lacks a letter as it is."""
    if not all(letter in _LETTERS for letter in word):
        return word
    return "\n".join("  ".join(_LETTERS[letter][row] for letter in word) for row in range(5))
