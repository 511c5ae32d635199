"""The log with its status line, and the line that asks what to search for or where to save.

It knows nothing about keys: a screen's actions call `search`, `find`, `copy`, `save` and the rest.
"""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from textual import on
from textual.containers import Vertical

from text.i18n import _, ngettext
from text.plain import plain
from tui import clock
from tui.log_view.bar import LogBar, grouped
from tui.log_view.prompt import LogPrompt
from tui.log_view.save import default_path, home_path, reason, save_lines
from tui.log_view.view import LogView
from tui.widgets.working import Working

if TYPE_CHECKING:
    from textual.app import ComposeResult

CLIPBOARD_LIMIT = 100_000
"""Bytes; many terminals silently drop a longer OSC 52 sequence."""


class LogPane(Vertical, Working):
    """A `LogView` with all operations on it."""

    DEFAULT_CSS = "LogPane { height: 1fr; width: 1fr; }"

    def __init__(self, view: LogView, *, id: str | None = None) -> None:
        """Put the status line below `view`, with the line for questions between them."""
        super().__init__(id=id)
        self.view = view
        self.save_folder = ""
        """Where files are saved unless the user gives another folder."""
        self._lines: Sequence[str] = ()
        self._refused: Path | None = None

    def compose(self) -> ComposeResult:
        """The lines, the question, the status."""
        yield self.view
        yield LogPrompt()
        yield LogBar()

    @property
    def prompt(self) -> LogPrompt:
        return self.query_one(LogPrompt)

    @on(LogView.StateChanged)
    def _show_state(self, _event: LogView.StateChanged) -> None:
        self.query_one(LogBar).show(self.view)

    def on_language_changed(self) -> None:
        """Redraw in the current language."""
        self.view.lay_out()
        self.query_one(LogBar).show(self.view)

    def search(self) -> None:
        """Ask what to search for; the search runs as the text is typed."""
        self.prompt.ask("search", _("search:"), self.view.log_filter.search)

    def find(self, step: int) -> None:
        """Go to the next (1) or previous (-1) match."""
        if not self.view.log_filter.search:
            self.search()
        elif not self.view.find(step):
            self.app.bell()

    def copy(self) -> None:
        """Copy the chosen lines to the clipboard of the terminal."""
        lines = self.view.chosen_lines()
        if lines:
            self._copy(lines)
        else:
            self.notify(_("Choose lines first: with up and down, several with Shift."))

    def copy_all(self) -> None:
        self._copy(self.view.shown_lines())

    def _copy(self, lines: Sequence[str]) -> None:
        text = "\n".join(lines)
        self.app.copy_to_clipboard(text)
        words = ngettext("{count} line copied", "{count} lines copied", len(lines))
        words = words.format(count=grouped(len(lines)))
        if len(text.encode("utf-8", "replace")) > CLIPBOARD_LIMIT:
            words += "\n" + _("That is a lot for a terminal: if nothing arrives, write a file.")
        self.notify(words)

    def save(self) -> None:
        """Ask for a file to save to: the chosen lines if there are several, otherwise all shown."""
        chosen = self.view.chosen_lines()
        self._lines = chosen if len(chosen) > 1 else self.view.shown_lines()
        self._refused = None
        count = ngettext("write {count} line to:", "write {count} lines to:", len(self._lines))
        path = default_path(self.save_folder, clock.now())
        self.prompt.ask("save", count.format(count=grouped(len(self._lines))), str(path))

    @on(LogPrompt.Edited)
    def _search_edited(self, event: LogPrompt.Edited) -> None:
        if event.kind == "search":
            self._search_for(event.text)

    @on(LogPrompt.Answered)
    def _answered(self, event: LogPrompt.Answered) -> None:
        if event.kind == "search":
            self._close_prompt()
            self.view.find(-1)
        elif event.kind == "save":
            path = event.text.strip()
            if path:
                self.run_worker(self._save(home_path(path)), exclusive=True, group="save")
            else:
                self.prompt.remark(_("Enter a file name."))

    @on(LogPrompt.Cancelled)
    def _given_up(self, event: LogPrompt.Cancelled) -> None:
        if event.kind == "search":
            self._search_for("")
        self._close_prompt()

    def _search_for(self, text: str) -> None:
        chosen = self.view.log_filter
        only_found = chosen.only_found and bool(text)
        self.view.log_filter = replace(chosen, search=text, only_found=only_found)

    def _close_prompt(self) -> None:
        self.prompt.close()
        self.view.focus()

    async def _save(self, path: Path) -> None:
        try:
            size = await asyncio.to_thread(save_lines, path, self._lines, replace=path == self._refused)
        except FileExistsError:
            self._refused = path
            self.prompt.remark(_("The file already exists: press Enter again to overwrite it."))
        except (OSError, ValueError) as error:
            self.prompt.remark(plain(reason(error)))
        else:
            self._close_prompt()
            words = ngettext("{size} byte saved to {path}", "{size} bytes saved to {path}", size)
            self.notify(words.format(size=grouped(size), path=plain(str(path))), markup=False)
