"""The log with its status line, and the line that asks what to search for or where to save.

It knows nothing about keys: a screen's actions call `search`, `find`, `copy`, `save` and the rest.
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import Iterator, Sequence
from dataclasses import replace
from datetime import datetime, timezone
from pathlib import Path
from typing import ClassVar

from rich.cells import cell_len
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.content import Content
from textual.widget import Widget
from textual.widgets import Input, Static

from launcher.status import Severity
from text.i18n import _, localized, ngettext
from text.os_words import os_reason
from text.plain import plain
from tui import clock
from tui.log_view.rows import exported, grouped
from tui.log_view.view import LogView
from tui.widgets.field import Field
from tui.widgets.working import Working

CLIPBOARD_LIMIT = 100_000
"""Bytes; many terminals silently drop a longer OSC 52 sequence."""


class LogPrompt(Horizontal):
    """A label, a text field and room for a remark; hidden until `ask` is called."""

    DEFAULT_CSS = """
    LogPrompt {
        display: none;
        height: 1;
        background: $boost;
        &.-asking { display: block; }
        #label { width: auto; padding: 0 1; text-style: bold; }
        #remark { width: auto; max-width: 50%; padding: 0 1; color: $text-warning; }
        Input { width: 1fr; }
    }
    """
    kind = ""
    """What is asked: `search` or `save`; empty if nothing is."""

    def compose(self) -> ComposeResult:
        yield Static(id="label", markup=False)
        yield Field(compact=True, select_on_focus=False)
        yield Static(id="remark", markup=False)

    def ask(self, kind: str, label: str, text: str) -> None:
        self.kind = kind
        self.add_class("-asking")
        self.query_one("#label", Static).update(label)
        self.remark("")
        field = self.query_one(Input)
        with self.prevent(Input.Changed):
            field.value = text
        field.cursor_position = len(text)
        self.screen.set_focus(field)

    def remark(self, words: str) -> None:
        self.query_one("#remark", Static).update(words)

    def close(self) -> None:
        self.kind = ""
        self.remove_class("-asking")


LONGEST_NAME = 24


class LogBar(Widget):
    """Shows the state of a log view in words; what does not fit is left out from the end."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"log-bar--paused", "log-bar--chosen"}
    DEFAULT_CSS = """
    LogBar {
        height: 1;
        width: 1fr;
        background: $panel;
        color: $foreground 80%;
        .log-bar--paused { background: $warning; color: auto 90%; text-style: bold; }
        .log-bar--chosen { text-style: bold; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._parts: tuple[tuple[str, str], ...] = ()

    def show(self, view: LogView) -> None:
        parts = tuple(state_parts(view))
        if parts != self._parts:
            self._parts = parts
            self.refresh()

    @property
    def words(self) -> str:
        return " · ".join(text for text, _style in self._parts)

    def render(self) -> Content:
        drawn: list[Content] = []
        room = self.size.width
        for text, style in self._parts:
            room -= cell_len(text) + 2
            if room < 0:
                break
            look = self.get_visual_style(f"log-bar--{style}") if style else ""
            drawn.append(Content.styled(f" {text} ", look))
        return Content("").join(drawn)


def state_parts(view: LogView) -> list[tuple[str, str]]:
    """(text, style) of each part: following, long name, search, lines, nodes, severity, counts."""
    parts = [(_("▶ following"), "")]
    if not view.following:
        words = ngettext("‖ paused, {count} new", "‖ paused, {count} new", view.fresh)
        parts = [(words.format(count=grouped(view.fresh)), "paused")]
        node = view.choice.node
        # The column of nodes may have no room for the name.
        parts += [(plain(node), "chosen")] if node is not None and view.cuts(node) else []
        parts.append((_("End follows"), ""))
    chosen = [*_search_words(view), *_filter_words(view)]
    lines = len(view.choice.entries)
    if lines > 1:
        words = ngettext("{count} line selected", "{count} lines selected", lines)
        chosen.append(words.format(count=grouped(lines)))
    parts += [(words, "chosen") for words in chosen]
    shown, total = len(view.index.shown), len(view.ring.entries)
    words = ngettext("{count} line", "{count} lines", total)
    if shown != total:
        words = ngettext("{shown} of {count} line", "{shown} of {count} lines", total)
    parts.append((words.format(shown=grouped(shown), count=grouped(total)), ""))
    return parts if view.fold else [*parts, (_("lines not wrapped"), "")]


def _search_words(view: LogView) -> Iterator[str]:
    chosen, found = view.log_filter, len(view.index.found)
    text = plain(chosen.search, LONGEST_NAME)
    if text and not found:
        yield _("“{text}” not found").format(text=text)
    elif text:
        number = view.choice.found_number
        count = f"{grouped(number)}/{grouped(found)}" if number else grouped(found)
        words = _("“{text}” {count}") if not chosen.only_found else _("only “{text}” {count}")
        yield words.format(text=text, count=count)


def _filter_words(view: LogView) -> Iterator[str]:
    chosen = view.log_filter
    if chosen.only is not None:
        yield _("only {node}").format(node=plain(chosen.only, LONGEST_NAME))
    elif chosen.muted:
        count = len(chosen.muted)
        yield ngettext("{count} node muted", "{count} nodes muted", count).format(count=count)
    if chosen.minimum is not Severity.DEBUG:
        words = view.minimum_words or _("{severity} and worse")
        yield words.format(severity=chosen.minimum.name)


class LogPane(Vertical, Working):
    """A `LogView` with all operations on it."""

    DEFAULT_CSS = "LogPane { height: 1fr; width: 1fr; }"
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "give_up", show=False)]

    def __init__(self, view: LogView) -> None:
        """Put the status line below `view`, with the line for questions between them."""
        super().__init__()
        self.view, self.prompt = view, LogPrompt()
        self.save_folder = ""
        """Where files are saved unless the user gives another folder."""
        self._lines: Sequence[str] = ()
        self._refused: Path | None = None

    def compose(self) -> ComposeResult:
        yield self.view
        yield self.prompt
        yield LogBar()

    @on(LogView.StateChanged)
    def _show_state(self) -> None:
        self.query_one(LogBar).show(self.view)

    def on_language_changed(self) -> None:
        self.view.lay_out()
        self._show_state()

    def search(self) -> None:
        self.prompt.ask("search", _("search:"), self.view.log_filter.search)

    def find(self, step: int) -> None:
        if not self.view.log_filter.search:
            self.search()
        elif not self.view.find(step):
            self.app.bell()

    def copy(self) -> None:
        lines = exported(self.view.choice.entries, self.view.index)
        if lines:
            self._copy(lines)
        else:
            self.notify(_("Choose lines first: with up and down, several with Shift."))

    def copy_all(self) -> None:
        self._copy(exported(self.view.index.shown, self.view.index))

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
        chosen = exported(self.view.choice.entries, self.view.index)
        self._lines = chosen if len(chosen) > 1 else exported(self.view.index.shown, self.view.index)
        self._refused = None
        count = ngettext("write {count} line to:", "write {count} lines to:", len(self._lines))
        when = datetime.fromtimestamp(clock.now(), timezone.utc).astimezone()
        path = Path(self.save_folder or ".") / f"deck-{when:%Y%m%d-%H%M%S}.log"
        self.prompt.ask("save", count.format(count=grouped(len(self._lines))), str(path))

    @on(Input.Changed)
    def _typed(self, event: Input.Changed) -> None:
        event.stop()
        self.prompt.remark("")
        if self.prompt.kind == "search":
            self._search_for(event.value)

    @on(Input.Submitted)
    def _answered(self, event: Input.Submitted) -> None:
        event.stop()
        if self.prompt.kind == "search":
            self._close_prompt()
            self.view.find(-1)
        elif path := event.value.strip():
            self.run_worker(self._save(path), exclusive=True, group="save")
        else:
            self.prompt.remark(_("Enter a file name."))

    def action_give_up(self) -> None:
        if self.prompt.kind == "search":
            self._search_for("")
        self._close_prompt()

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Leave Escape to the screen unless a question is open."""
        return bool(self.prompt.kind) if action == "give_up" else super().check_action(action, parameters)

    def _search_for(self, text: str) -> None:
        chosen = self.view.log_filter
        only_found = chosen.only_found and bool(text)
        self.view.log_filter = replace(chosen, search=text, only_found=only_found)

    def _close_prompt(self) -> None:
        self.prompt.close()
        self.view.focus()

    async def _save(self, typed: str) -> None:
        path = Path(typed)
        try:
            path = _full(path)
            size = await asyncio.to_thread(save_lines, path, self._lines, replace=path == self._refused)
        except FileExistsError:
            self._refused = path
            self.prompt.remark(_("The file already exists: press Enter again to overwrite it."))
        except (OSError, RuntimeError, ValueError) as error:
            self.prompt.remark(plain(localized(os_reason(error))))
        else:
            self._close_prompt()
            words = ngettext("{size} byte saved to {path}", "{size} bytes saved to {path}", size)
            self.notify(words.format(size=grouped(size), path=plain(str(path))), markup=False)


def _full(path: Path) -> Path:
    return path.expanduser()


def save_lines(path: Path, lines: Sequence[str], *, replace: bool) -> int:
    """Write the lines, each with a line end, as UTF-8; return the number of bytes written.

    Creates missing folders. Raises FileExistsError unless `replace`, and any other OSError of the
    file system.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    flags = os.O_WRONLY | os.O_CREAT | (os.O_TRUNC if replace else os.O_EXCL)
    data = "".join(f"{line}\n" for line in lines).encode("utf-8", "replace")
    with os.fdopen(os.open(path, flags, 0o644), "wb") as file:
        return file.write(data)
