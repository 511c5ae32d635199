"""A session and a graph that were written down: lesson 9 at work, with nothing running.

`RecordedSession` and `RecordedGraph` fit the seams of the screen. Tests make them say more
(`session.say`, `graph.show`) and look at what was asked of them (`session.asked`,
`graph.asked`). The data are those of `tests.tui.recorded_lesson`.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from course.judging import JudgeEvent
from course.lessons.lesson import LessonFolder
from graph.replay.replay import Replay
from launcher.consent import Agents, ConsentAnswer
from launcher.events import AgentsEvent, ClosedEvent, Event, LogEvent, StatusEvent, StraysEvent, UnguardedEvent
from launcher.status import LogLine, NodeState, NodeStatus, SessionInfo, Stray
from tests.tui.recorded_graph import PARAMETERS, RecordedGraph
from tests.tui.recorded_lesson import (
    LESSONS,
    LINES,
    NODES,
    NOW_S,
    SESSION,
    TOPICS,
    joints,
    lesson_samples,
    lesson_update,
    line,
    sample,
    topic,
)
from tui.session.ports import SessionLink
from tui.session.requests import Lesson, OpenRequest, WholeGrade

__all__ = [
    "LESSONS",
    "LINES",
    "NODES",
    "NOW_S",
    "PARAMETERS",
    "SESSION",
    "TOPICS",
    "RecordedGraph",
    "RecordedOpener",
    "RecordedSession",
    "joints",
    "lesson_samples",
    "lesson_update",
    "line",
    "sample",
    "topic",
]


class RecordedSession:
    """A session that says what it is told to, and notes what is asked of it."""

    def __init__(
        self,
        session: SessionInfo = SESSION,
        nodes: Mapping[str, NodeStatus] = NODES,
        lines: Iterable[LogLine] = LINES,
    ) -> None:
        self.session = session
        self.own = session.foreground
        """Set it: another screen's session in the foreground."""
        self.nodes: dict[str, NodeStatus] = dict(nodes)
        self.strays: tuple[Stray, ...] = ()
        self.agents = Agents()
        self.unguarded = False
        self.asked: list[tuple[str, ...]] = []
        """What was asked: ("stop", "camera"), ("shutdown", "now"), ("aclose",)."""
        self.stops: list[bool] = []
        self.said_ns: list[int] = []
        """When each of them was said."""
        """What was said of the emergency stop without ROS."""
        self.hold_shutdown = False
        """Set: the nodes do not stop until they are made to."""
        self._killed = asyncio.Event()
        self._queue: asyncio.Queue[Event] = asyncio.Queue()
        if before := tuple(lines):
            self._queue.put_nowait(LogEvent(before))

    def say(self, event: Event) -> None:
        if isinstance(event, StatusEvent):
            self.nodes.update({node.name: node for node in event.nodes})
        if isinstance(event, StraysEvent):
            self.strays = event.strays
        if isinstance(event, AgentsEvent):
            self.agents = event.agents
        if isinstance(event, UnguardedEvent):
            self.unguarded = True
        self._queue.put_nowait(event)

    def emergency_stop(self, engaged: bool, said_ns: int) -> None:
        self.stops.append(engaged)
        self.said_ns.append(said_ns)

    def set_state(self, name: str, state: NodeState, **more: Any) -> None:
        self.say(StatusEvent((replace(self.nodes[name], state=state, **more),)))

    async def events(self, *, past: int = 0) -> AsyncIterator[Event]:
        """Yield what was said until it is closed; `LINES` are what was said before."""
        del past
        while True:
            event = await self._queue.get()
            yield event
            if isinstance(event, ClosedEvent):
                return

    async def start(self, *names: str) -> None:
        self.asked.append(("start", *names))

    async def stop(self, *names: str) -> None:
        self.asked.append(("stop", *names))

    async def restart(self, *names: str) -> None:
        self.asked.append(("restart", *names))

    async def exchange(self, name: str, program: Path | str | None) -> None:
        self.asked.append(("exchange", name, "" if program is None else str(program)))

    async def stop_strays(self, strays: Iterable[Stray]) -> None:
        self.asked.append(("stop_strays", *(stray.node for stray in strays)))

    async def attend(self) -> None:
        pass

    async def answer(self, question: int, answer: ConsentAnswer) -> bool:
        self.asked.append(("answer", str(question), answer.value))
        return True

    async def end_consent(self) -> None:
        self.asked.append(("end_consent",))

    async def shutdown(self, now: bool = False) -> None:
        self.asked.append(("shutdown", "now") if now else ("shutdown",))
        if now:
            self._killed.set()
        elif self.hold_shutdown:
            await self._killed.wait()

    async def aclose(self) -> None:
        self.asked.append(("aclose",))


class RecordedJudge:
    """A judge that says what it is told to, and notes what it is asked to judge."""

    def __init__(self) -> None:
        self.passed: frozenset[str] = frozenset()
        self.asked: list[str] = []
        self.closed = False
        self._queue: asyncio.Queue[JudgeEvent] = asyncio.Queue()

    def say(self, event: JudgeEvent) -> None:
        self._queue.put_nowait(event)

    def judge(self, step: str) -> None:
        self.asked.append(step)

    async def events(self) -> AsyncIterator[JudgeEvent]:
        while True:
            yield await self._queue.get()

    async def close(self) -> None:
        self.closed = True


@dataclass
class RecordedOpener:
    """Opens the recorded session, whatever is ordered."""

    link: RecordedSession = field(default_factory=RecordedSession)
    graph: RecordedGraph = field(default_factory=RecordedGraph)
    sessions: list[SessionInfo] = field(default_factory=list)
    """What runs in the background already."""
    known: list[Lesson] = field(default_factory=lambda: LESSONS)
    """The lessons."""
    refusal: Exception | None = None
    """Set: opening fails by this."""
    orders: list[OpenRequest] = field(default_factory=list)
    replay: Replay | None = None
    """What is played in place of a robot."""
    task: LessonFolder | None = None
    """The lesson that the session belongs to."""
    judged: RecordedJudge = field(default_factory=RecordedJudge)
    graded: list[Path] = field(default_factory=list)
    """The folders that were graded."""
    grades: WholeGrade = field(default_factory=lambda: WholeGrade(10, 10, {}))
    """What comes of that."""

    async def lessons(self) -> list[Lesson]:
        return self.known

    async def scored(self, lessons: Sequence[Lesson]) -> list[Lesson]:
        return [*lessons]

    async def running(self) -> list[SessionInfo]:
        return self.sessions

    def domain(self, asked: int | None) -> int:
        return 42 if asked is None else asked

    async def prepare(self) -> None:
        pass

    async def open(self, order: OpenRequest) -> SessionLink:
        self.orders.append(order)
        if self.refusal is not None:
            raise self.refusal
        return self.link

    async def lesson(self, session: SessionInfo) -> LessonFolder | None:
        del session
        return self.task

    async def judge(self, lesson: LessonFolder, session: SessionInfo, passed: Iterable[str]) -> RecordedJudge:
        del lesson, session
        self.judged.passed = frozenset(passed)
        return self.judged

    async def grade(self, lesson: LessonFolder, folder: Path) -> WholeGrade:
        del lesson
        self.graded.append(folder)
        return self.grades

    def observe(self, session: SessionInfo) -> RecordedGraph:
        del session
        return self.graph
