"""The log of all nodes: filtered, searched, copied, saved to a file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from time import monotonic
from typing import ClassVar

from textual import getters, on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal

from launcher.status import Severity
from text import ros2_words
from text.i18n import N_, _, decimal
from text.plain import plain
from tui.actions import bindings
from tui.frame.screen import DeckScreen
from tui.log_view.index import LogFilter
from tui.log_view.pane import LogPane
from tui.log_view.view import LogView
from tui.logs.actions import LOGS_ACTIONS
from tui.session.messages import LanguageChanged, LogArrived, SessionChanged, StatusChanged
from tui.widgets.rows import Cell, Column, Row, Rows

COUNTS_EVERY_S = 0.5
HEARD, MUTE, ALONE = "●", "○", "★"


class LogNodes(Rows):
    """One row for each node: its mark, name, number of lines, warnings and errors.

    `Opened` means that the chosen node is to be muted or unmuted.
    """

    DEFAULT_CSS = """
    LogNodes { background: $surface; }
    """

    def show_nodes(self, names: Iterable[str], counts: Mapping[str, Sequence[int]], chosen: LogFilter) -> None:
        columns = (
            Column("", 1),
            Column(_("node")),
            Column(_("lines"), 6, right=True),
            Column(_("alarms"), 7, right=True),
        )
        self.show(columns, [_row(name, counts.get(name, ()), chosen) for name in names])


def _row(name: str, counts: Sequence[int], chosen: LogFilter) -> Row:
    heard = chosen.shows_node(name)
    mark = (ALONE if chosen.only == name else HEARD) if heard else MUTE
    meaning = "" if heard else "dim"
    errors = sum(counts[Severity.ERROR.rank :])
    warnings = sum(counts[Severity.WARN.rank : Severity.ERROR.rank])
    alarms = " ".join(f"{letter}{short_count(count)}" for letter, count in (("W", warnings), ("E", errors)) if count)
    alarm_meaning = ("bad" if errors else "warn") if alarms and heard else meaning
    return Row(
        name,
        (
            Cell(mark, meaning),
            Cell(plain(name), meaning),
            Cell(short_count(sum(counts)), meaning),
            Cell(alarms, alarm_meaning),
        ),
    )


def short_count(count: int) -> str:
    """A count in at most four characters: 999, 1.2k, 12k, 1.2M."""
    for size, letter in ((1_000_000, "M"), (1_000, "k")):
        if count >= size:
            value = count / size
            return decimal(f"{value:.1f}{letter}") if value < 10 else f"{int(value)}{letter}"
    return str(count)


class LogsScreen(DeckScreen):
    """The log of every node, with the nodes on the left; on a narrow screen only on request."""

    tab: ClassVar[str] = "logs"
    parts: ClassVar[tuple[str, ...]] = ("LogPane",)
    about: ClassVar[str] = N_(
        "The messages of all nodes. The arrow keys select lines, with Shift several; that pauses "
        "the log, End follows it again. The list has the nodes with their lines, warnings (W) and "
        "errors (E): ● is shown, ○ is muted, ★ is shown alone."
    )
    BINDINGS: ClassVar[list[BindingType]] = [*bindings(*LOGS_ACTIONS), Binding("escape", "close_nodes", show=False)]
    DEFAULT_CSS = """
    LogsScreen LogNodes {
        width: 38;
        border-right: vkey $panel;
    }
    LogsScreen.-wide LogNodes { width: 46; }
    LogsScreen.-compact LogNodes, LogsScreen.-tiny LogNodes {
        display: none;
        layer: overlay;
        dock: left;
        width: 42;
        max-width: 100%;
        height: auto;
        max-height: 80%;
        border: round $primary;
    }
    LogsScreen.-compact LogNodes.-open, LogsScreen.-tiny LogNodes.-open { display: block; }
    """

    AUTO_FOCUS: ClassVar[str] = "LogView"
    _counted_s = 0.0

    def compose_body(self) -> ComposeResult:
        with Horizontal():
            yield LogNodes()
            yield LogPane(LogView(file_of=self.feed.log_file))

    pane: getters.query_one[LogPane] = getters.query_one(LogPane)
    node_list = getters.query_one(LogNodes)

    @property
    def chosen_node(self) -> str | None:
        """The node that actions apply to: that of the focused list, else the chosen line's."""
        if self.node_list.has_focus:
            return self.node_list.chosen or None
        return self.pane.view.choice.node

    def on_mount(self) -> None:
        self.pane.view.focus()
        self.set_interval(COUNTS_EVERY_S, self._show_nodes)

    def on_session_changed(self, message: SessionChanged) -> None:
        """Start a new session with an empty log; keep the lines of a session that has ended."""
        del message
        session = self.feed.session
        if session is not None:
            self.pane.save_folder = session.log_dir
            if self.pane.view.ring.entries:
                self.pane.view.clear()

    def on_status_changed(self, message: StatusChanged) -> None:
        self.pane.view.know_nodes(message.nodes)
        self._show_nodes()

    def on_log_arrived(self, message: LogArrived) -> None:
        self.pane.view.append(message.lines, message.skipped)
        if monotonic() - self._counted_s > COUNTS_EVERY_S:
            self._counted_s = monotonic()
            self._show_nodes()

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self._show_nodes()

    @on(LogView.StateChanged)
    def _keys_changed(self) -> None:
        self.refresh_bindings()

    @on(LogNodes.Highlighted)
    def _node_changed(self) -> None:
        self.refresh_bindings()

    @on(LogNodes.Opened)
    def _mute(self, event: LogNodes.Opened) -> None:
        self.choose(self.pane.view.log_filter.toggled(event.key))

    async def ros2_command(self) -> str:
        nodes = [name for name in self.feed.nodes if self.pane.view.log_filter.shows_node(name)]
        alone = len(nodes) == 1 and len(self.feed.nodes) > 1
        return ros2_words.log_of(nodes[0] if alone else "")

    def choose(self, chosen: LogFilter) -> None:
        self.pane.view.log_filter = chosen
        self._show_nodes()

    def toggle_nodes(self) -> None:
        if self.node_list.has_focus:
            self.action_close_nodes()
        else:
            self.node_list.add_class("-open")
            self.node_list.focus()

    def action_close_nodes(self) -> None:
        self.node_list.remove_class("-open")
        self.pane.view.focus()

    def _show_nodes(self) -> None:
        view = self.pane.view
        names = dict.fromkeys((*self.feed.nodes, *self.feed.outside.now, *view.ring.counts))
        self.node_list.show_nodes(names, view.ring.counts, view.log_filter)
