"""Live sessions: the supervisor and the observer behind the screen's two ports.

Neither is imported before the first frame has been drawn, and then in a thread: importing pydantic
takes time. rclpy is imported by the observer's process alone.
"""

from __future__ import annotations

import asyncio
import os
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.profile.panels import PANELS, panels_for
from text.i18n import language
from tui.screens import is_there
from tui.session.requests import Lesson
from tui.session.watching import NodelessLink, watched

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from course.lessons.lesson import LessonFolder
    from graph.replay.replay import Replay
    from launcher.client.client import SupervisorClient
    from launcher.client.start import StartingSupervisor
    from launcher.profile.load import Profile
    from launcher.status import SessionInfo
    from tui.session.ports import GraphLink, JudgeLink, SessionLink
    from tui.session.requests import OpenRequest, ReplayRequest, WholeGrade

OF_SCREEN = ("tui.deck.screen", "tui.widgets.image_view")
"""Modules that show a lesson, besides its panels."""
OF_STOP = ("launcher.client.running", "launcher.client.stop_road")
"""Modules of the stop's road to supervisors: whoever presses it does not wait for them."""
OF_COURSE = "tui.lesson.tasks"
REPLAY = "replay"
"""Shown in place of the hardware."""


class LiveOpener:
    """Opens sessions through the launcher."""

    def __init__(self) -> None:
        self._starting = asyncio.Lock()
        self._ahead: StartingSupervisor | None = None
        """Imports what nodes need while the user chooses; it ends with this process."""
        self.replay: Replay | None = None
        """The recording that was opened, if the last session was one."""

    async def lessons(self) -> list[Lesson]:
        """Return all profiles, without scores; broken ones have their error."""
        return await asyncio.to_thread(_lessons)

    async def scored(self, lessons: Sequence[Lesson]) -> list[Lesson]:
        """Return the same with scores, which takes longer; a lesson without steps has no task."""
        if not is_there("course"):
            return list(lessons)
        await _imported(OF_COURSE)
        from tui.lesson.tasks import scored

        return await asyncio.to_thread(scored, lessons)

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
        """Import what every profile needs, here, in a supervisor, and in an observer's process."""
        await self._start_ahead()
        await _start_observer_ahead()
        await _imported("launcher.client.client", "launcher.runs.shared_domain", "graph.observer.observer")
        # Done now, because after a lesson is chosen its nodes need the processors.
        await _imported(*OF_SCREEN, *(f"tui.panels.{name}" for name in PANELS))

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
        await _start_observer_ahead()
        if request.watch is not None:
            await _imported("graph.observer.observer", *OF_STOP)
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
        return await client.launch(read, foreground=True, node_lang=language(), supervisor=ahead)

    def observe(self, session: SessionInfo) -> GraphLink:
        """Return the graph of the session's domain, or the recording in its place."""
        if self.replay is not None:
            return self.replay
        from graph.observer.observer import Observer

        return Observer(session.domain, session.discovery)

    async def lesson(self, session: SessionInfo) -> LessonFolder | None:
        """Return the lesson that a running profile belongs to, already read; None without one."""
        if not is_there("course"):
            return None
        await _imported(OF_COURSE)
        from tui.lesson.tasks import lesson_of

        return await asyncio.to_thread(lesson_of, session)

    async def judge(self, lesson: LessonFolder, session: SessionInfo, passed: Iterable[str]) -> JudgeLink:
        """Start a judge, which begins with its first order."""
        from tui.lesson.tasks import judge

        return await judge(lesson, session, passed)

    async def grade(self, lesson: LessonFolder, folder: Path) -> WholeGrade:
        """Have a learner's folder graded, which takes a while."""
        from tui.lesson.tasks import graded

        return await graded(lesson, folder)


def _read(path: Path, request: OpenRequest) -> Profile:
    """Read the profile, and make sure that nobody else is in its domain."""
    from launcher.profile.load import load_profile
    from launcher.runs.shared_domain import apart_from_classmates, refuse_shared_domain
    from launcher.serial_ports import serial_ports

    profile = load_profile(
        path, hardware=request.hardware, overrides=request.overrides, domain=request.domain, ports=serial_ports
    )
    if not request.beside:
        profile = apart_from_classmates(profile)
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


async def _start_observer_ahead() -> None:
    """Let it import ROS while this process goes on: not before the first frame is drawn.

    If ROS is missing, the nodes and the observer report that later.
    """
    await _imported("graph.observer.observer")
    from graph.observer.observer import start_ahead

    start_ahead()


async def _imported(*modules: str) -> None:
    """Import in a thread, so that the screen stays responsive."""
    for module in modules:
        await asyncio.to_thread(import_module, module)


def _lessons() -> list[Lesson]:
    if is_there("course"):
        from tui.lesson.tasks import listed

        return listed()
    from launcher.profile.catalog import list_profiles

    return [Lesson.of(entry) for entry in list_profiles()]


def replayed(replay: Replay) -> NodelessLink:
    """Return the session of a recording, which its observer plays."""
    from launcher.status import SessionInfo

    bag = replay.bag
    session = SessionInfo(
        run_id=REPLAY,
        profile=str(bag.path),
        name=bag.name,
        title={"en": bag.name},
        hardware=REPLAY,
        panels=panels_for({topic.name for topic in bag.topics}),
        foreground=False,
    )
    return NodelessLink(session)
