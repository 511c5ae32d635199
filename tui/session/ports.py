"""The two ports of the screen: what it needs of the supervisor and of the ROS graph.

`launcher.client.client.SupervisorClient` and `graph.observer.observer.Observer` implement them, and
so do the recorded ones in the tests. A `SessionOpener` lists what can be opened and opens it. For
type checkers only: nothing here is needed at run time.
"""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Protocol, TypeVar

if TYPE_CHECKING:
    from concurrent.futures import Future
    from pathlib import Path

    from course.judging import JudgeEvent
    from course.lessons.lesson import LessonFolder
    from graph.data import GraphUpdate, Interest
    from graph.observer.requests import Request
    from graph.replay.replay import Replay
    from launcher.consent import Agents, ConsentAnswer
    from launcher.events import Event
    from launcher.status import NodeStatus, SessionInfo, Stray
    from tui.session.requests import Lesson, OpenRequest, WholeGrade

T = TypeVar("T")


class SessionLink(Protocol):
    """A running profile: the current state of its nodes, and what can be asked of them."""

    @property
    def session(self) -> SessionInfo:
        """The session: profile, domain, panels."""

    @property
    def own(self) -> bool:
        """Whether this screen has started it, so that it ends with this screen."""

    @property
    def nodes(self) -> Mapping[str, NodeStatus]:
        """Every node by its name in the profile, kept up to date."""

    @property
    def strays(self) -> tuple[Stray, ...]:
        """Processes that an earlier run left behind."""

    @property
    def agents(self) -> Agents:
        """The agents, and what they ask for, kept up to date."""

    @property
    def unguarded(self) -> bool:
        """Whether nobody would end what is left if the supervisor were killed now."""

    @property
    def emergency_stop(self) -> Callable[[bool, int], None]:
        """Gives (True) or releases the emergency stop without ROS; on any thread, at once.

        The number is when that was said, Unix time in nanoseconds.
        """

    def events(self, *, past: int = 0) -> AsyncIterator[Event]:
        """Yield the newest `past` lines so far, then events until the session ends."""

    async def start(self, *names: str) -> None:
        """Start these nodes, or all if none is named."""

    async def stop(self, *names: str) -> None:
        """Stop these nodes, or all if none is named."""

    async def restart(self, *names: str) -> None:
        """Stop and start these nodes, or all if none is named."""

    async def exchange(self, name: str, program: Path | str | None) -> None:
        """Run this file or module of Deck in the node's place; with None what the profile names."""

    async def stop_strays(self, strays: Iterable[Stray]) -> None:
        """Stop processes that an earlier run left behind."""

    async def attend(self) -> None:
        """Say that a person at this screen can answer the questions of agents."""

    async def answer(self, question: int, answer: ConsentAnswer) -> bool:
        """Answer a question; return False if it is no longer asked."""

    async def end_consent(self) -> None:
        """End every question, and every allowance for a time."""

    async def shutdown(self, now: bool = False) -> None:
        """Stop all nodes, dependants first, and the supervisor; with `now` without waiting."""

    async def aclose(self) -> None:
        """Disconnect from the session and leave it running."""


class GraphLink(Protocol):
    """The ROS graph of one domain; no method blocks, and all may be called from any thread."""

    def start(self, on_update: Callable[[GraphUpdate], None]) -> None:
        """Start observing; `on_update` is called on the observer's own thread."""

    def stop(self) -> None:
        """Stop observing, within a limited time."""

    def want(self, interest: Interest) -> None:
        """Have updates with exactly this from now on."""

    def ask(self, request: Request[T]) -> Future[T]:
        """Ask for something; the future gets the answer, or what the request says that it raises."""


class JudgeLink(Protocol):
    """Judges one step at a time of a lesson that runs; `course.judging.RemoteJudge` is one."""

    def judge(self, step: str) -> None:
        """Judge this step from now on, until it has passed, and no other one."""

    def events(self) -> AsyncIterator[JudgeEvent]:
        """Yield what the judge says, that it has ended last."""

    async def close(self) -> None:
        """End it."""


class SessionOpener(Protocol):
    """What can be opened, and how."""

    @property
    def replay(self) -> Replay | None:
        """The recording that was opened, if the last session was one."""

    async def lessons(self) -> list[Lesson]:
        """Return all profiles, without scores; broken ones have their error."""

    async def scored(self, lessons: Sequence[Lesson]) -> list[Lesson]:
        """Return the same with scores, which takes longer; a lesson without steps has no task."""

    async def running(self) -> list[SessionInfo]:
        """Return the sessions that run in the background."""

    def domain(self, asked: int | None) -> int:
        """The ROS domain that `watch` means; raises a `LauncherError` if it is out of range."""

    async def prepare(self) -> None:
        """Prepare what is possible while the user chooses, so that `open` is quick."""

    async def open(self, request: OpenRequest) -> SessionLink:
        """Start the profile or attach to the session; raises a `LauncherError` with the reason."""

    def observe(self, session: SessionInfo) -> GraphLink:
        """Return the ROS graph of this session's nodes, not yet observed."""

    async def lesson(self, session: SessionInfo) -> LessonFolder | None:
        """Return the lesson that a running profile belongs to, already read; None without one."""

    async def judge(self, lesson: LessonFolder, session: SessionInfo, passed: Iterable[str]) -> JudgeLink:
        """Start a judge, which begins with its first order."""

    async def grade(self, lesson: LessonFolder, folder: Path) -> WholeGrade:
        """Have a learner's folder graded, which takes a while."""
