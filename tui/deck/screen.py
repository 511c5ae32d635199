"""The running lesson: its nodes, the panels that its profile names, and the log."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar

from textual import on, work
from textual.binding import Binding
from textual.containers import Container, Vertical
from textual.widgets import Static

from graph.observer.requests import Publish
from launcher.errors import LauncherError
from launcher.profile.panels import PANELS, panels_for
from launcher.status import NodeState, Severity
from text import ros2_words
from text.i18n import N_, _, localized
from text.plain import plain
from text.robot import robot
from text.sentences import reason_of
from tui.actions import bindings
from tui.deck.actions import DECK_ACTIONS
from tui.deck.command_line import CommandLine
from tui.deck.lesson_beside import LessonBesideNodes
from tui.deck.nodes_table import NodesTable, lifecycle_states
from tui.deck.watched import Watched
from tui.editing import edit_node
from tui.frame.screen import DeckScreen
from tui.log_view.pane import LogPane
from tui.log_view.view import LogView
from tui.panels.panel import row_of
from tui.panels.panel_grid import PanelGrid
from tui.session.messages import SessionChanged
from tui.session.past import TRENDS
from tui.session.words import node_command
from tui.teleop.actions import TELEOP_ACTIONS, open_teleop
from tui.teleop.dock import TeleopDock
from tui.widgets.name_head import NameHead
from tui.widgets.node_words import fault_lines
from tui.widgets.words import word_strips

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from concurrent.futures import Future

    from textual.app import ComposeResult
    from textual.binding import BindingType
    from textual.events import Resize
    from textual.widget import Widget

    from graph.data import GraphUpdate
    from graph.inner_states import LifecycleRow
    from launcher.status import SessionInfo
    from tui.actions import Action
    from tui.emergency.messages import EmergencyChanged
    from tui.log_view.index import LogFilter
    from tui.panels.panel import Panel
    from tui.session.messages import GraphChanged, LanguageChanged, LogArrived, StatusChanged
    from tui.widgets.rows import Rows

COMMANDS_TYPE = "std_msgs/msg/String"
SMALL = (60, 18)
"""Columns and rows of the terminal below which panels are hidden."""
LOG_LINES = 1000
"""What is older is on the screen of the log."""


class LessonDeck(DeckScreen):
    """Nodes above the log, panels on the right; on a small terminal panels beside the log."""

    AUTO_FOCUS: ClassVar[str] = "NodesTable"
    tab: ClassVar[str] = "deck"
    parts: ClassVar[tuple[str, ...]] = ("#nodes", "LogPane", "LessonColumn")
    about: ClassVar[str] = N_(
        "The lesson at work. The table has the lesson's nodes: choose one with the arrow keys "
        "to start, stop or restart it, or to show only its lines in the log. The panels show "
        "what the nodes publish on their topics."
    )
    BINDINGS: ClassVar[list[BindingType]] = [
        *bindings(*DECK_ACTIONS, open_teleop),
        Binding("escape", "leave_field", show=False),
    ]
    DEFAULT_CSS = """
    LessonDeck {
        #desk { height: 1fr; layout: horizontal; }
        #board { layout: grid; width: 2fr; height: 1fr; grid-size: 1; grid-gutter: 0 1; }
        &.-with-panels #board { grid-size: 2; grid-columns: 11fr 9fr; }
        #nodes { height: 1fr; }
        #nodes NameHead { display: none; max-height: 100%; }
        #panel-grid { display: none; height: 1fr; }
        &.-with-panels #panel-grid { display: block; }
        #talk { height: 1fr; }
        &.-flat #teleop { height: 4; }
        #command { display: none; padding: 0 1; border-top: none; background: $panel; }
        &.-driven #command { display: block; }
        &.-home.-with-panels #panel-grid, &.-wide.-with-panels #panel-grid { row-span: 2; }
        &.-recorded.-with-panels #panel-grid { row-span: 1; }
        &.-compact.-with-panels #nodes { column-span: 2; }
        &.-compact.-with-panels #board { grid-columns: 2fr 3fr; }
        #small { display: none; height: 1; width: 1fr; color: $text-warning; }
        &.-small #panel-grid { display: none; }
        &.-small #board { grid-size: 1; }
        &.-small.-with-panels #small { display: block; }
        &.-recorded #nodes, &.-recorded #talk { display: none; }
        #watched { display: none; height: auto; padding: 0 1; color: $text-muted; }
        &.-watching #watched { display: block; }
        &.-watching #nodes { display: none; }
        &.-watching.-with-panels #panel-grid { row-span: 1; }
        &.-recorded.-with-panels #board { grid-size: 1; grid-columns: 1fr; }
    }
    """

    _cut: tuple[str, str] = ("", "")
    """Name and state of the chosen node, if the table cannot show them in full."""
    _lifecycles: tuple[LifecycleRow, ...] = ()
    _offered_for: tuple[NodeState | None, str] = (None, "")
    """State and own file of the chosen node for which its keys were last updated."""

    def __init__(self) -> None:
        super().__init__()
        self._grid = PanelGrid(id="panel-grid")
        self._put: set[str] = set()
        """Panels that were added for topics that others publish."""
        self._watched: Watched | None = None
        self._dock = TeleopDock(self, self.focus_usual)
        self._beside = LessonBesideNodes(self)

    def compose_body(self) -> ComposeResult:
        """The nodes above the log; the session adds the panels."""
        yield Static(id="small", markup=False)
        yield Static(id="watched", markup=False)
        with Container(id="desk"), Container(id="board"):
            with Vertical(id="nodes"):
                yield NodesTable()
                yield NameHead()
            yield self._grid
            with Vertical(id="talk"):
                yield LogPane(LogView(max_lines=LOG_LINES, file_of=self.feed.log_file))
                if robot().words:
                    yield CommandLine(id="command")

    # Actions

    @property
    def table(self) -> NodesTable:
        return self.query_one(NodesTable)

    @property
    def pane(self) -> LogPane:
        return self.query_one(LogPane)

    @property
    def chosen_node(self) -> str:
        """The chosen node, empty without a session."""
        if self.feed.link is None:
            return ""
        return next((table.chosen for table in self.query(NodesTable)), "")

    @property
    def chosen_state(self) -> NodeState | None:
        """The state of the chosen node; None without one, or if Deck did not start it."""
        node = self.feed.nodes.get(self.chosen_node)
        return None if node is None else node.state

    @property
    def chosen_file(self) -> str:
        """The learner's own file that the chosen node runs, empty for other nodes."""
        node = self.feed.nodes.get(self.chosen_node)
        return "" if node is None else node.file

    @work(exclusive=True, group="exchange")
    async def exchange(self) -> None:
        """Run the user's own file in place of the chosen node, or Deck's node again."""
        # Not needed for the first frame.
        from tui.deck.exchange import exchange_node

        node = self.feed.nodes.get(self.chosen_node)
        if node is not None:
            await exchange_node(self, node)

    def edit(self) -> None:
        """Open the file of the chosen node in an editor, at the line of its mistake."""
        node = self.feed.nodes.get(self.chosen_node)
        if node is not None and node.file:
            edit_node(self, node)

    @work(group="ask")
    async def ask(self, what: str, *names: str) -> None:
        """Ask the session to `start`, `stop` or `restart` these nodes, or all if none is named."""
        if self.feed.link is None:
            return
        try:
            await getattr(self.feed.link, what)(*names)
        except LauncherError as error:
            self.notify(plain(localized(reason_of(error))), severity="error", markup=False)

    @property
    def log_filter(self) -> LogFilter:
        return self.pane.view.log_filter

    def filter_log(self, chosen: LogFilter) -> None:
        self.pane.view.log_filter = chosen
        self._show_nodes()

    def hear_all(self) -> None:
        """Show the log of every node, at every severity."""
        self.filter_log(replace(self.log_filter.all_nodes(), minimum=Severity.DEBUG))

    @property
    def driven(self) -> bool:
        """Whether there is a node that takes commands in words."""
        if self.feed.watching:
            row = None if self.feed.update is None else row_of(self.feed.update, robot().words)
            return row is not None and row.subscribers > 0
        if self.feed.link is None:
            return False
        return any("words" in (node.roles or robot().named(node.name)) for node in self.feed.nodes.values())

    def write_command(self) -> None:
        """Focus the command line at once, so that it receives the next key."""
        self.set_focus(self.query_one(CommandLine).field)

    async def ros2_command(self) -> str:
        """Return what sends the command that is being typed, plays the recording, starts a node."""
        for line in self.query(CommandLine):
            if line.field.has_focus:
                return ros2_words.pub(robot().words, COMMANDS_TYPE, {"data": line.field.value.strip()})
        if self.feed.replay is not None and self.feed.link is not None:
            return ros2_words.play(self.feed.link.session.profile)
        name = self.chosen_node
        status = self.feed.nodes.get(name)
        if status is None or self.feed.link is None:
            return ros2_words.node_info(f"/{name.lstrip('/')}") if name else ""
        return await node_command(self.feed.link.session, status)

    def on_command_line_command_sent(self, message: CommandLine.CommandSent) -> None:
        if self.feed.graph is None:
            return
        sent = self.feed.graph.ask(Publish(robot().words, COMMANDS_TYPE, {"data": message.text}))
        sent.add_done_callback(lambda done: self.app.call_later(self._tell_if_lost, done))

    def _tell_if_lost(self, sent: Future[int]) -> None:
        error = None if sent.cancelled() else sent.exception()
        if isinstance(error, Exception):
            # Not needed for the first frame.
            from tui.yaml_form.words import reason_words

            self.notify(reason_words(error), severity="error", markup=False)

    def focus_usual(self) -> None:
        self.table.focus()

    def action_leave_field(self) -> None:
        """Go back to the nodes."""
        self.focus_usual()

    @property
    def panels(self) -> Sequence[Panel]:
        """All panels, shown or not."""
        return self._grid.panels

    @property
    def pages(self) -> int:
        return 0 if self.has_class("-small") else self._grid.pages

    def turn_page(self) -> None:
        """Show the next page of panels, or the next panel in the place of an enlarged one."""
        if not self.shows_one_panel:
            self._grid.turn()
        elif (panel := self._grid.choose_next(1)) is not None:
            self.enlarge(panel)

    @property
    def sees_nodes(self) -> bool:
        """Whether the nodes are not hidden behind another part of the screen."""
        return self.maximized is None or self.maximized.id == "nodes"

    @property
    def shows_one_panel(self) -> bool:
        return self.maximized in self.panels

    def part_to_enlarge(self) -> Widget | None:
        """Return the part that has the focus; without nodes, the chosen panel."""
        usual, panel = super().part_to_enlarge(), self._grid.chosen if self.pages else None
        in_panels = self._grid.has_focus or self.focused is None
        return panel if panel is not None and in_panels else usual

    @on(PanelGrid.PanelWanted)
    def _panel_wanted(self, message: PanelGrid.PanelWanted) -> None:
        self.enlarge(message.panel)

    @property
    def fits_lesson(self) -> bool:
        """Whether there is room for the lesson beside the nodes."""
        return self._beside.fits

    async def toggle_lesson(self) -> None:
        """Show the lesson beside the nodes, or not any more."""
        await self._beside.toggle()

    async def open_teleop(self) -> None:
        """Open the panel for driving with keys."""
        await self._dock.open()

    async def on_teleop_panel_closed(self) -> None:
        await self._dock.close()

    def more_keys(self) -> Iterable[tuple[str, Sequence[Action[Any]]]]:
        yield _("Keys while driving"), TELEOP_ACTIONS

    # Display

    def watch_topics(self) -> set[str]:
        return set().union(*(panel.watched() for panel in self.panels)) | self._dock.topics

    def picture_topics(self) -> set[str]:
        """The topics of the panels with pictures that are on the screen."""
        return set().union(*(panel.pictures() for panel in self.panels))

    def keep_topics(self) -> set[str]:
        """The topics whose history a panel shows."""
        return set().union(*(panel.kept() for panel in self.panels))

    def past_topics(self) -> set[str]:
        return set(TRENDS)

    def follow_topics(self) -> set[str]:
        """The topics of which the panels need every message."""
        return set().union(*(panel.followed() for panel in self.panels))

    def on_resize(self, event: Resize) -> None:
        """Hide the panels if they do not fit."""
        self.set_class(event.size.width < SMALL[0] or event.size.height < SMALL[1], "-small")
        self._beside.measure_room()
        # Without its parts it is just being opened or closed.
        if self.query(NameHead):
            self._lay_out(event.size.height)

    @on(SessionChanged)
    async def _session_changed(self, message: SessionChanged) -> None:
        """Create what belongs to the session; without one there is nothing to drive."""
        await self._bring_panels()
        await self._beside.session_changed(message)
        if message.ended or self.feed.link is None:
            await self._dock.close()

    async def _bring_panels(self) -> None:
        """Create the panels of the session; those of one that has ended keep what they showed."""
        session = self.feed.session
        if session is None:
            return
        if self.pane.view.ring.entries:
            self.pane.view.clear()
        self.pane.save_folder = session.log_dir
        self.set_class(self.feed.replay is not None, "-recorded")
        self.set_class(self.feed.watching, "-watching")
        self._put.clear()
        self._watched = None
        await self._put_up(session.panels)
        self._lay_out(self.size.height)
        self.topics_changed()

    async def _put_up(self, names: Iterable[str]) -> None:
        if self.shows_one_panel:
            self.minimize()
        await self._grid.put_up(names)
        self.set_class(bool(self.panels), "-with-panels")
        self._say_small()

    def _say_small(self) -> None:
        words = _("Too small for panels: they need {columns}×{rows}")
        self.query_one("#small", Static).update(words.format(columns=SMALL[0], rows=SMALL[1]))

    async def _watch(self, update: GraphUpdate, session: SessionInfo) -> None:
        """Say which nodes run, and add panels for topics that have appeared; none is removed."""
        if self._watched is None:
            self._watched = Watched(session.domain, beyond=session.discovery != "localhost")
        words, watched = self._watched.words(update), self.query_one("#watched", Static)
        # Updating a Static repeats the layout of the screen, and graph updates are frequent.
        if words != watched.content:
            watched.update(words)
        wanted = panels_for({row.name for row in update.topics if row.publishers})
        if not self._put.issuperset(wanted):
            self._put |= set(wanted)
            await self._put_up([name for name in PANELS if name in self._put])
            self._lay_out(self.size.height)
            self.topics_changed()

    def on_status_changed(self, message: StatusChanged) -> None:
        """Show the new states of the nodes."""
        self.set_class(self.driven, "-driven")
        self.pane.view.know_nodes(message.nodes)
        self._beside.status_changed()
        self._show_nodes()
        self._lay_out(self.size.height)
        if self._offered_for != (self.chosen_state, self.chosen_file):
            self._offered_for = (self.chosen_state, self.chosen_file)
            self.refresh_bindings()

    def on_log_arrived(self, message: LogArrived) -> None:
        self.pane.view.append(message.lines, message.skipped)

    async def on_graph_changed(self, message: GraphChanged) -> None:
        """Update the panels; if ROS fails, say so in their place."""
        if message.update.error:
            self.notify(localized(message.update.error), severity="error", markup=False)
            return
        if self.feed.watching and self.feed.session is not None:
            self.set_class(self.driven, "-driven")
            await self._watch(message.update, self.feed.session)
        for panel in self.panels:
            panel.take(message.update, seen=self.feed.front is self)
        is_new = self.table.outside != self.feed.outside.now
        if is_new or message.update.lifecycles != self._lifecycles:
            self._show_nodes()
        if is_new:
            self._lay_out(self.size.height)
            self.refresh_bindings()
        row = row_of(message.update, robot().words)
        for line in self.query(CommandLine):
            line.show_listeners(0 if row is None else row.subscribers)
        self._dock.take(message.update)

    def on_emergency_changed(self, message: EmergencyChanged) -> None:
        """A stop also ends what the keys asked for; other changes of the gate do not."""
        if message.emergency.engaged:
            self._dock.release()

    def on_screen_suspend(self) -> None:
        """Another screen, or a dialog, now receives the keys."""
        self._dock.release()

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self._show_nodes()
        self._lay_out(self.size.height)
        self._say_small()

    def on_rows_highlighted(self, message: Rows.Highlighted) -> None:
        """Update the possible keys, and what is said of the node."""
        message.stop()
        self._lay_out(self.size.height)
        self.refresh_bindings()

    def on_nodes_table_cut(self, message: NodesTable.Cut) -> None:
        """Show below the table the text that does not fit in it."""
        message.stop()
        self._cut = (message.node, message.facts)
        self._lay_out(self.size.height)

    def on_rows_opened(self, message: Rows.Opened) -> None:
        """Show only the log of the opened node."""
        message.stop()
        self.filter_log(self.log_filter.alone(message.key))

    def _show_nodes(self) -> None:
        chosen = self.log_filter
        nodes, outside = self.feed.nodes, self.feed.outside.now
        muted = [name for name in (*nodes, *outside) if not chosen.shows_node(name)]
        self._lifecycles = () if self.feed.update is None else self.feed.update.lifecycles
        self.table.show_nodes(nodes, muted, outside, lifecycle_states(self._lifecycles, nodes))

    def _lay_out(self, height: int) -> None:
        """Give the table of nodes the rows it needs, but not too much of the screen."""
        if self.feed.replay is not None or self.feed.watching:
            self.query_one("#board").styles.grid_rows = "1fr"
            return
        wanted = len(self.feed.nodes) + len(self.feed.outside.now) + 1
        rows = max(2, min(wanted, height * 9 // 20)) + self._lay_out_head(height // 4)
        self.query_one("#board").styles.grid_rows = f"{rows} 1fr"

    def _lay_out_head(self, most: int) -> int:
        """Reserve lines for the mistake of the chosen node, or for the text that the table has cut.

        Return how many.
        """
        head, width = self.query_one(NameHead), self.table.size.width - 2
        node = self.feed.nodes.get(self.chosen_node)
        fault = [] if node is None else fault_lines(node)
        head.display = any(self._cut) or bool(fault)
        if not head.display:
            return 0
        if fault:
            head.show_lines(fault)
            wanted = sum(line.get_height({}, max(1, width)) for line in fault)
            most += 2
        else:
            head.show(*self._cut)
            wanted = len(word_strips(self._cut, width, self.rich_style, self.app.console))
        lines = max(1, min(wanted, most))
        head.styles.height = lines
        return lines
