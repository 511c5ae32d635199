"""An uncaught exception of a learner's program, explained within its own process.

There the interpreter still knows everything: the exception with its objects, the frames with their
variables, rclpy's own functions. What is printed afterwards is only words.
"""

from __future__ import annotations

import linecache
import sys
from typing import TYPE_CHECKING

from launcher.faults.failure import Failure
from launcher.faults.first_cause import first_cause
from launcher.faults.rules import RULES
from launcher.faults.rules.callbacks import place_of
from launcher.faults.rules.syntax import encoding_of, syntax
from launcher.status import NodeFault
from text.plain import plain

if TYPE_CHECKING:
    from text.sentences import Words

LONGEST = 240
"""Characters of an exception that are kept: rclpy writes the limits of a float64 out."""
BROKEN = "[WARN] [deck]: a rule on mistakes is broken:"
"""How the line begins that tells of it."""


def explained(error: BaseException, program: str, kind: str = "crash") -> NodeFault:
    """Return where a learner's program, a file, has failed and what it means."""
    folder = program.rpartition("/")[0]
    error = first_cause(error, folder)
    exception = _shortened(error)
    if isinstance(error, SyntaxError):
        return _unreadable(error, exception)
    failure = Failure(error, folder)
    level = failure.own or failure.inner
    file, line = (level.file, level.line) if level is not None else ("", 0)
    file, line = place_of(failure, program) or (file, line)
    return NodeFault(
        kind,
        file,
        line=line,
        source_line=plain(linecache.getline(file, line).strip()),
        exception=exception,
        meaning=meaning(failure),
    )


def meaning(failure: Failure) -> Words | str:
    """Return the sentence of the first rule that recognises a failure, empty if none does.

    A rule that fails itself is told on standard error; the place and Python's own words are left.
    """
    for rule in RULES:
        try:
            words = rule(failure)
        except Exception as error:  # noqa: BLE001 - a learner's objects may raise whatever is asked
            sys.stderr.write(f"{BROKEN} {rule.__module__}.{rule.__name__}: {type(error).__name__}: {error}\n")
            continue
        if words is not None:
            return words
    return ""


def _unreadable(error: SyntaxError, exception: str) -> NodeFault:
    try:
        with open(error.filename or "", "rb") as file:  # noqa: PTH123
            data = file.read()
    except OSError:
        data = b""
    lines = data.decode(errors="replace").splitlines()
    return NodeFault(
        "syntax",
        error.filename or "",
        line=error.lineno or 0,
        column=error.offset or 0,
        source_line=plain((error.text or "").strip()),
        exception=exception,
        meaning=encoding_of(data) or syntax(error, lines),
    )


def _shortened(error: BaseException) -> str:
    name = type(error).__qualname__
    module = type(error).__module__
    name = name if module in ("builtins", "__main__") else f"{module}.{name}"
    said = error.msg if isinstance(error, SyntaxError) else str(error)
    words = plain(f"{name}: {said}" if said else name).strip().rstrip(".")
    return words if len(words) <= LONGEST else f"{words[: LONGEST - 1]}…"
