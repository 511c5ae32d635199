"""A field for the name of a type, with matching names listed below it."""

from __future__ import annotations

from typing import ClassVar

from textual import getters, on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.events import DescendantBlur
from textual.message import Message
from textual.widgets import Input, OptionList

from tui.widgets.field import Field

EXAMPLES = "example_interfaces/"
LISTED = 50
"""Nobody scrolls through more than that."""


class TypeField(Vertical):
    """A one-line field; while it has the focus, it lists the types that match its text."""

    class TypeChosen(Message):
        """A type was chosen: typed in full, or from the list."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("down", "move(1)", show=False),
        Binding("up", "move(-1)", show=False),
    ]
    DEFAULT_CSS = """
    TypeField {
        height: auto; width: 1fr;
        & > OptionList {
            height: auto; max-height: 7; display: none; background: $panel; scrollbar-size: 1 1;
        }
        &.-listing > OptionList { display: block; }
    }
    """

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._types: tuple[str, ...] = ()
        self._chosen = ""

    def compose(self) -> ComposeResult:
        yield Field(compact=True, select_on_focus=False)
        listed = OptionList(markup=False, compact=True)
        listed.can_focus = False
        yield listed

    field = getters.query_one(Input)

    @property
    def value(self) -> str:
        return self.field.value.strip()

    @property
    def is_listing(self) -> bool:
        return self.has_class("-listing")

    def know(self, types: tuple[str, ...]) -> None:
        self._types = types
        if self.field.has_focus:
            self._list()

    def set(self, type_name: str) -> None:
        self._chosen = type_name
        self.field.value = type_name
        self.close()

    def close(self) -> None:
        self.remove_class("-listing")

    def fitting(self) -> list[str]:
        """Return the types that contain every word typed, those that start with one first.

        `example_interfaces` repeats all of `std_msgs`: its types come after theirs.
        """
        words = self.value.lower().split()
        found = [name for name in self._types if all(word in name.lower() for word in words)]
        first = words[0] if words else ""

        def rank(name: str) -> tuple[int, int, bool, str]:
            short = name.rpartition("/")[2].lower()
            place = 0 if short == first else 1 if short.startswith(first) else 2
            return (place, len(short) if first else 0, name.startswith(EXAMPLES), name)

        return sorted(found, key=rank)[:LISTED]

    def action_move(self, by: int) -> None:
        """Move up or down in the list, opening it if necessary."""
        if not self.is_listing:
            self._list(everything=True)
            return
        listed = self.query_one(OptionList)
        (listed.action_cursor_down if by > 0 else listed.action_cursor_up)()

    @on(Input.Changed)
    def _changed(self, event: Input.Changed) -> None:
        event.stop()
        if self.value in self._types:
            self._choose(self.value)
        elif self.field.has_focus:
            self._chosen = ""
            self._list()

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        event.stop()
        listed = self.query_one(OptionList)
        if self.is_listing and listed.highlighted is not None:
            self._choose(str(listed.get_option_at_index(listed.highlighted).prompt))
        elif self.value:
            self._choose(self.value)

    @on(OptionList.OptionSelected)
    def _selected(self, event: OptionList.OptionSelected) -> None:
        event.stop()
        self._choose(str(event.option.prompt))

    def on_descendant_blur(self, event: DescendantBlur) -> None:
        del event
        self.close()
        if self.value and self.value != self._chosen:
            self._choose(self.value)

    def _choose(self, type_name: str) -> None:
        if type_name != self._chosen:
            self.set(type_name)
            self.post_message(self.TypeChosen())
        else:
            self.close()

    def _list(self, *, everything: bool = False) -> None:
        names = list(self._types) if everything else self.fitting()
        listed = self.query_one(OptionList)
        listed.clear_options()
        listed.add_options(names)
        listed.highlighted = 0 if names else None
        self.set_class(bool(names), "-listing")
