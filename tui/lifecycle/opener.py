"""Live sessions: the supervisor and the observer behind the screen's two ports.

Neither is imported before the first frame has been drawn, and then in a thread: importing pydantic
and rclpy takes time.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
from importlib import import_module
from typing import TYPE_CHECKING

from text.i18n import language
from tui.lifecycle.replay import replayed
from tui.panels.registry import PANELS
from tui.session.requests import Lesson
from tui.session.watching import watched

if TYPE_CHECKING:
    from pathlib import Path

    from graph.replay.replay import Replay
    from launcher.client.client import SupervisorClient
    from launcher.client.start import StartingSupervisor
    from launcher.profile.catalog import ProfileEntry
    from launcher.profile.load import Profile
    from launcher.status import SessionInfo
    from tui.session.ports import GraphLink, SessionLink
    from tui.session.requests import OpenRequest, ReplayRequest

OF_ROS = ("rclpy.node", "rclpy.event_handler", "rclpy.serialization", "sensor_msgs.msg")
"""Modules that the observer needs in nearly every lesson."""
OF_SCREEN = ("tui.deck.screen", "tui.widgets.half_blocks")
"""Modules that show a lesson, besides its panels."""


class LiveOpener:
    """Opens sessions through the launcher."""

    def __init__(self) -> None:
        self._starting = asyncio.Lock()
        self._ahead: StartingSupervisor | None = None
        """Imports what nodes need while the user chooses; it ends with this process."""
        self.replay: Replay | None = None
        """The recording that was opened, if the last session was one."""

    async def lessons(self) -> list[Lesson]:
        """Return all profiles; broken ones have their error."""
        return await asyncio.to_thread(_lessons)

    async def running(self) -> list[SessionInfo]:
        """Return the sessions that run in the background."""
        await _imported("launcher.client.client")
        from launcher.client.client import running

        return await asyncio.to_thread(running)

    def domain(self, asked: int | None) -> int:
        """The ROS domain to observe: the requested one, ROS_DOMAIN_ID, or the user's own."""
        from launcher.domain.domain import choose_domain

        return choose_domain(asked, None, os.environ)

    async def prepare(self) -> None:
        """Import, here and in a supervisor, the modules that every profile needs."""
        await self._start_ahead()
        await _imported(
            "launcher.client.client", "launcher.runs.shared_domain", "graph.observer.observer"
        )
        # If ROS is missing, the nodes and the observer report that later.
        with contextlib.suppress(ImportError):
            await _imported(*OF_ROS)
        # Done now, because after a lesson is chosen its nodes need the processors.
        await _imported(*OF_SCREEN, *(entry.module for entry in PANELS.values()))

    async def _start_ahead(self) -> None:
        async with self._starting:
            if self._ahead is None or not self._ahead.waits:
                from launcher.client.start import StartingSupervisor

                self._ahead = await asyncio.to_thread(StartingSupervisor)

    async def open(self, request: OpenRequest) -> SessionLink:
        """Start the profile, attach to the session, open the recording, or watch the domain."""
        self.replay = None
        if request.replay is not None:
            self.replay = await asyncio.to_thread(_opened_bag, request.replay)
            return replayed(self.replay)
        if request.watch is not None:
            await _imported("graph.observer.observer")
            return watched(*request.watch)
        if request.profile is not None:
            await self._start_ahead()
        await _imported("launcher.client.client")
        from launcher.client import client

        if request.profile is None:
            link = await client.attach(request.attach)
        else:
            link = await self._launch(request.profile, request)
        await _imported("graph.observer.observer")
        return link

    async def _launch(self, profile: Path, request: OpenRequest) -> SupervisorClient:
        from launcher.client import client

        read = await asyncio.to_thread(_read, profile, request)
        ahead, self._ahead = self._ahead, None
        return await client.launch(
            read,
            foreground=True,
            node_lang=language(),
            supervisor=ahead,
        )

    def observe(self, session: SessionInfo) -> GraphLink:
        """Return the graph of the session's domain, or the recording in its place."""
        if self.replay is not None:
            return self.replay
        from graph.observer.observer import Observer

        return Observer(session.domain, session.discovery)


def _read(path: Path, request: OpenRequest) -> Profile:
    """Read the profile, and make sure that nobody else is in its domain."""
    from launcher.profile.load import load_profile
    from launcher.runs.shared_domain import refuse_shared_domain
    from launcher.serial_ports import serial_ports

    profile = load_profile(
        path,
        hardware=request.hardware,
        overrides=request.overrides,
        domain=request.domain,
        ports=serial_ports,
    )
    if not request.beside:
        refuse_shared_domain(profile)
    return profile


def _opened_bag(request: ReplayRequest) -> Replay:
    from graph.bag.errors import BagError
    from graph.replay.replay import Replay
    from launcher.errors import UsageError

    try:
        return Replay(request.bag, rate=request.rate, loop=request.loop, start_s=request.start_s)
    except BagError as error:
        raise UsageError(error.words) from error


async def _imported(*modules: str) -> None:
    """Import in a thread, so that the screen stays responsive."""
    for module in modules:
        await asyncio.to_thread(import_module, module)


def _lessons() -> list[Lesson]:
    from launcher.profile.catalog import list_profiles

    return [_lesson(entry) for entry in list_profiles()]


def _lesson(entry: ProfileEntry) -> Lesson:
    return Lesson(
        name=entry.name,
        path=entry.path,
        title=entry.title,
        about=entry.about,
        lesson=entry.lesson,
        nodes=entry.nodes,
        panels=entry.panels,
        error=entry.error,
    )
