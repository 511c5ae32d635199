"""Changing the parameters of a node: one in a dialog, many from a file."""

from __future__ import annotations

import asyncio
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from text.i18n import _, ngettext, said
from text.os_words import os_reason
from text.plain import plain
from tui.frame.host import host_of
from tui.graph.parameter_dialog import ParameterDialog
from tui.graph.path import PathDialog

if TYPE_CHECKING:
    from collections.abc import Mapping

    from textual.app import App

    from graph.data import ParameterRow, Value
    from tui.graph.parameters import GraphParameters

LONGEST = 400
SHOWN = 3
"""Refusals that are told one by one."""


def edit(app: App[Any], table: GraphParameters) -> None:
    """Ask for another value of the chosen parameter."""
    row = table.chosen
    if row is not None:
        apply = partial(_apply, app, table, row)
        app.push_screen(ParameterDialog(table.node, row, apply))


def save(app: App[Any], table: GraphParameters) -> None:
    """Ask for a file, and write all parameters into it."""
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
    """Ask for a file, and set what it has for this node."""
    if not table.node:
        return
    words = _("A file of `ros2 param dump`. What it has for {node} is set.")
    path = f"{table.node.strip('/').replace('/', '__')}.yaml"
    dialog = PathDialog(
        _("Load parameters"),
        words.format(node=plain(table.node, LONGEST)),
        path,
        partial(_load, app, table),
    )
    app.push_screen(dialog)


async def _apply(app: App[Any], table: GraphParameters, row: ParameterRow, value: Value) -> str:
    return await _set(app, table, {row.name: value})


async def _set(app: App[Any], table: GraphParameters, values: Mapping[str, Value]) -> str:
    """Set them, read the node anew; return what was refused and why."""
    graph, node = host_of(app).feed.graph, table.node
    if graph is None:
        return _("no lesson is running")
    result = await asyncio.wrap_future(graph.set_parameters(node, values))
    if table.is_mounted and node == table.node:
        table.read(node)
    if result.error:
        return said(result.error)
    reasons = [f"{name}: {said(why)}" for name, why in result.refused.items()]
    if len(values) == 1:
        reasons = [said(why) for why in result.refused.values()]
    more = len(reasons) - SHOWN
    return "; ".join(reasons[:SHOWN]) + (_(" and {n} more").format(n=more) if more > 0 else "")


class _Saving:
    """Writes a file, and one that is there only when its name is given once more."""

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
            return _("There is such a file: Enter again overwrites it.")
        except OSError as error:
            return _not_opened(path, error)
        return ""


async def _load(app: App[Any], table: GraphParameters, path: str) -> str:
    from graph.calls.parameters_file import load_file
    from graph.messages.yaml_faults import YamlError

    try:
        values = await asyncio.to_thread(load_file, _full(path), table.node)
    except OSError as error:
        return _not_opened(path, error)
    except YamlError as error:
        return f"{path}:{error.line}:{error.column}: {said(error.message)}"
    if not values:
        return _("{path} has no parameters for {node}").format(path=path, node=table.node)
    # What can only be read was in the file because it was saved with the rest.
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
    return f"{path}: {said(os_reason(error))}"
