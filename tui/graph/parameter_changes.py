"""Changing the parameters of a node: one in a dialog, or many from a file."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

from rich.cells import cell_len
from textual import on
from textual.app import App, ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Input, Static

from graph.data import ParameterRow, Value
from graph.observer.requests import SetParameters
from text import ros2_words
from text.i18n import _, localized, ngettext
from text.os_words import os_reason
from text.plain import plain
from tui.actions import bindings
from tui.dialogs.dialog import Dialog
from tui.dialogs.ros2 import copy_dialog_as_ros2
from tui.frame.host import host_of
from tui.graph.parameters import GraphParameters, allowed_words, meant, typed
from tui.widgets.field import Field

LONGEST = 400
LONGEST_TITLE = 64
"""Cells that fit into the frame on a terminal with 80 columns; a longer title is shown below it."""
TEXTS = frozenset({"string", "not_set"})
"""Types whose value is the typed text itself."""
SHOWN = 3
"""Number of refusals that are reported individually."""

Take = Callable[[str], Awaitable[str]]
"""Does the work with what was typed; returns what went wrong, empty if nothing did."""


class FieldDialog(Dialog[None]):
    """Asks for a line of text; stays open, with the reason, while it is refused."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", show=False)]
    DEFAULT_CSS: ClassVar[str] = """
    FieldDialog Input { width: 1fr; margin: 0 1; }
    FieldDialog #field-remark { height: auto; padding: 1 1 0 1; color: $text-warning; }
    FieldDialog #field-keys { height: auto; padding: 1 1; color: $text-muted; }
    """
    may_change: bool = True
    typing_replaces: ClassVar[bool] = False

    def __init__(self, title: str, words: str, text: str, take: Take) -> None:
        super().__init__()
        self._title, self._words, self._text, self._take = title, words, text, take
        self._busy = False

    def title_words(self) -> str:
        return self._title

    def words(self) -> Content:
        return Content(self._words)

    def compose(self) -> ComposeResult:
        with Vertical(id="dialog"):
            yield Static(id="dialog-text", markup=False)
            yield Field(self._text, compact=True, select_on_focus=self.typing_replaces, disabled=not self.may_change)
            yield Static(id="field-remark", markup=False)
            yield Static(id="field-keys", markup=False)

    def on_mount(self) -> None:
        self.query_one(Input).focus()
        self.remark("" if self.may_change else _("It can only be read: the node sets it when it starts."))

    def redraw(self) -> None:
        super().redraw()
        self.query_one("#field-keys", Static).update(self.keys())

    def keys(self) -> str:
        return _("Enter continues, Escape cancels")

    def action_leave(self) -> None:
        self.dismiss(None)

    @on(Input.Changed)
    def _changed(self) -> None:
        if not self._busy and self.may_change:
            self.remark("")

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        if not self._busy:
            self.run_worker(self._try(event.value), exit_on_error=False)

    async def _try(self, text: str) -> None:
        self._busy = True
        refusal = await self.take(text)
        self._busy = False
        if refusal:
            self.remark(refusal)
        elif self.is_current:
            self.dismiss(None)

    async def take(self, text: str) -> str:
        """Use what was typed; return why it is refused, empty if it is not."""
        return await self._take(text)

    def remark(self, words: str) -> None:
        remark = self.query_one("#field-remark", Static)
        remark.update(plain(words, LONGEST))
        remark.display = bool(words)


