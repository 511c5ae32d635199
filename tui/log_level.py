"""The level of a node's log: read, and changed in a dialog."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from graph.inner_states import LOG_LEVELS
from graph.observer.requests import LogLevel
from text.i18n import N_, _, localized
from text.plain import plain
from tui.dialogs.choice import ChoiceScreen
from tui.frame.host import host_of

if TYPE_CHECKING:
    from textual.app import App

    from graph.data import GraphUpdate

LONGEST = 300
MEANINGS = {
    "debug": N_("everything, also what only its author needs"),
    "info": N_("what it does, as nodes log at first"),
    "warn": N_("what may be wrong, and worse"),
    "error": N_("what failed, and worse"),
    "fatal": N_("only what ends it"),
}


async def change_log_level(app: App[Any], node: str) -> None:
    """Ask the node of this full name for its level, then the user for another one; set that."""
    graph = host_of(app).feed.graph
    if graph is None:
        return
    found = await asyncio.wrap_future(graph.ask(LogLevel(node)))
    if found.error:
        _tell(app, localized(found.error), severity="warning")
        return

    def take(level: str | None) -> None:
        if level and level != found.level:
            app.run_worker(_set(app, node, level), exit_on_error=False)

    app.push_screen(_dialog(node, found.level), take)


async def _set(app: App[Any], node: str, level: str) -> None:
    graph = host_of(app).feed.graph
    if graph is None:
        return
    changed = await asyncio.wrap_future(graph.ask(LogLevel(node, level)))
    if changed.error:
        _tell(app, localized(changed.error), severity="warning")
    else:
        _tell(app, _("{node} logs from {level} on").format(node=node, level=changed.level))


def full_name(update: GraphUpdate | None, name: str) -> str:
    """Return the full name of a node that the log has under a shorter one."""
    full = name if name.startswith("/") else f"/{name}"
    names = [] if update is None else [row.name for row in update.nodes]
    if full in names:
        return full
    ends = [each for each in names if each.endswith(full) or each[1:].replace("/", ".") == name]
    return ends[0] if len(ends) == 1 else full


def _dialog(node: str, now: str) -> ChoiceScreen:
    def title() -> str:
        return _("Log level of {node}").format(node=plain(node, LONGEST))

    def words() -> str:
        return _("It logs from {level} on now. What is it to log?").format(level=now)

    width = max(map(len, LOG_LEVELS))
    choices = {level: f"{level:<{width}}  {_(MEANINGS[level])}" for level in LOG_LEVELS}
    return ChoiceScreen(title, words, choices, now)


def _tell(app: App[Any], words: str, severity: Any = "information") -> None:  # noqa: ANN401
    app.notify(plain(words, LONGEST), severity=severity, markup=False)
