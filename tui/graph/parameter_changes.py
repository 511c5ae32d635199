"""Changing the parameters of a node: one in a dialog, or many from a file."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Input, Static

from graph.observer.requests import SetParameters
from text.i18n import _, localized, ngettext
from text.os_words import os_reason
from text.plain import plain
from tui.dialogs.dialog import Dialog
from tui.frame.host import host_of
from tui.graph.parameter_dialog import ParameterDialog
from tui.widgets.field import Field

if TYPE_CHECKING:
    from collections.abc import Mapping

    from textual.app import App, ComposeResult

    from graph.data import ParameterRow, Value
    from tui.graph.parameters import GraphParameters

LONGEST_REMARK = 1000

Take = Callable[[str], Awaitable[str]]
"""Does the work with the file; returns what went wrong, empty if nothing did."""


class PathDialog(Dialog[str]):
    """Returns the path, empty if none was given; stays open while the file is refused."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", show=False)]
    DEFAULT_CSS: ClassVar[str] = """
    PathDialog Input { width: 1fr; margin: 0 1; }
    PathDialog #path-remark { height: auto; padding: 1 1 0 1; color: $text-warning; }
    PathDialog #path-keys { height: auto; padding: 1 1; color: $text-muted; }
    """

    def __init__(self, title: str, words: str, path: str, take: Take) -> None:
        """Ask for a path, with `path` as the default."""
        super().__init__()
        self._title, self._words, self._path, self._take = title, words, path, take
        self._busy = False

    def title_words(self) -> str:
        """Return what is about to be done."""
        return self._title

    def words(self) -> Content:
        """Return what the file contains."""
        return Content(self._words)

    def compose(self) -> ComposeResult:
        """Words, field, remark, keys."""
        with Vertical(id="dialog"):
            yield Static(id="dialog-text", markup=False)
            yield Field(self._path, compact=True, select_on_focus=False)
            yield Static(id="path-remark", markup=False)
            yield Static(id="path-keys", markup=False)

    def on_mount(self) -> None:
        self.query_one(Input).focus()
        self._remark("")

    def redraw(self) -> None:
        super().redraw()
        self.query_one("#path-keys", Static).update(_("Enter continues, Escape cancels"))

    def action_leave(self) -> None:
        """Close without doing anything."""
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
        remark.update(plain(words, LONGEST_REMARK))
        remark.display = bool(words)


LONGEST = 400
SHOWN = 3
"""Number of refusals that are reported individually."""


def edit(app: App[Any], table: GraphParameters) -> None:
    """Ask for a new value of the chosen parameter."""
    row = table.chosen
    if row is not None:
        apply = partial(_apply, app, table, row)
        app.push_screen(ParameterDialog(table.node, row, apply))


def save(app: App[Any], table: GraphParameters) -> None:
    """Ask for a file, and save all parameters to it."""
    if not table.rows:
        app.notify(_("There are no parameters to save."), severity="warning", markup=False)
        return

    def tell(path: str | None) -> None:
        if path:
            words = _("Saved: {path}").format(path=plain(path, LONGEST))
            app.notify(words, markup=False)

    words = _("As `ros2 param dump` writes it, and `ros2 run --params-file` reads it.")
    take = _Saving(table.node, table.rows)
    path = f"{table.node.strip('/').replace('/', '__')}.yaml"
    app.push_screen(PathDialog(_("Save parameters"), words, path, take), tell)


def load(app: App[Any], table: GraphParameters) -> None:
    """Ask for a file, and set the parameters that it has for this node."""
    if not table.node:
        return
    words = _("A file of `ros2 param dump`. What it has for {node} is set.")
    path = f"{table.node.strip('/').replace('/', '__')}.yaml"
    dialog = PathDialog(
        _("Load parameters"), words.format(node=plain(table.node, LONGEST)), path, partial(_load, app, table)
    )
    app.push_screen(dialog)


async def _apply(app: App[Any], table: GraphParameters, row: ParameterRow, value: Value) -> str:
    return await _set(app, table, {row.name: value})


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


class _Saving:
    """Saves to a file, and overwrites an existing one only if its name is entered twice."""

    def __init__(self, node: str, rows: tuple[ParameterRow, ...]) -> None:
        self._node, self._rows = node, rows
        self._refused = ""

    async def __call__(self, path: str) -> str:
        from graph.calls.parameters_file import save_file

        replace = path == self._refused
        try:
            await asyncio.to_thread(save_file, _full(path), self._node, self._rows, replace=replace)
        except FileExistsError:
            self._refused = path
            return _("The file already exists: press Enter again to overwrite it.")
        except OSError as error:
            return _not_opened(path, error)
        return ""


async def _load(app: App[Any], table: GraphParameters, path: str) -> str:
    from graph.calls.parameters_file import load_file
    from text.yaml_faults import YamlError

    try:
        values = await asyncio.to_thread(load_file, _full(path), table.node)
    except OSError as error:
        return _not_opened(path, error)
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


def _not_opened(path: str, error: OSError) -> str:
    return f"{path}: {localized(os_reason(error))}"
