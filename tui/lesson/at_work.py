"""The lesson of the session: the step at hand, and what a judge says of it.

The Lesson screen and the column on the Deck show the same one. A judge is at work from when the
first of them asks until the session ends.
"""

from __future__ import annotations

import asyncio
import time
from pathlib import Path
from typing import TYPE_CHECKING, cast

from course.lessons.catalog import next_lesson
from course.progress import Progress, load_progress, noted, state_of
from course.results import State, StepResult
from launcher.profile.steps.checks import LOOK_AGAIN_S
from text.i18n import _, localized
from text.plain import plain
from tui.frame.host import host_of
from tui.lesson.reading import StepTexts
from tui.session.requests import WholeGrade

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.screen import Screen
    from textual.worker import Worker
    from typing_extensions import Unpack

    from course.judging import JudgeEvent
    from course.lessons.lesson import LessonFolder
    from course.progress import StepChanges
    from launcher.profile.steps.model import StepDocument
    from launcher.status import NodeStatus, SessionInfo
    from tui.frame.host import Host
    from tui.session.messages import SessionChanged
    from tui.session.ports import JudgeLink

"""Checks that do something to the nodes: not done again for a change of a file alone."""


class LessonAtWork:
    """The lesson, from the side of whoever shows it; there is one for the app, see `of`."""

    def __init__(self, host: Host) -> None:
        self._host = host
        self.folder: LessonFolder | None = None
        """The lesson, None while there is none."""
        self.sought = False
        """Whether it is known if the session belongs to a lesson."""
        self.reading: StepTexts | None = None
        self.beside_nodes = False
        """Whether it is wished beside the nodes on the Deck, too."""
        self._next: LessonFolder | None = None
        """The lesson after this one, None after the last."""
        self.progress = Progress()
        self.seed = 0
        """What the judge draws its values from; 0 until it is at work."""
        self._step = ""
        """Id of the step at hand."""
        self._results: dict[str, StepResult] = {}
        self._judge: JudgeLink | None = None
        self._judged = ""
        """The step that the judge was asked for."""
        self._run = ""
        """The run whose lesson this is."""
        self.files = ""
        """The state of the learner's files that run, see `course.progress.state_of`."""
        self._again: list[str] = []
        """Steps to be judged again: they have passed with other files."""
        self.grade: WholeGrade | None = None
        """What `deck grade` has said of these files."""
        self.grading = False
        """Whether it is at it."""
        self._graded = ""
        """The state of the files that it was asked about."""
        self._following: Worker[None] | None = None
        self._looking: Worker[None] | None = None
        self._shown_by: dict[Screen[None], Callable[[], object]] = {}

    @classmethod
    def of(cls, screen: Screen[None]) -> LessonAtWork:
        host = host_of(screen)
        if host.lesson is None:
            host.lesson = cls(host)
        return cast("LessonAtWork", host.lesson)

    # The lesson and its judge

    def show_on(self, screen: Screen[None], show: Callable[[], object]) -> None:
        """Call `show` whenever something has changed, as long as that screen is there."""
        self._shown_by[screen] = show
        self._follow(screen)

    def session_changed(self, screen: Screen[None], message: SessionChanged) -> None:
        """Read the lesson of another session; when it has ended, so does its judge."""
        if message.ended or self._session is None:
            self._run = ""
            if self._following is not None:
                self._following.cancel()
            return
        self._follow(screen)

    def status_changed(self, screen: Screen[None]) -> None:
        """Begin to judge once there are nodes of the learner's."""
        if self.own and self._judge is None and self.folder is not None:
            done = self._following is None or self._following.is_finished
            self._run = "" if done else self._run
            self._follow(screen)
        elif self._judge is not None and (self._looking is None or self._looking.is_finished):
            self._looking = screen.app.run_worker(self._look_at_files(), group="files")

    @property
    def _session(self) -> SessionInfo | None:
        """The session, None if there is none with nodes that could be judged."""
        feed = self._host.feed
        judgeable = feed.link is not None and feed.replay is None and not feed.watching
        return feed.session if judgeable else None

    def _follow(self, screen: Screen[None]) -> None:
        """Begin with a session that is another than the one before."""
        session = self._session
        if session is not None and session.run_id != self._run:
            self._run = session.run_id
            self._following = screen.app.run_worker(self._judge_session(session), group="judge", exclusive=True)

    async def _judge_session(self, session: SessionInfo) -> None:
        """Read the lesson of the session, and take what the judge says of it until it ends."""
        opener = self._host.sessions.opener
        folder = await opener.lesson(session)
        self.progress = await asyncio.to_thread(load_progress)
        self.folder, self._results, self.sought = folder, {}, True
        if folder is None:
            self._changed()
            return
        self.reading = StepTexts(folder)
        self._next = await asyncio.to_thread(next_lesson, folder)
        self.files = await asyncio.to_thread(state_of, self._own_files)
        passed = self.progress.passed(folder.name)
        ids = [step.id for step in folder.steps]
        self._step = next((id_ for id_ in ids if id_ not in self.passed), ids[0])
        self._again = self._to_be_judged_again()
        self._remember_grade()
        self._changed()
        if not self.own:
            return
        self.note()
        self._grade_if_done()
        judge = await opener.judge(folder, session, passed)
        self._judge = judge
        try:
            self._ask_judge()
            async for event in judge.events():
                self._take(event)
        finally:
            self._judge, self._judged = None, ""
            await judge.close()

    def _ask_judge(self) -> None:
        """Have a step judged again that has passed earlier, else that at hand if it has not."""
        wanted = self._again[0] if self._again else "" if self.passed_now else self._step
        if self._judge is not None and wanted and self._judged != wanted:
            self._judged = wanted
            self._judge.judge(wanted)

    async def _look_at_files(self) -> None:
        """Let ticks fade that are of other files than there are now."""
        files = await asyncio.to_thread(state_of, self._own_files)
        if files == self.files:
            return
        self.files, self._results, self._judged = files, {}, ""
        self._again = self._to_be_judged_again()
        self._remember_grade()
        self._ask_judge()
        self._changed()

    def _to_be_judged_again(self) -> list[str]:
        """Return the steps whose ticks have faded, and that cost no more than a look."""
        steps = () if self.folder is None else self.folder.steps
        return [
            step.id
            for step in steps
            if self.was_right(step.id) is not None and not any(check.rest_s > LOOK_AGAIN_S for check in step.checks)
        ]

    def _take(self, event: JudgeEvent) -> None:
        if isinstance(event, StepResult):
            if self._results.get(event.id) == event:
                return
            self._results[event.id] = event
            if event.state is State.PASSED:
                now = int(time.time())
                self.note(event.id, passed=True, points=event.points, files=self.files, at=now)
            if event.id in self._again and event.state is not State.NOT_YET:
                self._again.remove(event.id)
                self._ask_judge()
            if event.state is State.PASSED:
                self._grade_if_done()
        elif seed := getattr(event, "seed", 0):
            self.seed = seed
        elif reason := getattr(event, "reason", ""):
            self._host.notify(plain(localized(reason)), severity="warning")
        self._changed()

    def _grade_if_done(self) -> None:
        """Have the files graded once all steps hold with them: that alone is the end."""
        steps = () if self.folder is None else self.folder.steps
        done = all(step.id in self.passed for step in steps)
        asked = self.grading or self._graded == self.files
        if done and self.files and self._shown_by and not asked:
            self._graded, self.grading = self.files, True
            screen = next(iter(self._shown_by))
            screen.app.run_worker(self._grade(), group="grade")

    def _remember_grade(self) -> None:
        """Take the grade of before, if it was of these files and all of it was right."""
        self.grade = None
        lesson = self.folder
        if lesson is None or not self.files or not lesson.steps:
            return
        known = [self.progress.step(lesson.name, step.id) for step in lesson.steps]
        if all(each.passed and each.graded == self.files for each in known):
            self.grade, self._graded = WholeGrade(lesson.points, lesson.points, {}), self.files

    async def _grade(self) -> None:
        """Ask for the grade; a step that does not pass there has lost its tick."""
        lesson, node, files = self.folder, self.node, self.files
        try:
            if lesson is None or node is None:
                return
            grade = await self._host.sessions.opener.grade(lesson, Path(node.file).parent)
        finally:
            self.grading = False
        if files != self.files or lesson is not self.folder:
            return
        self.grade = grade
        for step in lesson.steps:
            if step.id not in grade.failed and not grade.ungraded:
                self.note(step.id, graded=files)
            if step.id in grade.failed:
                self.note(step.id, passed=False)
                why = grade.failed[step.id]
                self._results[step.id] = StepResult(step.id, State.FAILED, step.points, (), why)
        self._changed()

    def note(self, step: str = "", **changes: Unpack[StepChanges]) -> None:
        """Write down how far a step is."""
        if self.folder is None:
            return
        try:
            self.progress = noted(self.folder.name, step, changes)
        except OSError as error:
            if step:
                self.progress = self.progress.with_step(self.folder.name, step, changes)
            told = _("Your progress could not be saved: {reason}").format(reason=error.strerror)
            self._host.notify(plain(told), severity="warning")

    def _changed(self) -> None:
        for screen, show in list(self._shown_by.items()):
            if screen.is_attached:
                show()
            else:
                del self._shown_by[screen]

    # How things stand

    @property
    def own(self) -> bool:
        """Whether files of the learner run."""
        return any(node.file for node in self._host.feed.nodes.values())

    @property
    def step(self) -> StepDocument | None:
        steps = () if self.folder is None else self.folder.steps
        return next((step for step in steps if step.id == self._step), None)

    @property
    def passed(self) -> frozenset[str]:
        """The steps that have passed with these files; none while one of them cannot run."""
        if self.folder is None or self._crashed:
            return frozenset()
        return self.progress.held(self.folder.name, self.files)

    @property
    def _crashed(self) -> bool:
        nodes = self._host.feed.nodes.values()
        return any(node.file and (node.ails or node.crashed) for node in nodes)

    @property
    def _own_files(self) -> list[str]:
        return [node.file for node in self._host.feed.nodes.values() if node.file]

    def was_right(self, step: str) -> int | None:
        """Return when a step passed whose tick has faded, 0 if nobody knows; None: it has not."""
        if self.folder is None or step in self.passed:
            return None
        known = self.progress.step(self.folder.name, step)
        return known.at if known.passed else None

    @property
    def passed_now(self) -> bool:
        return self.step is not None and self._step in self.passed

    @property
    def taken(self) -> int:
        """How many hints have been asked for."""
        name = "" if self.folder is None else self.folder.name
        return self.progress.step(name, self._step).hints

    @property
    def saw_solution(self) -> bool:
        name = "" if self.folder is None else self.folder.name
        return self.progress.step(name, self._step).solution

    @property
    def more_help(self) -> bool:
        """Whether there is a hint left, or the solution."""
        step = self.step
        return step is not None and (self.taken < len(step.hints) or not self.saw_solution)

    @property
    def takes_solution(self) -> bool:
        return self.step is not None and self.taken >= len(self.step.hints)

    @property
    def hinted(self) -> bool:
        """Whether the lesson may say where to look: a hint was asked for, or there is none."""
        return self.taken > 0 or self.takes_solution

    @property
    def next_lesson(self) -> LessonFolder | None:
        """The lesson to go on with once all steps have passed; None before, and after the last."""
        steps = () if self.folder is None else self.folder.steps
        return self._next if steps and all(step.id in self.passed for step in steps) else None

    @property
    def node(self) -> NodeStatus | None:
        """The node that runs the file of this step, else any that runs a file of the learner."""
        nodes = [node for node in self._host.feed.nodes.values() if node.file]
        wanted = self.step.file if self.step is not None else None
        named = [node for node in nodes if wanted and Path(node.file).name == wanted]
        return next(iter(named or nodes), None)

    def result(self, step: StepDocument) -> StepResult:
        """Return what is known of a step; one that has passed with these files has passed."""
        result = self._results.get(step.id, StepResult(step.id, State.NOT_YET, step.points))
        if step.id in self.passed and result.state is not State.PASSED:
            return StepResult(step.id, State.PASSED, step.points)
        return result

    def neighbour(self, by: int) -> str:
        """The id of the step this many places further, empty if there is none."""
        ids = [] if self.folder is None else [step.id for step in self.folder.steps]
        if self._step not in ids:
            return ""
        at = ids.index(self._step) + by
        return ids[at] if 0 <= at < len(ids) else ""

    def go(self, by: int) -> None:
        self._step = self.neighbour(by) or self._step
        self._ask_judge()
        self._changed()

    def help(self) -> bool:
        """Take the next hint, and after the last one the solution; return whether it is that."""
        step = self.step
        if step is None:
            return False
        solution = self.takes_solution
        if solution:
            self.note(step.id, solution=True)
        else:
            self.note(step.id, hints=self.taken + 1)
        self._changed()
        return solution
