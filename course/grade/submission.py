"""A folder that is to be graded: read once, before anything of it runs, and copied from memory.

Neither links nor pipes nor gigabytes in it hold anybody up. What runs later may have changed the
folder, or another one: what was read counts.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from course.lessons.lesson import IGNORED, LessonFolder
from launcher.errors import UsageError
from launcher.profile.defaults import FOLDERS_OWN
from text.sentences import say

MOST_FILES = 2000
MOST_BYTES = 64_000_000
"""Most of what is read of a folder, in all."""
NOT_READ = {*IGNORED, "node_modules", "venv"}
"""Folders that are never a learner's own work; those that begin with a dot are not read either."""


@dataclass(frozen=True)
class Files:
    """The files of a folder, in memory."""

    folder: Path
    contents: dict[Path, bytes] = field(default_factory=dict)
    """By path within the folder."""

    @classmethod
    def read(cls, folder: Path) -> Files:
        """Read a folder. Raises UsageError."""
        contents: dict[Path, bytes] = {}
        size = 0
        try:
            for path in _files(folder):
                data = _content(path, MOST_BYTES - size)
                size += len(data)
                if len(contents) == MOST_FILES or size > MOST_BYTES:
                    words = say(
                        "{folder} holds more than {n} files or {mb} MB: is it the right one?",
                        folder=str(folder),
                        n=MOST_FILES,
                        mb=MOST_BYTES // 1_000_000,
                    )
                    raise UsageError(words)
                contents[path.relative_to(folder)] = data
        except OSError as error:
            at, why = str(error.filename or folder), error.strerror or str(error)
            raise UsageError(say("{path} cannot be read: {why}", path=at, why=why)) from error
        return cls(folder, contents)

    def write(self, folder: Path, *, without: str = "") -> None:
        """Write them into another folder, over what is there."""
        for name, data in self.contents.items():
            if str(name) != without:
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                (folder / name).write_bytes(data)


def _files(folder: Path) -> Iterator[Path]:
    for place, folders, names in os.walk(folder, onerror=_raise):
        folders[:] = sorted(name for name in folders if name not in NOT_READ and not name.startswith("."))
        for name in sorted(names):
            path = Path(place, name)
            if stat.S_ISREG(path.lstat().st_mode):
                yield path


def _raise(error: OSError) -> None:
    raise error


def _content(path: Path, most: int) -> bytes:
    """Return a file's bytes, at most one more than so many."""
    # Between the look and the opening it may have become a pipe.
    descriptor = os.open(path, os.O_RDONLY | os.O_CLOEXEC | os.O_NOFOLLOW | os.O_NONBLOCK)
    with os.fdopen(descriptor, "rb") as file:
        return file.read(most + 1)


@dataclass(frozen=True)
class Submission:
    """One learner's folder."""

    student: str
    """Unique among those that are graded together."""
    folder: Path
    """Absolute."""


def submissions(lesson: LessonFolder, folders: Sequence[Path]) -> list[Submission]:
    """Return the folders to be graded, each under a name of its own.

    A folder that holds the lesson's folder, as `~/deck-course` does, stands for that one.

    Raises:
        UsageError: if one is no folder, or named twice.
    """
    found: list[tuple[Path, Path]] = []
    for folder in folders:
        named = Path(os.path.abspath(folder))  # noqa: PTH100 - `..` is meant as written
        if not named.is_dir():
            raise UsageError(say("there is no folder {path}", path=str(folder)))
        inner = named / lesson.name
        chosen = inner if inner.is_dir() and not _has_some_file(lesson, named) else named
        if any(chosen.samefile(other) for _, other in found):
            raise UsageError(say("{path} is named twice", path=str(folder)))
        found.append((named, chosen))
    names = _unique([named for named, _ in found])
    return [Submission(name, chosen) for name, (_, chosen) in zip(names, found, strict=True)]


def _unique(folders: Sequence[Path]) -> list[str]:
    """Name folders by their last parts: as few of them as tell all folders apart."""
    for depth in range(1, max((len(folder.parts) for folder in folders), default=1) + 1):
        names = ["/".join(folder.parts[-depth:]) for folder in folders]
        if len(set(names)) == len(names):
            return names
    return [str(folder) for folder in folders]


def files_of(lesson: LessonFolder) -> list[str]:
    """Return the names of the files that a learner writes."""
    if not lesson.starter.is_dir():
        return []
    paths = (path.relative_to(lesson.starter) for path in lesson.starter.rglob("*.py"))
    return sorted(str(path) for path in paths if not IGNORED & set(path.parts))


def _has_some_file(lesson: LessonFolder, folder: Path) -> bool:
    return any((folder / name).is_file() for name in files_of(lesson))


def default_folder(lesson: LessonFolder, own: Path) -> Path:
    """Return the folder that is meant if none is named: the learner's own, or this one.

    Raises:
        UsageError: if neither has a file of the lesson.
    """
    if own.is_dir():
        return own
    here = Path.cwd()
    if _has_some_file(lesson, here):
        return here
    raise UsageError(
        say(
            "there is no folder {path}, and none of the lesson's files is here: deck new {lesson} "
            "makes it, or name the folder",
            path=str(own),
            lesson=lesson.name,
        )
    )


def check_gradable(lesson: LessonFolder) -> None:
    """Make sure that a lesson can be graded: it is valid, has steps, and a profile to run.

    Raises:
        ProfileError, UsageError: if not.
    """
    if not lesson.steps:
        raise UsageError(say("{lesson} has no steps to be graded", lesson=lesson.name))
    if not (lesson.starter / FOLDERS_OWN).is_file():
        raise UsageError(say("there is no file {path}", path=str(lesson.starter / FOLDERS_OWN)))