class ParameterDialog(FieldDialog):
    """Asks for the value of a parameter."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(copy_dialog_as_ros2)
    typing_replaces = True

    def __init__(self, node: str, row: ParameterRow, apply: Callable[[Value], Awaitable[str]]) -> None:
        """`apply` sets the value; it returns why it was refused, or nothing."""
        title = f"{plain(node, LONGEST)} · {plain(row.name, LONGEST)}"
        super().__init__(title, "", typed(row.value), lambda text: apply(self._value(text)))
        self._node, self._row = node, row
        self.may_change = not row.read_only

    def words(self) -> Content:
        row, title = self._row, self._title
        lines = [Content.styled(title, "bold")] if cell_len(title) > LONGEST_TITLE else []
        lines += [Content(plain(_(row.description), LONGEST))] if row.description else []
        lines.append(Content.styled(plain(row.type_name), "$text-muted"))
        if allowed := allowed_words(row):
            lines.append(Content(_("Allowed: {words}").format(words=allowed)))
        return Content("\n").join(lines)

    def keys(self) -> str:
        return _("Enter sets it, Escape leaves") if self.may_change else _("Escape leaves")

    async def take(self, text: str) -> str:
        self.remark(_("The node is being asked…"))
        refusal = await super().take(text)
        return _("Refused: {reason}").format(reason=refusal) if refusal else ""

    async def ros2_command(self) -> str:
        value = self._value(self.query_one(Input).value)
        is_yaml = isinstance(value, str) and self._row.type_name not in TEXTS
        text = str(value) if is_yaml else ros2_words.flow(value)
        return ros2_words.set_parameter(self._node, self._row.name, text)

    def _value(self, text: str) -> Value:
        """Return the value of the text; the original value as long as the text is unchanged."""
        if self._row.value is not None and text == self._text:
            return self._row.value
        return meant(text) if self._row.type_name in TEXTS else text


def edit(app: App[Any], table: GraphParameters) -> None:
    row = table.chosen
    if row is not None:
        app.push_screen(ParameterDialog(table.node, row, lambda value: _set(app, table, {row.name: value})))


def save(app: App[Any], table: GraphParameters) -> None:
    if not table.rows:
        app.notify(_("There are no parameters to save."), severity="warning", markup=False)
        return
    words = _("As `ros2 param dump` writes it, and `ros2 run --params-file` reads it.")
    _ask_path(app, table, _("Save parameters"), words, partial(_save, app, table, []))


def load(app: App[Any], table: GraphParameters) -> None:
    if not table.node:
        return
    words = _("A file of `ros2 param dump`. What it has for {node} is set.").format(node=plain(table.node, LONGEST))
    _ask_path(app, table, _("Load parameters"), words, partial(_load, app, table))


def _ask_path(app: App[Any], table: GraphParameters, title: str, words: str, take: Take) -> None:
    async def take_path(text: str) -> str:
        return await take(text.strip()) if text.strip() else _("Enter a file name.")

    called = table.node.strip("/").replace("/", "__")
    app.push_screen(FieldDialog(title, words, f"{called}.yaml", take_path))


async def _set(app: App[Any], table: GraphParameters, values: Mapping[str, Value]) -> str:
    """Set them and read the node again; return what was refused and why."""
    graph, node = host_of(app).feed.graph, table.node
    if graph is None:
        return _("no lesson is running")
    result = await asyncio.wrap_future(graph.ask(SetParameters(node, values)))
    if table.is_mounted and node == table.node:
        table.read(node)
    if result.error:
        return localized(result.error)
    reasons = [f"{name}: {localized(why)}" for name, why in result.refused.items()]
    if len(values) == 1:
        reasons = [localized(why) for why in result.refused.values()]
    more = len(reasons) - SHOWN
    return "; ".join(reasons[:SHOWN]) + (_(" and {n} more").format(n=more) if more > 0 else "")


async def _save(app: App[Any], table: GraphParameters, refused: list[str], path: str) -> str:
    """Save them; overwrite an existing file only if its name was `refused` and is entered again."""
    from graph.calls.parameters_file import save_file

    replace = path in refused
    refused.clear()
    try:
        await asyncio.to_thread(save_file, _full(path), table.node, table.rows, replace=replace)
    except FileExistsError:
        refused.append(path)
        return _("The file already exists: press Enter again to overwrite it.")
    except OSError as error:
        return f"{path}: {localized(os_reason(error))}"
    app.notify(_("Saved: {path}").format(path=plain(path, LONGEST)), markup=False)
    return ""


async def _load(app: App[Any], table: GraphParameters, path: str) -> str:
    from graph.calls.parameters_file import load_file
    from text.yaml_faults import YamlError

    try:
        values = await asyncio.to_thread(load_file, _full(path), table.node)
    except OSError as error:
        return f"{path}: {localized(os_reason(error))}"
    except YamlError as error:
        return f"{path}:{error.line}:{error.column}: {localized(error.message)}"
    if not values:
        return _("{path} has no parameters for {node}").format(path=path, node=table.node)
    # Read-only parameters are in the file because they were saved with the others.
    fixed = {row.name: row.value for row in table.rows if row.read_only}
    wanted = {name: value for name, value in values.items() if fixed.get(name) != value}
    refusal = await _set(app, table, wanted) if wanted else ""
    if not refusal:
        count = len(wanted)
        words = ngettext("{n} parameter was set.", "{n} parameters were set.", count)
        app.notify(words.format(n=count), markup=False)
    return refusal


def _full(path: str) -> Path:
    return Path(path).expanduser()
