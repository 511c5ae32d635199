"""The dialog in which a file is named, to write parameters to or to read them from."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Input, Static

from text.i18n import _
from text.plain import plain
from tui.dialogs.dialog import Dialog
from tui.widgets.field import Field

if TYPE_CHECKING:
    from textual.app import ComposeResult

LONGEST = 1000

Take = Callable[[str], Awaitable[str]]
"""Does what is to be done with the file; returns what went wrong, or nothing."""


class PathDialog(Dialog[str]):
    """Answers with the path, empty if none was taken; stays open while the file is refused."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", show=False)]
    DEFAULT_CSS: ClassVar[str] = """
    PathDialog Input { width: 1fr; margin: 0 1; }
    PathDialog #path-remark { height: auto; padding: 1 1 0 1; color: $text-warning; }
    PathDialog #path-keys { height: auto; padding: 1 1; color: $text-muted; }
    """

    def __init__(self, title: str, words: str, path: str, take: Take) -> None:
        """Ask with an answer to begin with."""
        super().__init__()
        self._title, self._words, self._path, self._take = title, words, path, take
        self._busy = False

    def title_words(self) -> str:
        """Tell what is to be done."""
        return self._title

    def words(self) -> Content:
        """Tell what the file holds."""
        return Content(self._words)

    def compose(self) -> ComposeResult:
        """Words, field, remark, keys."""
        with Vertical(id="dialog"):
            yield Static(id="dialog-text", markup=False)
            yield Field(self._path, compact=True, select_on_focus=False)
            yield Static(id="path-remark", markup=False)
            yield Static(id="path-keys", markup=False)

    def on_mount(self) -> None:
        """Begin in the field."""
        self.query_one(Input).focus()
        self._remark("")

    def redraw(self) -> None:
        """Show the texts in the language spoken now."""
        super().redraw()
        self.query_one("#path-keys", Static).update(_("Enter goes on, Escape leaves"))

    def action_leave(self) -> None:
        """Do nothing."""
        self.dismiss("")

    @on(Input.Changed)
    def _changed(self) -> None:
        if not self._busy:
            self._remark("")

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        path = event.value.strip()
        if path and not self._busy:
            self._busy = True
            self.run_worker(self._try(path), exit_on_error=False)

    async def _try(self, path: str) -> None:
        wrong = await self._take(path)
        self._busy = False
        if wrong:
            self._remark(wrong)
        elif self.is_current:
            self.dismiss(path)

    def _remark(self, words: str) -> None:
        remark = self.query_one("#path-remark", Static)
        remark.update(plain(words, LONGEST))
        remark.display = bool(words)
