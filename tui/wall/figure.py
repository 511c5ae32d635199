"""A number that can be read from afar, and the word of the emergency stop."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.containers import Vertical
from textual.widgets import Digits, Static

from text.plain import plain

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from tui.wall.reading import WallNumber

LOOKS = ("good", "warn", "bad", "muted")
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
"""Letters five lines high: Textual's digits have none of these."""


class BigNumber(Vertical):
    """Label, digits three lines high, and a word below them."""

    DEFAULT_CSS = """
    BigNumber {
        width: 1fr; height: 5; padding: 0 1;
        .big-label { width: 1fr; height: 1; color: $text-muted; text-overflow: ellipsis; }
        Digits { width: 1fr; height: 3; text-style: bold; }
        .big-note { width: 1fr; height: 1; text-style: bold; text-overflow: ellipsis; }
        .big-label, .big-note { text-wrap: nowrap; }
        &.-good Digits, &.-good .big-note { color: $text-success; }
        &.-warn Digits, &.-warn .big-note { color: $text-warning; }
        &.-bad Digits, &.-bad .big-note { color: $text-error; }
        &.-muted Digits { color: $foreground 40%; }
        &.-muted .big-note { color: $text-warning; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self.shown: WallNumber | None = None

    def compose(self) -> ComposeResult:
        """Label above digits above the note."""
        yield Static(classes="big-label", markup=False)
        yield Digits()
        yield Static(classes="big-note", markup=False)

    def show(self, number: WallNumber) -> None:
        """Show this number; redraws only if it is another."""
        if number == self.shown or not self.is_mounted:
            return
        self.shown = number
        self.query_one(".big-label", Static).update(plain(number.label, LONGEST))
        self.query_one(Digits).update(plain(number.value, LONGEST))
        self.query_one(".big-note", Static).update(plain(number.note, LONGEST))
        for look in LOOKS:
            self.set_class(look == number.look, f"-{look}")


def big_word(word: str) -> str:
    """Return a word in letters five lines high; one that lacks a letter as it is."""
    if not all(letter in _LETTERS for letter in word):
        return word
    return "\n".join("  ".join(_LETTERS[letter][row] for letter in word) for row in range(5))
