"""What beginners get wrong in a lesson: `wrong.diff`, changes of its solution.

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

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from launcher.errors import UsageError
from text.sentences import say

WRONG = "wrong.diff"


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
