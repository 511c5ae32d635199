"""Live sessions: the supervisor and the observer behind the two ports of the screen.

Nothing of them is imported before the first frame is out, and then on a thread: pydantic and
rclpy take their time.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
from importlib import import_module
from typing import TYPE_CHECKING

from text.i18n import language
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
    from tui.session.watching import NodelessLink

OF_ROS = ("rclpy.node", "rclpy.event_handler", "rclpy.serialization", "sensor_msgs.msg")
"""What the observer needs in nearly every lesson."""
OF_SCREEN = ("tui.deck.screen", "tui.widgets.half_blocks")
"""What shows a lesson, besides its panels."""


class LiveOpener:
    """Opens what the launcher has."""

    def __init__(self) -> None:
        self._starting = asyncio.Lock()
        self._ahead: StartingSupervisor | None = None
        """Imports what nodes need while a person chooses; it ends with this process."""
        self._replay: Replay | None = None
        """The recording that was opened last, if it was one."""

    async def lessons(self) -> list[Lesson]:
        """Return every profile there is, broken ones with their error."""
        return await asyncio.to_thread(_lessons)

    async def running(self) -> list[SessionInfo]:
        """Return the sessions that run in the background."""
        await _imported("launcher.client.client")
        from launcher.client.client import running

        return await asyncio.to_thread(running)

    def domain(self, asked: int | None) -> int:
        """The ROS domain to look at: the one asked for, ROS_DOMAIN_ID, or the user's own."""
        from launcher.domain.domain import choose_domain

        return choose_domain(asked, None, os.environ)

    async def prepare(self) -> None:
        """Import, here and in a supervisor, what is the same for every profile."""
        await self._start_ahead()
        await _imported(
            "launcher.client.client", "launcher.runs.shared_domain", "graph.observer.observer"
        )
        # Without ROS there is a word for it, later: the nodes' own and the observer's.
        with contextlib.suppress(ImportError):
            await _imported(*OF_ROS)
        # Once a lesson is chosen the processors are for its nodes.
        await _imported(*OF_SCREEN, *(entry.module for entry in PANELS.values()))

    async def _start_ahead(self) -> None:
        async with self._starting:
            if self._ahead is None or not self._ahead.waits:
                from launcher.client.start import StartingSupervisor

                self._ahead = await asyncio.to_thread(StartingSupervisor)

    async def open(self, request: OpenRequest) -> SessionLink:
        """Start the profile, attach to the session, open the recording, or look at the domain."""
        self._replay = None
        if request.replay is not None:
            recording = await asyncio.to_thread(_opened_bag, request.replay)
            self._replay = recording.replay
            return recording
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
        """Return the graph of the session's domain, or the recording that stands for it."""
        if self._replay is not None:
            return self._replay
        from graph.observer.observer import Observer

        return Observer(session.domain, session.discovery)


def _read(path: Path, request: OpenRequest) -> Profile:
    """Read the profile, and see that nobody else is in its domain."""
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


def _opened_bag(request: ReplayRequest) -> NodelessLink:
    from graph.bag.errors import BagError
    from graph.replay.replay import Replay
    from launcher.errors import UsageError
    from tui.lifecycle.replay import replayed

    try:
        replay = Replay(request.bag, rate=request.rate, loop=request.loop, start_s=request.start_s)
    except BagError as error:
        raise UsageError(error.words) from error
    return replayed(replay)


async def _imported(*modules: str) -> None:
    """Import on a thread, so that the screen answers meanwhile."""
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
