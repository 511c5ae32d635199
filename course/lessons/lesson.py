"""One lesson: its folder, with steps, texts, starter, solution and what beginners get wrong.

lesson.yaml            a profile that extends the lesson's own, with `values:` and `steps:`
text.en.md text.ru.md  `# Title`, an introduction, and a section `## id` for each step, which ends
                       with a task: `**Your task**: ...`, `**Задание**: ...`
starter/               what the learner begins with, lesson.yaml included
solution/              the files that differ from the starter's
wrong.diff             changes of the solution, and the step that each must fail, as below
checks.py              functions for `python:` checks

A change of the solution in wrong.diff:

## STEP/MISTAKE    the step that must fail, and the mistake's name
--- talker.py      the file of the solution that is changed
 a line that stays, to show the place
-a line that goes
+a line that comes
@@                 the next place in that file

The old lines must stand in the file exactly once. Numbers behind @@ and lines with +++ mean nothing, so that what
`diff -u` says can be put in; so does what stands before the first mistake.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

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


WRONG = "wrong.diff"


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


@dataclass
class _Place:
    """One place of a file, as the lines of a diff."""

    file: str
    lines: list[str] = field(default_factory=list)

    def side(self, left_out: str) -> str:
        """Return the lines before or after, without those of the other side."""
        while self.lines and not self.lines[-1]:  # Before the next mistake.
            self.lines.pop()
        return "".join(f"{line[1:]}\n" for line in self.lines if line[:1] != left_out)


class Mistake(NamedTuple):
    """Something that beginners get wrong."""

    step: str
    """The id of the step at which it must be caught."""
    name: str
    places: list[_Place]

    def make(self, solution: Path) -> None:
        """Make it in a copy of the solution.

        Raises:
            UsageError: if the lines to be changed are not there, or more than once.
        """
        for place in self.places:
            file = solution / place.file
            text = "\n" + file.read_text("utf-8") if file.is_file() else ""
            old, new = "\n" + place.side("+"), "\n" + place.side("-")
            if text.count(old) != 1:
                raise UsageError(
                    say(
                        "{file} has these lines {n} times, not once; add lines that stay: {lines}",
                        file=place.file,
                        n=text.count(old),
                        lines=old.strip("\n"),
                    )
                )
            file.write_text(text.replace(old, new)[1:], "utf-8")


def read_mistakes(file: Path, lines: Iterable[str]) -> list[Mistake]:
    """Return the mistakes in the lines of a `wrong.diff`, in its order.

    Raises:
        UsageError: with file and line, if it is none.
    """
    mistakes: list[Mistake] = []
    for number, line in enumerate(lines, 1):
        places = mistakes[-1].places if mistakes else []
        step, _, name = line[3:].strip().partition("/")
        if line.startswith("## ") and step and name:
            mistakes.append(Mistake(step, name, []))
        elif line.startswith("--- "):
            places.append(_Place(line[4:].split("\t")[0].strip()))
        elif line.startswith("@@") and places:
            if places[-1].lines:
                places.append(_Place(places[-1].file))
        elif places and line[:1] in ("", " ", "-", "+"):
            if not line.startswith("+++ "):
                places[-1].lines.append(line)
        elif mistakes and line:
            raise UsageError(
                say(
                    "{file}:{line}: expected ## STEP/MISTAKE, --- FILE, @@, or a line that begins"
                    " with a blank, - or +",
                    file=str(file),
                    line=number,
                )
            )
    return mistakes
