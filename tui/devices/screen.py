"""Every driver, what it is connected to, and the traffic on the port of the chosen one."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar

from textual import on, work
from textual.widgets import Static

from graph.diagnostics import DiagnosticsBook
from launcher.status import Severity
from robot.frames.protocols import decode
from text import ros2_words
from text.i18n import N_, _
from text.ros_names import DIAGNOSTICS
from tui import clock
from tui.actions import bindings
from tui.devices import drivers
from tui.devices.actions import DEVICES_ACTIONS
from tui.devices.diagnostics import DiagnosticsView, worst_of
from tui.devices.drivers import Device, DevicesTable
from tui.devices.frame_rows import KEPT, WAYS, FrameRows, frame_columns
from tui.frame.screen import DeckScreen
from tui.log_view.pane import LogPane
from tui.log_view.view import LogView
from tui.widgets.rows import Rows
from tui.widgets.tab_line import TabEntry, TabLine

if TYPE_CHECKING:
    from collections.abc import Iterable

    from textual.app import ComposeResult

    from graph.data import GraphUpdate, Sample
    from tui.session.messages import GraphChanged, LanguageChanged, SessionChanged, StatusChanged

DRIVERS, TREE = "drivers", "tree"
"""The tabs."""
_LOOK_EVERY_S = 0.5
"""How often ages are updated, whether or not anything arrives."""


class DevicesScreen(DeckScreen):
    """Drivers above, the full report of the chosen one, its frames below."""

    tab: ClassVar[str] = "devices"
    parts: ClassVar[tuple[str, ...]] = ("LogPane",)
    about: ClassVar[str] = N_(
        "Every driver that reports its state on /diagnostics: its port, since when it is "
        "connected, bytes a second, errors in total and now. Below is the traffic on the port of "
        "the chosen driver, with the bytes: ~ marks noise, ✗ a frame whose check failed. Frames "
        "are requested only while they are shown. The arrow keys choose a driver or, after Tab, "
        "lines, several with Shift. The second tab has what everybody reports, as a tree with the "
        "worst on top, and since when."
    )
    BINDINGS: ClassVar = bindings(*DEVICES_ACTIONS)
    DEFAULT_CSS = """
    DevicesScreen {
        DevicesTable { height: auto; max-height: 40%; }
        DiagnosticsView { display: none; }
        &.-tree DiagnosticsView { display: block; }
        #devices-empty { height: 1fr; padding: 1 2; color: $text-muted; }
        #devices-chosen { height: auto; max-height: 3; padding: 0 1; background: $panel; }
    }
    DevicesScreen.-flat #devices-chosen { max-height: 1; }
    """

    def __init__(self) -> None:
        super().__init__()
        self.frames: FrameRows = FrameRows()
        self._diagnostics = DiagnosticsBook()
        self._update: GraphUpdate | None = None
        self._topic: str | None = None
        """Topic with the frames of the chosen driver."""
        self._shown_name = ""
        self._lessons: tuple[str, ...] | None = None
        """Lessons with drivers; None until they are needed."""

    def compose_body(self) -> ComposeResult:
        yield Static(id="devices-empty", markup=False)
        yield TabLine()
        yield DevicesTable()
        yield Static(id="devices-chosen", markup=False)
        yield LogPane(LogView(max_lines=KEPT, fold=False, columns_for=frame_columns))
        yield DiagnosticsView(self._diagnostics)

    @property
    def table(self) -> DevicesTable:
        return self.query_one(DevicesTable)

    @property
    def pane(self) -> LogPane:
        return self.query_one(LogPane)

    @property
    def chosen(self) -> Device | None:
        """The chosen driver, if drivers are shown."""
        if not self.is_mounted or self.shows_tree:
            return None
        record = self._diagnostics.get(self.table.chosen)
        return None if record is None else Device(record.status, self._diagnostics.heard_s(record))

    @property
    def has_diagnostics(self) -> bool:
        return bool(self._diagnostics.records)

    @property
    def shows_tree(self) -> bool:
        """Whether the diagnostics of everybody are shown in place of the drivers."""
        return self.has_class("-tree")

    @property
    def only_bad(self) -> bool:
        return self.pane.view.log_filter.minimum is not Severity.DEBUG

    def follow_topics(self) -> set[str]:
        """The reports of every driver, and the frames of the chosen one; nothing while hidden."""
        if self.feed.front is not self:
            return set()
        frames = set() if self._topic is None or self.shows_tree else {self._topic}
        return {DIAGNOSTICS} | frames

    def on_mount(self) -> None:
        self._name_lines()
        self.set_interval(_LOOK_EVERY_S, self._look)
        self._look()

    def on_screen_resume(self) -> None:
        """Excuse the drivers: nobody was listening while another screen was in front."""
        self._diagnostics.excuse(clock.now())
        self._look()

    def on_session_changed(self, message: SessionChanged) -> None:
        """Start a new session without drivers; keep those of a session that has ended."""
        del message
        session = self.feed.session
        if session is not None:
            self.pane.save_folder = session.log_dir
            self._diagnostics.clear()
            self._update = None
        self._look()

    def on_status_changed(self, message: StatusChanged) -> None:
        del message
        self._look()

    def on_graph_changed(self, message: GraphChanged) -> None:
        """Take in the reports and the frames."""
        self._update = message.update
        samples = message.update.samples
        self._diagnostics.take(samples.get(DIAGNOSTICS, ()))
        self._look()
        if self._topic is not None:
            self._take_frames(samples.get(self._topic, ()))

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self._show_way(None)
        self._lay_frames()
        self._name_lines()
        self._look()

    def on_resize(self) -> None:
        self.call_after_refresh(self._look)

    @on(Rows.Highlighted, "DevicesTable")
    def _chosen_changed(self) -> None:
        self._look()
        self.refresh_bindings()

    @on(Rows.Opened, "DevicesTable")
    def _go_to_frames(self) -> None:
        self.pane.view.focus()

    @on(Rows.Highlighted, "#tree")
    def _status_chosen(self) -> None:
        self.query_one(DiagnosticsView).show_chosen()

    @on(Rows.Opened, "#tree")
    def _go_to_facts(self) -> None:
        self.query_one(DiagnosticsView).facts.focus()

    @on(TabLine.Selected)
    def _tab_chosen(self, message: TabLine.Selected) -> None:
        self.show_tree(message.key == TREE)

    @on(LogView.StateChanged)
    def _keys_changed(self) -> None:
        self.refresh_bindings()

    def key_escape(self) -> None:
        """Go back to the list."""
        self._list.focus()

    # Actions

    async def ros2_command(self) -> str:
        return ros2_words.echo(DIAGNOSTICS) if self.has_diagnostics else ""

    def show_tree(self, shown: bool) -> None:
        """Show the diagnostics of everybody, or the drivers."""
        self.set_class(shown, "-tree")
        self._look()
        self._list.focus()
        self.topics_changed()
        self.refresh_bindings()

    @property
    def _list(self) -> Rows:
        return self.query_one(DiagnosticsView).names if self.shows_tree else self.table

    def next_way(self) -> None:
        ways = [None, *(_(word) for word in WAYS.values())]
        self._show_way(ways[(ways.index(self.pane.view.log_filter.only) + 1) % len(ways)])

    def _show_way(self, way: str | None) -> None:
        self.pane.view.log_filter = replace(self.pane.view.log_filter, only=way)

    def toggle_bad(self) -> None:
        minimum = Severity.DEBUG if self.only_bad else Severity.WARN
        self.pane.view.log_filter = replace(self.pane.view.log_filter, minimum=minimum)
        self.refresh_bindings()

    def toggle_hex(self) -> None:
        self.frames.as_hex = not self.frames.as_hex
        self._lay_frames()
        self.refresh_bindings()

    def clear_frames(self) -> None:
        self.frames.clear()
        self.pane.view.clear()

    @property
    def simulated(self) -> tuple[str, str] | None:
        """The simulated robot's node and the chosen one of its lines; None for a real device."""
        return drivers.simulated(self.chosen, self.feed)

    @work(group="trouble")
    async def switch_trouble(self, which: drivers.SimulatedTrouble) -> None:
        """Cause this trouble on the chosen device or clear it, and say which."""
        found, graph = self.simulated, self.feed.graph
        if found is None or graph is None:
            return
        made, error = await drivers.switch(graph, *found, which)
        told = _(which.told if made else which.over).format(device=found[1])
        self.notify(error or told, severity="error" if error else "information", markup=False)

    # Display

    def _take_frames(self, samples: Iterable[Sample]) -> None:
        fresh = [line for sample in samples for line in decode(str(sample.value.get("data", "")))[0]]
        if not fresh:
            return
        if self.frames.add(fresh):
            self._lay_frames()
        else:
            self.pane.view.append(self.frames.lines(fresh))

    def _lay_frames(self) -> None:
        self.pane.view.replace_lines(self.frames.lines())

    def _name_lines(self) -> None:
        self.pane.view.minimum_words = _("only noise and bad frames")
        self.pane.view.know_nodes(_(way) for way in WAYS.values())

    def _look(self) -> None:
        # Without its parts it is just being opened or closed.
        if not self.query(DevicesTable) or self.feed.front is not self:
            return
        devices, now_s = drivers.devices_of(self._diagnostics), clock.now()
        for widget in (self.table, self.query_one("#devices-chosen"), self.pane):
            widget.display = bool(devices) and not self.shows_tree
        self._show_tabs(len(devices), now_s)
        empty = self.query_one("#devices-empty", Static)
        empty.display = not devices
        if not devices:
            empty.update("\n".join(drivers.nobody(self.feed, self._update, self._lessons or ())))
            if self._lessons is None:
                self._lessons = ()
                self.run_worker(self._find_lessons())
            return
        if self.focused is None:
            self._list.focus()
        if self.shows_tree:
            self.query_one(DiagnosticsView).redraw()
            return
        self.table.show_devices(devices, now_s)
        self._show_chosen(now_s)

    def _show_tabs(self, devices: int, now_s: float) -> None:
        self._diagnostics.look(now_s)
        tabs = self.query_one(TabLine)
        tabs.display = bool(devices)
        told = len(self._diagnostics.records)
        entries = (
            TabEntry(DRIVERS, _("Drivers") + f" {devices}"),
            TabEntry(TREE, _("Diagnostics") + f" {told}", worst_of(self._diagnostics)),
        )
        tabs.show_tabs(TREE if self.shows_tree else DRIVERS, entries)

    def _show_chosen(self, now_s: float) -> None:
        device = self.chosen
        if device is None:
            return
        topic = drivers.frames_topic(device, () if self._update is None else self._update.topics)
        if device.report.name != self._shown_name:
            self._shown_name = device.report.name
            self.clear_frames()
        if topic != self._topic:
            self._topic = topic
            self.topics_changed()
        whole = self.query_one("#devices-chosen", Static)
        whole.update(drivers.report_words(device, now_s, self.size.width - 2))
        self._say_why_empty(drivers.no_frames(device, topic, now_s))

    def _say_why_empty(self, why: str) -> None:
        view = self.pane.view
        if why != view.empty_words:
            view.empty_words = why
            if not view.ring.entries:
                view.refresh()

    async def _find_lessons(self) -> None:
        self._lessons = await asyncio.to_thread(drivers.lessons_with_drivers)
        self._look()
