"""What the course says of the lessons, for the list and for the session: tasks, scores, the judge, a whole grade."""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import tui
from course.folder.folder import folder_of, own_profile
from course.judging import RemoteJudge
from course.lessons import catalog
from course.lessons.lesson import LessonFolder
from course.progress import load_progress, state_of
from launcher.errors import LauncherError
from launcher.profile.catalog import list_profiles
from launcher.profile.defaults import FOLDERS_OWN
from launcher.profile.load import load_profile
from text.i18n import language
from text.nested import read_json
from tui.session.requests import Lesson, Score, Task, WholeGrade

if TYPE_CHECKING:
    from collections.abc import Iterable

    from course.progress import Progress
    from launcher.status import SessionInfo
    from tui.session.ports import JudgeLink


def listed() -> list[Lesson]:
    """Return all profiles, with what there is to do in them."""
    tasks, progress = catalog.lessons(), load_progress()
    profiles = list_profiles()
    names = {entry.name for entry in profiles}
    # A lesson of a teacher's own has no profile beside it.
    others = [task.path / FOLDERS_OWN for name, task in tasks.items() if name not in names]
    return [
        Lesson.of(entry, _task(tasks.get(entry.name), progress))
        for entry in (list_profiles(others) if others else profiles)
    ]


def _task(folder: LessonFolder | None, progress: Progress) -> Task | None:
    if folder is None:
        return None
    own = folder_of(folder) / FOLDERS_OWN
    return Task(folder=folder.path, own=own if own.is_file() else None, left_off=progress.last == folder.name)


def scored(lessons: Iterable[Lesson]) -> list[Lesson]:
    """Return the same with scores; a lesson without steps has no task."""
    progress = load_progress()
    return [
        lesson if lesson.task is None else lesson._replace(task=_with_score(lesson.task, progress))
        for lesson in lessons
    ]


def _with_score(task: Task, progress: Progress) -> Task | None:
    folder = LessonFolder(task.folder)
    try:
        steps = {step.id for step in folder.steps}
    except (LauncherError, OSError):
        return None
    files = state_of([str(task.own)] if task.own is not None else [])
    passed = progress.held(folder.name, files) & steps
    earned = progress.points(folder.name, passed)
    score = Score(len(steps), folder.points, len(passed), earned)
    return task._replace(score=score) if steps else None


def own_of(task: Task) -> Path:
    """Make the learner's folder of a lesson; return its profile."""
    return own_profile(LessonFolder(task.folder))


def lesson_of(session: SessionInfo) -> LessonFolder | None:
    """Return the lesson that a running profile belongs to, already read; None without one."""
    try:
        folder = catalog.lesson_of(load_profile(session.profile))
        # Reading it takes time that a handler of the screen does not have.
        has_steps = folder is not None and bool(folder.steps)
    except (LauncherError, OSError):
        return None
    return folder if has_steps else None


async def judge(lesson: LessonFolder, session: SessionInfo, passed: Iterable[str]) -> JudgeLink:
    """Start a judge, which begins with its first order."""
    return await RemoteJudge.start(lesson.path, session.run_id, passed=passed)


_PASSED = "passed"
_COULD_NOT = "could not be judged"


async def graded(lesson: LessonFolder, folder: Path) -> WholeGrade:
    """Grade a folder by `deck grade`; whatever goes wrong is said in the result. The session goes on meanwhile."""
    grading = await asyncio.create_subprocess_exec(
        *(sys.executable, "-m", "tui", "grade", str(lesson.path), str(folder), "--format", "json"),
        cwd=Path(tui.__file__).parent.parent,
        stdin=asyncio.subprocess.DEVNULL,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        env={**os.environ, "DECK_LANG": language()},
        # Ctrl-C in the terminal is meant for the screen.
        start_new_session=True,
    )
    try:
        out, errors = await grading.communicate()
    finally:
        if grading.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                grading.terminate()
            await grading.wait()
    try:
        return _grade(read_json(out)["grades"][0])
    except (ValueError, KeyError, IndexError, TypeError):
        last = errors.decode(errors="replace").strip().splitlines()[-1:]
        return WholeGrade(0, lesson.points, {}, "".join(last))


def _grade(grade: dict[str, Any]) -> WholeGrade:
    steps = [step for step in grade["steps"] if step["state"] != _PASSED]
    failed = {step["id"]: step["message"] for step in steps if step["state"] != _COULD_NOT}
    reason = next((step["message"] for step in steps if step["state"] == _COULD_NOT), "")
    return WholeGrade(grade["points"], grade["max_points"], failed, reason)
