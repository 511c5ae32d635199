"""Goals and initial poses: armed by a key, aimed in the picture, published once.

A goal may move a robot. Nothing is published that was not armed, nothing while the emergency stop
is engaged or a recording is played, and nothing that the user does not see: whatever happens, it
is disarmed rather than kept.
"""

from __future__ import annotations

import asyncio
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Protocol

from graph.observer.requests import PreparePublisher, Publish
from space.drawing.camera import Angle
from text.i18n import _, decimal
from tui.space import words
from tui.space.aim import Aim, AimKind
from tui.widgets.trouble import names
from tui.yaml_form.words import reason_words

if TYPE_CHECKING:
    from collections.abc import Coroutine
    from concurrent.futures import Future

    from textual.notifications import SeverityLevel

    from tui.frame.host import Host
    from tui.session.feed import Feed
    from tui.space.stage import Stage
    from tui.space.view import SpaceView

SENT_WITHIN_S = 3.0


class AimingTarget(Protocol):
    """The part of the Space screen in which is aimed."""

    stage: Stage

    @property
    def view(self) -> SpaceView:
        """The picture."""

    @property
    def feed(self) -> Feed:
        """The session and its graph."""

    @property
    def deck(self) -> Host:
        """The app."""

    @property
    def armed(self) -> bool:
        """Whether something is aimed."""

    def aim_changed(self) -> None:
        """Show what is aimed now."""

    def notify(self, message: str, *, severity: SeverityLevel = "information", markup: bool = True) -> None:
        """Show a notification."""

    def run_worker(self, work: Coroutine[Any, Any, None], *, group: str) -> object:
        """Do something that takes a while."""


class Aiming:
    """What the Space screen does about goals."""

    def __init__(self, screen: AimingTarget) -> None:
        self._screen = screen

    @property
    def refusal(self) -> str:
        """Why nothing can be aimed or published now; empty if it can."""
        screen = self._screen
        return words.refusal(
            recorded=screen.feed.replay is not None,
            engaged=screen.deck.emergency.state.engaged,
            fixed=screen.stage.fixed,
        )

    def arm(self, kind: AimKind) -> None:
        """Begin to aim in the middle of the picture, or say why that cannot be."""
        screen = self._screen
        if reason := self.refusal:
            screen.notify(reason, severity="warning", markup=False)
            return
        view = screen.view
        if view.camera.angle is Angle.SIDE:
            # From the side there is no place on the floor to point at.
            view.camera = replace(view.camera, angle=Angle.ABOVE)
        x_m, y_m, _z_m = view.camera.target
        view.aim = Aim(kind, x_m, y_m)
        if screen.feed.graph is not None:
            prepared = screen.feed.graph.ask(PreparePublisher(kind.topic, kind.type_name))
            # If it cannot be created, publishing reports that.
            prepared.add_done_callback(lambda future: future.cancelled() or future.exception())
        view.focus()
        screen.aim_changed()

    def disarm(self) -> None:
        if self._screen.armed:
            self._screen.view.aim = None
            self._screen.aim_changed()

    def publish(self) -> None:
        """Publish what is aimed, unless that is not allowed any more; disarm in any case."""
        screen = self._screen
        aim, graph, fixed = screen.view.aim, screen.feed.graph, screen.stage.fixed
        reason = self.refusal
        self.disarm()
        if aim is None or graph is None:
            return
        if reason:
            screen.notify(reason, severity="warning", markup=False)
            return
        sent = graph.ask(Publish(aim.kind.topic, aim.kind.type_name, aim.message(fixed)))
        if aim.kind is AimKind.GOAL:
            screen.stage.sent = fixed, aim
        screen.aim_changed()
        screen.run_worker(self._confirm(sent, aim, fixed), group="sent")

    def listeners(self, kind: AimKind) -> list[str]:
        """Return who hears what is published, all in one text; nothing if nobody does."""
        update = self._screen.feed.update
        rows = () if update is None else update.topics
        row = next((one for one in rows if one.name == kind.topic), None)
        if row is None or not row.subscribers:
            return []
        return [names(row.subscribed_by) or str(row.subscribers)]

    async def _confirm(self, sent: Future[int], aim: Aim, fixed: str) -> None:
        screen = self._screen
        try:
            await asyncio.wait_for(asyncio.wrap_future(sent), SENT_WITHIN_S)
        except asyncio.TimeoutError:
            seconds = decimal(f"{SENT_WITHIN_S:g}")
            failure = _("ROS did not accept it within {n} s").format(n=seconds)
        except Exception as error:  # noqa: BLE001 - any failure is reported
            failure = reason_words(error)
        else:
            told = words.sent(aim, fixed, len(self.listeners(aim.kind)))
            screen.notify(told, markup=False)
            return
        screen.stage.sent = None
        screen.notify(failure, severity="error", markup=False)
