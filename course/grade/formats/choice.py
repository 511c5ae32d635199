"""All formats, by the names that `deck grade --format` has for them."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from course.grade.defaults import CLASSROOM50
from course.grade.formats import classroom50, csv_table, gradescope, junit, own_json
from launcher.errors import UsageError
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from course.grade.grades import Grade

SINGLE = ("gradescope", CLASSROOM50)
"""Those of a single submission."""


def writer_of(name: str, count: int, environ: Mapping[str, str] = os.environ) -> Callable[[Sequence[Grade]], str]:
    """Return what writes this format.

    Raises:
        UsageError: if it is not for so many folders, or does not know whose submission it is.
    """
    if name in SINGLE and count != 1:
        raise UsageError(say("--format {name} is for one folder, and there are {n}", name=name, n=count))
    if name == CLASSROOM50:
        assignment = classroom50.Assignment.from_environment(environ)
        return lambda grades: classroom50.written(grades[0], assignment)
    if name == "gradescope":
        return lambda grades: gradescope.written(grades[0])
    return {"json": own_json.written, "junit": junit.written, "csv": csv_table.written}[name]
