"""The lifecycle of a node in words, and a dialog that has it make a transition."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from graph.observer.requests import ChangeState
from text.i18n import N_, _, localized
from text.plain import plain
from tui.dialogs.choice import ChoiceScreen
from tui.frame.host import host_of

if TYPE_CHECKING:
    from textual.app import App

    from graph.data import GraphUpdate
    from graph.inner_states import LifecycleRow

LONGEST = 300
MEANINGS = {
    "configure": N_("read parameters, open devices; it does nothing yet"),
    "activate": N_("do what it is for"),
    "deactivate": N_("pause, ready to go on"),
    "cleanup": N_("let go of all that configure took"),
    "shutdown": N_("end for good; only a restart brings it back"),
}


def lifecycle_of(update: GraphUpdate | None, node: str) -> LifecycleRow | None:
    """Return the lifecycle of the node of this full name, None if it has none."""
    rows = () if update is None else update.lifecycles
    return next((row for row in rows if row.node == node), None)


def lifecycle_words(row: LifecycleRow | None) -> str:
    """Return its state, what it can do now, or why that is not known; empty without a lifecycle."""
    if row is None:
        return ""
    if not row.state:
        why = localized(row.error) if row.error else _("the node is being asked")
        return _("lifecycle: {why}").format(why=why)
    words = _("lifecycle: {state}").format(state=row.state)
    if row.error:
        return f"{words} · {localized(row.error)}"
    if row.transitions:
        words += " · " + _("can {transitions}").format(transitions=", ".join(row.transitions))
    return words


def change_lifecycle(app: App[Any], row: LifecycleRow) -> None:
    """Ask which of the possible transitions the node is to make, and have it made."""

    def take(transition: str | None) -> None:
        if transition:
            app.run_worker(_change(app, row.node, transition), exit_on_error=False)

    app.push_screen(_dialog(row), take)


async def _change(app: App[Any], node: str, transition: str) -> None:
    graph = host_of(app).feed.graph
    if graph is None:
        return
    result = await asyncio.wrap_future(graph.ask(ChangeState(node, transition)))
    if result.error:
        words, severity = localized(result.error), "warning"
    else:
        words = _("{node} is {state} now").format(node=node, state=result.state)
        severity = "information"
    app.notify(plain(words, LONGEST), severity=severity, markup=False)  # type: ignore[arg-type]


def _dialog(row: LifecycleRow) -> ChoiceScreen:
    def title() -> str:
        return _("Lifecycle of {node}").format(node=plain(row.node, LONGEST))

    def words() -> str:
        return _("It is {state}. What is it to do?").format(state=plain(row.state))

    width = max(map(len, row.transitions))
    choices = {
        each: plain(f"{each:<{width}}  {_(MEANINGS[each])}" if each in MEANINGS else each, LONGEST)
        for each in row.transitions
    }
    return ChoiceScreen(title, words, choices)
