"""The grade of a learner's own folder, by `deck grade`; the session goes on meanwhile."""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import tui
from text.i18n import language
from text.nested import read_json
from tui.session.requests import WholeGrade

if TYPE_CHECKING:
    from course.lessons.lesson import LessonFolder

_PASSED = "passed"
_COULD_NOT = "could not be judged"


async def graded(lesson: LessonFolder, folder: Path) -> WholeGrade:
    """Grade a folder; whatever goes wrong is said in the result."""
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
        return _read(read_json(out)["grades"][0])
    except (ValueError, KeyError, IndexError, TypeError):
        last = errors.decode(errors="replace").strip().splitlines()[-1:]
        return WholeGrade(0, lesson.points, {}, "".join(last))


def _read(grade: dict[str, Any]) -> WholeGrade:
    steps = [step for step in grade["steps"] if step["state"] != _PASSED]
    failed = {step["id"]: step["message"] for step in steps if step["state"] != _COULD_NOT}
    reason = next((step["message"] for step in steps if step["state"] == _COULD_NOT), "")
    return WholeGrade(grade["points"], grade["max_points"], failed, reason)
