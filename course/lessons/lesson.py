"""One lesson: its folder, with steps, texts, starter, solution and what beginners get wrong.

lesson.yaml            a profile that extends the lesson's own, with `values:` and `steps:`
text.en.md text.ru.md  `# Title`, an introduction, and a section `## id` for each step, which ends
                       with a task: `**Your task**: ...`, `**Задание**: ...`
starter/               what the learner begins with, lesson.yaml included
solution/              the files that differ from the starter's
wrong.diff             changes of the solution, and the step that each must fail, see `course.lessons.mistakes`
checks.py              functions for `python:` checks
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from course.lessons.mistakes import WRONG, Mistake, read_mistakes
from launcher.errors import UsageError
from launcher.profile.defaults import FOLDERS_OWN
from launcher.profile.load import load_profile
from launcher.profile.model import Profile
from launcher.profile.steps.model import StepDocument
from text.os_words import os_reason
from text.sentences import say

LANGUAGES = ("en", "ru")
_SECTION = re.compile(r"^## +(\S+) *$", re.MULTILINE)
_TASK = re.compile(r"^\*\*(?:Your task|Задание)\*\*", re.MULTILINE)
_LAST = re.compile(r"\n\s*\n(?!.*\n\s*\n)", re.DOTALL)
"""Before the last paragraph."""
IGNORED = {"__pycache__", ".pytest_cache"}


@dataclass(frozen=True)
class LessonFolder:
    """The folder of a lesson."""

    path: Path
    """Absolute."""

    @property
    def name(self) -> str:
        """The name of the folder: `02-sonar-safety`."""
        return self.path.name

    @cached_property
    def profile(self) -> Profile:
        """Its steps and values; the nodes are those of Deck. Raises ProfileError."""
        return load_profile(self.path / FOLDERS_OWN)

    @property
    def steps(self) -> tuple[StepDocument, ...]:
        return self.profile.steps

    @property
    def points(self) -> int:
        return sum(step.points for step in self.steps)

    @property
    def starter(self) -> Path:
        """The folder that the learner's begins as."""
        return self.path / "starter"

    @property
    def solution(self) -> Path:
        """The folder of the files that differ from the starter's."""
        return self.path / "solution"

    def mistakes(self) -> list[Mistake]:
        """Return what beginners get wrong, in the order of the file. Raises UsageError."""
        file = self.path / WRONG
        return read_mistakes(file, _read(file).splitlines()) if file.is_file() else []

    def texts(self, language: str) -> Texts:
        """Return what there is to read; in English if there is nothing in this language.

        Raises:
            UsageError: if there is nothing, or if it cannot be read.
        """
        for code in (language, "en"):
            file = self.path / f"text.{code}.md"
            if file.is_file():
                return _texts(_read(file))
        raise UsageError(say("{folder} has no text.en.md: write what is to be learnt", folder=str(self.path)))


@dataclass(frozen=True)
class Texts:
    """What a learner reads, in Markdown."""

    introduction: str
    sections: dict[str, str]
    """By the id of the step."""

    def explained(self, step: str) -> str:
        """Return what a step says before its task."""
        return self._parted(step)[0]

    def task(self, step: str) -> str:
        """Return what is to be done: from `**Your task**` on, else the last paragraph."""
        return self._parted(step)[1]

    def _parted(self, step: str) -> tuple[str, str]:
        text = self.sections.get(step, "")
        before = _TASK.search(text) or _LAST.search(text)
        at = before.start() if before else 0
        if "```" in text[at:] and not _TASK.match(text, at):
            # The last paragraph may be the end of some code.
            return text, ""
        return text[:at].strip("\n"), text[at:].strip("\n")


def _read(file: Path) -> str:
    try:
        return file.read_text("utf-8")
    except UnicodeDecodeError:
        raise UsageError(say("{path} is not UTF-8: save it as UTF-8", path=str(file))) from None
    except OSError as error:
        reason = os_reason(error)
        raise UsageError(say("{path} cannot be read: {reason}", path=str(file), reason=reason)) from error


def _texts(text: str) -> Texts:
    parts = _SECTION.split(text)
    names, bodies = parts[1::2], parts[2::2]
    sections = {name: body.strip("\n") for name, body in zip(names, bodies, strict=True)}
    return Texts(parts[0].strip(), sections)


def folders(folder: Path) -> list[Path]:
    """Return the folders in a folder, none if there is none; not what Python leaves there."""
    if not folder.is_dir():
        return []
    return sorted(each for each in folder.iterdir() if each.is_dir() and each.name not in IGNORED)
