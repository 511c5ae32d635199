"""The nodes of the session: their state as a sign and a word, and the resources each one uses."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from rich.cells import cell_len
from textual.message import Message

from text.i18n import N_, _
from text.plain import plain
from tui.widgets.node_words import AILING, AT_WORK, STATES, ailing_words, duration, memory, percent, state_words, why
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from graph.inner_states import LifecycleRow
    from launcher.status import NodeStatus

OUTSIDE = ("◇", N_("outside"))
UNKNOWN = "—"
OWN, MUTED = "✎", "⊘"
"""Follow the name of a node that runs the learner's own file, or is left out of the log."""

FULL, TOLD = 42, 66
"""Cells besides the names from which on there are columns for the process, and for the detail."""


class NodesTable(Rows):
    """Shows the nodes in the profile's order, and below them those that Deck did not start."""

    class Cut(Message):
        """The text that does not fit into the chosen row has changed."""

        def __init__(self, node: str, facts: str) -> None:
            """Carry the full name and state, or empty texts if everything fits."""
            super().__init__()
            self.node = node
            self.facts = facts

    def __init__(self, *, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._statuses: tuple[NodeStatus, ...] = ()
        self.outside: tuple[str, ...] = ()
        """Names of the nodes that Deck did not start."""
        self._lifecycles: Mapping[str, str] = {}
        self._muted: frozenset[str] = frozenset()
        self._full = self._told = False
        self._cut = ("", "")
        self._word = 0
        """Width of the sign and the longest state of a running process."""

    def show_nodes(
        self,
        nodes: Mapping[str, NodeStatus],
        muted: Collection[str] = frozenset(),
        outside: Sequence[str] = (),
        lifecycles: Mapping[str, str] | None = None,
    ) -> None:
        """Show these nodes; the log of `muted` ones is hidden, others started `outside` ones.

        `lifecycles`: the state of each node that has a lifecycle, by its name.
        """
        self._statuses, self.outside = tuple(nodes.values()), tuple(outside)
        self._lifecycles = lifecycles or {}
        self._muted = frozenset(muted)
        self._show()

    def on_resize(self) -> None:
        """Show the columns that fit."""
        self._show()

    def _show(self) -> None:
        width = self.size.width
        if not width:
            return
        alive = [word for state, (_sign, word, _meaning) in STATES.items() if state.alive]
        alive += [word for _sign, word, _meaning in AILING.values()]
        words = [*map(_, alive), *map(plain, self._lifecycles.values())]
        self._word = max(map(cell_len, words)) + 2
        names = [self._named(node.name, own=bool(node.file)) for node in self._statuses]
        names += map(self._named, self.outside)
        name = max(map(cell_len, names), default=4)
        pid = max((len(str(node.pid or "")) for node in self._statuses), default=0)
        self._full = width >= name + FULL
        columns = [Column(_("Node"), name if self._full else 0), Column(_("State"), self._word)]
        if self._full:
            columns += [Column(_("Pid"), max(5, pid), right=True), Column(_("Up"), 6, right=True)]
            columns += [Column("↻", 2, right=True)]
        columns += [Column(_("CPU"), 5, right=True), Column(_("Memory"), 6, right=True)]
        if self._full:
            self._told = width >= name + TOLD
            columns.append(Column(_("Detail") if self._told else ""))
        rows = [Row(node.name, self._cells(node)) for node in self._statuses]
        self.show(columns, [*rows, *(Row(name, self._cells_of(name)) for name in self.outside)])
        self._tell_what_is_cut()

    def on_rows_highlighted(self) -> None:
        """Report the row that is chosen now."""
        self._tell_what_is_cut()

    def _tell_what_is_cut(self) -> None:
        cut = self._whole() if self.is_chosen_cut else ("", "")
        if cut != self._cut:
            self._cut = cut
            self.post_message(self.Cut(*cut))

    def _whole(self) -> tuple[str, str]:
        """Return the name of the chosen node, and its full state."""
        node = next((node for node in self._statuses if node.name == self.chosen), None)
        if node is None:
            sign, word = OUTSIDE
            word = self._state(self.chosen, _(word))
            return (self.chosen, f"{sign} {word} · {_('not started by Deck')}")
        return (node.name, f"{self._signed(node)} · {why(node)}")

    def _signed(self, node: NodeStatus) -> str:
        """Return sign and word of its state; one at work may have a lifecycle."""
        sign, word, _meaning = state_words(node)
        at_work = node.state in AT_WORK and ailing_words(node) is None
        return f"{sign} {self._state(node.name, _(word)) if at_work else _(word)}"

    def _state(self, name: str, word: str) -> str:
        """Return the state of the node's lifecycle, which says more than that it runs."""
        return plain(self._lifecycles.get(name.removeprefix("/"), word))

    def _named(self, name: str, *, own: bool = False) -> str:
        marks = (OWN if own else "") + (MUTED if name in self._muted else "")
        return f"{plain(name)} {marks}" if marks else plain(name)

    def _cells_of(self, name: str) -> tuple[Cell, ...]:
        """Return the row of a node that Deck did not start, of which only the name is known."""
        sign, word = OUTSIDE
        cells = [Cell(self._named(name)), Cell(f"{sign} {self._state(name, _(word))}", "dim")]
        cells += [Cell(UNKNOWN, "dim")] * (5 if self._full else 2)
        if self._full:
            cells.append(Cell(_("not started by Deck") if self._told else "", "dim"))
        return tuple(cells)

    def _cells(self, node: NodeStatus) -> tuple[Cell, ...]:
        state, (_sign, _word, meaning) = self._signed(node), state_words(node)
        name = Cell(self._named(node.name, own=bool(node.file)))
        if not node.state.alive or node.fault is not None:
            # One cell up to the edge: a long state would widen the column for all rows.
            told = f"{state:<{self._word}} {'✗ ' if node.fault else ''}{why(node)}"
            return (name, Cell(told, "bad" if node.fault else meaning))
        cells = [name, Cell(state, meaning)]
        if self._full:
            cells += [
                Cell("" if node.pid is None else str(node.pid), "dim"),
                Cell(duration(node.uptime_s), "dim"),
                Cell(str(node.restarts), "warn" if node.restarts else "dim"),
            ]
        cells += [Cell(percent(node.cpu_percent)), Cell(memory(node.memory_bytes))]
        if self._full:
            cells.append(Cell(why(node) if self._told else "", "dim"))
        return tuple(cells)


def lifecycle_states(rows: Iterable[LifecycleRow], session: Collection[str]) -> dict[str, str]:
    """Return the state of each node that has a lifecycle, by its name in the table.

    A node of the `session` may be in a namespace, which its name in the table does not have.
    """
    states: dict[str, str] = {}
    for row in rows:
        last = row.node.rpartition("/")[2]
        name = last if last in session else row.node.removeprefix("/")
        if row.state:
            states[name] = row.state
    return states
