"""The progress file: steps passed, points, hints taken, solutions seen, and the last lesson.

`progress.json` in the course folder. Deleted or broken it costs ticks, never files: a broken one
is kept as `progress.json.broken` when it is next written.

{"last": "02-sonar-safety",
 "lessons": {"02-sonar-safety": {"topic": {"passed": true, "points": 2, "hints": 1,
                                           "files": "0a1b2c3d4e5f6071", "at": 1767225600}}}}
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import TypedDict

from course.lessons.catalog import course_dir
from text.nested import read_json

NAME = "progress.json"
MOST_BYTES = 1 << 20
MOST_POINTS = 1000
MOST_HINTS = 9


@dataclass(frozen=True)
class StepProgress:
    """How far the learner is with a step."""

    passed: bool = False
    points: int = 0
    """Earned when it passed."""
    hints: int = 0
    """How many were asked for."""
    solution: bool = False
    """Whether the solution was looked at."""
    files: str = ""
    """The state of the files that it passed with, see `course.progress.state_of`."""
    at: int = 0
    """When, as Unix time; 0 if that is not known."""
    graded: str = ""
    """The state of the files with which it has passed in a grading of the whole lesson."""


class StepChanges(TypedDict, total=False):
    """What is to be noted of a step."""

    passed: bool
    points: int
    hints: int
    solution: bool
    files: str
    at: int
    graded: str


@dataclass(frozen=True)
class Progress:
    """How far the learner is with everything."""

    last: str = ""
    """The lesson that was open last, by the name of its folder."""
    lessons: Mapping[str, Mapping[str, StepProgress]] = field(default_factory=dict)
    """Lesson to step to how far it is; only what has begun."""

    def step(self, lesson: str, step: str) -> StepProgress:
        return self.lessons.get(lesson, {}).get(step, StepProgress())

    def passed(self, lesson: str) -> frozenset[str]:
        return frozenset(name for name, step in self.lessons.get(lesson, {}).items() if step.passed)

    def held(self, lesson: str, files: str) -> frozenset[str]:
        """Return those of them that have passed with these files."""
        return frozenset(name for name in self.passed(lesson) if self.step(lesson, name).files == files)

    def points(self, lesson: str, steps: Iterable[str]) -> int:
        return sum(self.step(lesson, step).points for step in steps)

    def with_step(self, lesson: str, step: str, changes: StepChanges) -> Progress:
        """Return the same with a step that has got further."""
        steps = {**self.lessons.get(lesson, {}), step: StepProgress(**{**vars(self.step(lesson, step)), **changes})}
        return replace(self, lessons={**self.lessons, lesson: steps})


def progress_file() -> Path:
    """Return the path of the file, which need not exist."""
    return course_dir() / NAME


def load_progress(path: Path | None = None) -> Progress:
    """Read the file; whatever in it makes no sense counts as not done."""
    return _read(path or progress_file())[0]


def noted(lesson: str, step: str = "", changes: StepChanges | None = None, path: Path | None = None) -> Progress:
    """Note how far a step is, beside what others have noted meanwhile; return everything.

    Raises:
        OSError: if the file cannot be written.
    """
    file = path or progress_file()
    progress, sound = _read(file)
    changed = replace(progress, last=lesson)
    if step:
        changed = changed.with_step(lesson, step, changes or {})
    if not sound:
        with contextlib.suppress(OSError):
            file.replace(file.with_name(f"{NAME}.broken"))
    if changed != progress or not sound:
        _write(file, changed)
    return changed


def _read(path: Path) -> tuple[Progress, bool]:
    """Return what the file says, and whether all of it made sense."""
    try:
        with path.open("rb") as file:
            text = file.read(MOST_BYTES + 1)
        raw = read_json(text) if len(text) <= MOST_BYTES else None
    except FileNotFoundError:
        return Progress(), True
    except (OSError, ValueError):
        return Progress(), False
    if not isinstance(raw, dict):
        return Progress(), False
    last, lessons = raw.get("last", ""), raw.get("lessons", {})
    sound = isinstance(last, str) and isinstance(lessons, dict)
    found: dict[str, dict[str, StepProgress]] = {}
    for name, steps in lessons.items() if isinstance(lessons, dict) else ():
        if not isinstance(steps, dict):
            sound = False
            continue
        for step, raw_step in steps.items():
            one = _step(raw_step)
            if one is None:
                sound = False
            else:
                found.setdefault(name, {})[step] = one
    return Progress(last if isinstance(last, str) else "", found), sound


def _step(raw: object) -> StepProgress | None:
    """Return a step as it is in the file; None if that cannot be."""
    known = {one.name: type(one.default) for one in fields(StepProgress)}
    if not isinstance(raw, dict) or any(
        name not in known or type(value) is not known[name] for name, value in raw.items()
    ):
        return None
    step = StepProgress(**raw)
    fits = 0 <= step.points <= MOST_POINTS and 0 <= step.hints <= MOST_HINTS
    return step if fits else None


def _write(path: Path, progress: Progress) -> None:
    """Replace the file at once, so that nobody ever reads half of it."""
    lessons = {
        name: {step: {k: v for k, v in vars(one).items() if v} for step, one in steps.items()}
        for name, steps in progress.lessons.items()
    }
    text = json.dumps({"last": progress.last, "lessons": lessons}, ensure_ascii=False, indent=1)
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, beside = tempfile.mkstemp(dir=path.parent, prefix=f".{NAME}.")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text + "\n")
        Path(beside).replace(path)
    except BaseException:
        Path(beside).unlink(missing_ok=True)
        raise


def state_of(files: Iterable[str]) -> str:
    """Return what tells this state from others: of these and all Python files beside them.

    Empty if there is none to be read.
    """
    found = hashlib.sha256()
    any_there = False
    for folder in sorted({Path(file).parent for file in files if file}):
        for path in sorted(folder.glob("*.py")):
            with contextlib.suppress(OSError), path.open("rb") as file:
                content = file.read(MOST_BYTES)
                any_there = True
                found.update(f"{path.name} {len(content)} ".encode())
                found.update(content)
    return found.hexdigest()[:16] if any_there else ""
