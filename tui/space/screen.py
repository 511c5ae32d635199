"""What is where: frames, the robot, its map and what its sensors see."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from typing import ClassVar

from textual import getters, on
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.content import Content
from textual.widgets import Static

from graph.observer.requests import PreparePublisher, Publish
from text import ros2_words
from text.i18n import N_, _, decimal
from text.plain import plain
from tui import clock
from tui.actions import bindings
from tui.dialogs.choice import ChoiceScreen
from tui.emergency.messages import EmergencyChanged
from tui.frame.screen import DeckScreen
from tui.panels.panel import row_of
from tui.session.messages import GraphChanged, LanguageChanged, SessionChanged
from tui.space.actions import SPACE_ACTIONS, disarm, publish_aim
from tui.space.aiming import GOAL, LONGEST, Aim, AimKind, armed_words, sent_words
from tui.space.layers import CLOUD
from tui.space.rows import FRAMES, LayerRows
from tui.space.stage import Stage
from tui.space.view import SpaceView
from tui.widgets.canvas import scale_bar
from tui.widgets.trouble import listeners
from tui.yaml_form.words import reason_words

SENT_WITHIN_S = 3.0
PERIOD_S, CLOUD_PERIOD_S = 0.1, 0.06
"""Clouds come ten times a second: looking as often as that would miss some of them."""
NO_FRAME = " "
"""The answer for no frame, which no frame can be called."""


class SpaceScreen(DeckScreen):
    """The picture, the layers beside it, and a line about the view."""

    tab: ClassVar[str] = "space"
    about: ClassVar[str] = N_(
        "What is where: frames with their axes (x red, y green, z blue), the map, scans, clouds, "
        "paths and markers, from above, each placed by /tf. Arrows or a drag move the picture, + and - or the "
        "wheel zoom. Tab goes to the layers and back; below each layer is what is wrong with it."
    )
    parts: ClassVar[tuple[str, ...]] = ("#space-picture", "LayerRows")
    period_s = PERIOD_S
    wants_frames = True
    BINDINGS: ClassVar = bindings(*SPACE_ACTIONS)
    DEFAULT_CSS = """
    SpaceScreen {
        #space-body { height: 1fr; }
        #space-picture { width: 1fr; height: 1fr; }
        #space-status { height: 1; padding: 0 1; color: $text-muted; }
        #space-armed {
            height: 2; padding: 0 1; background: $warning; color: auto 90%; text-style: bold;
        }
        &.-wide LayerRows { width: 40; }
        &.-tiny LayerRows { display: none; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self.stage = Stage()

    def compose_body(self) -> ComposeResult:
        with Horizontal(id="space-body"):
            with Vertical(id="space-picture"):
                yield SpaceView(lambda *seen: self.stage.picture(self.view.aim, *seen))
                yield Static(id="space-status", markup=False)
            yield LayerRows()
        yield Static(id="space-armed", markup=False)

    view = getters.query_one(SpaceView)
    layer_rows = getters.query_one(LayerRows)

    @property
    def armed(self) -> bool:
        return self.is_mounted and self.view.aim is not None

    # What is watched

    def watch_topics(self) -> set[str]:
        return self.stage.layers.watched()

    def follow_topics(self) -> set[str]:
        """Those whose messages build on each other; nothing while another screen is in front."""
        return self.stage.layers.followed() if self.feed.front is self else set()

    def on_mount(self) -> None:
        self.view.focus()
        self._show_armed()
        self._show_status()

    def on_screen_resume(self) -> None:
        """Forget what was not heard of while another screen was in front."""
        for layer in self.stage.layers:
            if layer.every:
                layer.forget()

    def on_screen_suspend(self) -> None:
        """Disarm: what is not seen must not be published."""
        self.disarm()

    def on_session_changed(self, message: SessionChanged) -> None:
        """Start a new session with an empty space; keep that of a session that has ended."""
        del message
        self.disarm()
        if self.feed.session is not None:
            self.stage = Stage()
            self.view.recorded = self.feed.replay is not None
            self.view.fit(None, anew=True)
            self.show()

    def on_emergency_changed(self, message: EmergencyChanged) -> None:
        if message.emergency.engaged and self.armed:
            self.disarm()
            self.notify(self.refusal, severity="warning", markup=False)

    def on_graph_changed(self, message: GraphChanged) -> None:
        update = message.update
        came = self.stage.take(update, clock.now())
        if self.stage.sent is not None and update.samples.get(self.stage.sent[1].kind.topic):
            self.stage.sent = None
        if came:
            self.topics_changed()
        if self.feed.front is self:
            self.show()

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self.show()

    @on(SpaceView.CameraMoved)
    def _camera_moved(self) -> None:
        self.show(by_user=True)

    @on(SpaceView.PointerMoved)
    def _pointer_moved(self) -> None:
        self._show_status()

    @on(SpaceView.Aimed)
    def _aimed(self, message: SpaceView.Aimed) -> None:
        self.view.renew(by_user=True)
        self._show_armed()
        if message.done:
            self.publish_aim()

    @on(LayerRows.Opened)
    def _layer_opened(self) -> None:
        self.toggle_layer()

    # Actions

    async def ros2_command(self) -> str:
        layer = self.stage.layers.get(self.layer_rows.chosen)
        return "" if layer is None else ros2_words.echo(layer.topic)

    def fit(self) -> None:
        self.stage.follow_frame("")
        self.stage.place(clock.now())
        self.view.fit(self.stage.extent(), anew=True)
        self.show(by_user=True)

    def ask_frame(
        self, title: Callable[[], str], none: Callable[[], str], take: Callable[[str | None], None]
    ) -> None:
        frames = sorted(self.stage.buffer.frames)
        if not frames:
            words_ = _("No frame is known yet: nobody publishes /tf.")
            self.notify(words_, severity="warning", markup=False)
            return
        choices = {NO_FRAME: f"({none()})", **{frame: plain(frame) for frame in frames}}
        self.app.push_screen(ChoiceScreen(title, lambda: _("Which frame?"), choices), take)

    def toggle_layer(self) -> None:
        chosen = self.layer_rows.chosen
        layer = self.stage.layers.get(chosen)
        if chosen == FRAMES:
            self.stage.show_frames = not self.stage.show_frames
        elif layer is not None:
            layer.on = not layer.on
            if not layer.on:
                layer.forget()
        self.layers_changed()

    def topics_changed(self) -> None:
        """Ask for the topics of the layers, and look more often if there is a cloud."""
        clouds = any(layer.on and layer.type_name == CLOUD for layer in self.stage.layers)
        self.period_s = CLOUD_PERIOD_S if clouds else PERIOD_S
        super().topics_changed()

    def layers_changed(self) -> None:
        self.topics_changed()
        self.show(by_user=True)

    # Goals. One may move a robot: nothing is published that was not armed, nothing while the emergency stop
    # is engaged or a recording is played, and nothing that the user does not see. Whatever happens, it is
    # disarmed rather than kept.

    @property
    def refusal(self) -> str:
        """Why nothing can be aimed or published now; empty if it can."""
        if self.feed.replay is not None:
            return _("This is a recording: there is nobody to send to.")
        if self.deck.emergency.state.engaged:
            return _("The emergency stop is engaged: release it first, then aim.")
        if not self.stage.fixed:
            return _("No frame is known yet, in which a place could be given.")
        return ""

    def arm(self, kind: AimKind) -> None:
        if reason := self.refusal:
            self.notify(reason, severity="warning", markup=False)
            return
        view = self.view
        view.aim = Aim(kind, view.camera.x_m, view.camera.y_m)
        if self.feed.graph is not None:
            prepared = self.feed.graph.ask(PreparePublisher(kind.topic, kind.type_name))
            # If it cannot be created, publishing reports that.
            prepared.add_done_callback(lambda future: future.cancelled() or future.exception())
        view.focus()
        self._aim_changed()

    def disarm(self) -> None:
        if self.armed:
            self.view.aim = None
            self._aim_changed()

    def publish_aim(self) -> None:
        """Publish what is aimed, unless that is not allowed any more; disarm in any case."""
        aim, graph, fixed, reason = self.view.aim, self.feed.graph, self.stage.fixed, self.refusal
        self.disarm()
        if aim is None or graph is None:
            return
        if reason:
            self.notify(reason, severity="warning", markup=False)
            return
        sent = graph.ask(Publish(aim.kind.topic, aim.kind.type_name, aim.message(fixed)))
        if aim.kind is GOAL:
            self.stage.sent = fixed, aim
        self._aim_changed()
        self.run_worker(self._confirm(sent, aim, fixed), group="sent")

    async def _confirm(self, sent: Future[int], aim: Aim, fixed: str) -> None:
        try:
            await asyncio.wait_for(asyncio.wrap_future(sent), SENT_WITHIN_S)
        except Exception as error:  # noqa: BLE001 - any failure is reported
            failure = reason_words(error)
        else:
            self.notify(sent_words(aim, fixed, len(self._listeners(aim.kind))), markup=False)
            return
        self.stage.sent = None
        self.notify(failure, severity="error", markup=False)

    def _listeners(self, kind: AimKind) -> list[str]:
        update = self.feed.update
        return listeners(None if update is None else row_of(update, kind.topic))

    def _aim_changed(self) -> None:
        self.show(by_user=True)
        self.refresh_bindings()

    # Display

    def show(self, *, by_user: bool = False) -> None:
        if not self.is_mounted:
            return
        view = self.view
        if self.stage.follow:
            view.camera = self.stage.followed(view.camera)
        self.stage.place(clock.now())
        if not self.stage.follow and view.aim is None:
            view.fit(self.stage.extent())
        view.renew(by_user=by_user)
        view.show_words(*self._why_empty())
        self.layer_rows.show_stage(self.stage)
        self._show_armed()
        self._show_status()

    def _why_empty(self) -> tuple[str, str]:
        if self.stage.buffer.frames or any(layer.heard for layer in self.stage.layers):
            return "", ""
        update = self.feed.update
        if update is not None and update.error:
            return self.feed.blind, plain(update.error, 400)
        return _("nothing to see yet"), _(
            "Nobody publishes frames (/tf), a map, a scan, a cloud, a path or markers. Lesson 6 "
            "and the profile robot do."
        )

    def _show_armed(self) -> None:
        line, aim = self.query_one("#space-armed", Static), self.view.aim
        line.display = aim is not None
        if aim is not None:
            keys = self.deck.keys_of(publish_aim)[0], self.deck.keys_of(disarm)[0]
            line.update(armed_words(aim, self.stage.fixed, self._listeners(aim.kind), keys))

    def _show_status(self) -> None:
        kept: list[str] = []
        for piece in self._status():
            if Content("  ".join([*kept, piece])).cell_length <= self.view.size.width - 2:
                kept.append(piece)
        self.query_one("#space-status", Static).update("  ".join(kept))

    def _status(self) -> Iterator[str]:
        """Return the pieces of the line below the picture, the most important first."""
        if (place := self.view.pointer_place) is not None:
            x, y = (decimal(f"{value:.2f}") for value in place)
            yield _("x {x}  y {y} m").format(x=x, y=y)
        yield "".join(ink.text for ink in scale_bar(self.view.camera.dots_per_m))
        if self.stage.follow:
            yield _("follows {frame}").format(frame=plain(self.stage.follow, LONGEST))
        fixed = plain(self.stage.fixed, LONGEST)
        yield _("in {frame}").format(frame=fixed) if fixed else _("no frame yet")
