"""The dialog for changing the value of a parameter."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING, ClassVar

from rich.cells import cell_len
from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Input, Static

from text import ros2_words
from text.i18n import _
from text.plain import plain
from tui.actions import bindings
from tui.dialogs.dialog import Dialog
from tui.dialogs.ros2 import copy_dialog_as_ros2
from tui.graph.parameter_words import allowed_words, meant, typed
from tui.widgets.field import Field

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from graph.data import ParameterRow, Value

LONGEST = 400
LONGEST_TITLE = 64
"""Cells that fit into the frame on a terminal with 80 columns; a longer title is shown below it."""
TEXTS = frozenset({"string", "not_set"})
"""Types whose value is the typed text itself."""

Apply = Callable[["Value"], Awaitable[str]]
"""Sets the value; returns why it was refused, or nothing."""


class ParameterDialog(Dialog[bool]):
    """Returns whether it was set; stays open, with the reason, while the value is refused."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", show=False), *bindings(copy_dialog_as_ros2)]
    DEFAULT_CSS: ClassVar[str] = """
    ParameterDialog Input { width: 1fr; margin: 0 1; }
    ParameterDialog #parameter-remark { height: auto; padding: 1 1 0 1; color: $text-warning; }
    ParameterDialog #parameter-keys { height: auto; padding: 1 1; color: $text-muted; }
    """

    def __init__(self, node: str, row: ParameterRow, apply: Apply) -> None:
        """Ask for the value of a parameter of `node`."""
        super().__init__()
        self._node, self._row, self._apply = node, row, apply
        self._typed = typed(row.value)
        self._busy = False

    def title_words(self) -> str:
        return f"{plain(self._node, LONGEST)} · {plain(self._row.name, LONGEST)}"

    def words(self) -> Content:
        """Say what it is, and which values are allowed."""
        row, title = self._row, self.title_words()
        lines = [Content.styled(plain(row.type_name), "$text-muted")]
        if row.description:
            lines.insert(0, Content(plain(_(row.description), LONGEST)))
        if cell_len(title) > LONGEST_TITLE:
            lines.insert(0, Content.styled(title, "bold"))
        allowed = allowed_words(row)
        if allowed:
            lines.append(Content(_("Allowed: {words}").format(words=allowed)))
        return Content("\n").join(lines)

    def compose(self) -> ComposeResult:
        """Words, field, remark, keys."""
        with Vertical(id="dialog"):
            yield Static(id="dialog-text", markup=False)
            yield Field(self._typed, compact=True, disabled=self._row.read_only)
            yield Static(id="parameter-remark", markup=False)
            yield Static(id="parameter-keys", markup=False)

    def on_mount(self) -> None:
        self.query_one(Input).focus()
        if self._row.read_only:
            self._remark(_("It can only be read: the node sets it when it starts."))

    def redraw(self) -> None:
        super().redraw()
        keys = _("Enter sets it, Escape leaves")
        if self._row.read_only:
            keys = _("Escape leaves")
        self.query_one("#parameter-keys", Static).update(keys)

    async def ros2_command(self) -> str:
        """Return what sets the parameter to what is typed."""
        value = self._value(self.query_one(Input).value)
        is_yaml = isinstance(value, str) and self._row.type_name not in TEXTS
        text = str(value) if is_yaml else ros2_words.flow(value)
        return ros2_words.set_parameter(self._node, self._row.name, text)

    def action_leave(self) -> None:
        """Close without changing anything."""
        self.dismiss(False)

    @on(Input.Changed)
    def _changed(self) -> None:
        if not self._busy and not self._row.read_only:
            self._remark("")

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        if not self._busy:
            self._busy = True
            self._remark(_("The node is being asked…"))
            self.run_worker(self._set(event.value), exit_on_error=False)

    async def _set(self, text: str) -> None:
        refusal = await self._apply(self._value(text))
        self._busy = False
        if refusal:
            self._remark(_("Refused: {reason}").format(reason=refusal))
        elif self.is_current:
            self.dismiss(True)

    def _value(self, text: str) -> Value:
        """Return the value of the text; the original value as long as the text is unchanged."""
        if self._row.value is not None and text == self._typed:
            return self._row.value
        return meant(text) if self._row.type_name in TEXTS else text

    def _remark(self, words: str) -> None:
        remark = self.query_one("#parameter-remark", Static)
        remark.update(plain(words, LONGEST))
        remark.display = bool(words)
