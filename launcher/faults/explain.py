"""An uncaught exception of a learner's program, explained within its own process.

There the interpreter still knows everything: the exception with its objects, the frames with their
variables, rclpy's own functions. What is printed afterwards is only words.
"""

from __future__ import annotations

import linecache
from typing import TYPE_CHECKING

from launcher.faults.failure import Failure
from launcher.faults.first_cause import first_cause
from launcher.faults.ros_arguments import meaning_of_arguments
from launcher.faults.rules import (
    actions,
    arrays,
    attributes,
    callbacks,
    calling,
    classes,
    creating,
    field_names,
    fields,
    handed,
    imports,
    logger,
    names,
    opencv,
    operating,
    outside,
    parameters,
    ros,
    threads,
    values,
)
from launcher.faults.rules.syntax import encoding_of, syntax
from launcher.status import NodeFault
from text.plain import plain

if TYPE_CHECKING:
    from launcher.faults.failure import Rule
    from text.sentences import Words

RULES: tuple[Rule, ...] = (
    lambda failure: meaning_of_arguments(str(failure.error)),
    *callbacks.RULES,
    *names.RULES[:1],
    actions.result,
    *fields.RULES,
    *field_names.RULES,
    *creating.RULES,
    *parameters.RULES,
    *ros.RULES,
    *opencv.RULES,
    *actions.RULES,
    logger.unfit,
    *handed.RULES,
    *imports.RULES,
    *names.RULES[1:],
    *ros.LAST,
    *attributes.RULES,
    *operating.RULES,
    logger.several,
    *classes.RULES,
    *calling.RULES,
    *values.RULES,
    *outside.RULES,
    *arrays.RULES,
    *values.LAST,
)
"""In order: the first that recognises the mistake counts."""
LONGEST = 240
"""Characters of an exception that are kept: rclpy writes the limits of a float64 out."""


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
    file, line = callbacks.place_of(failure) or threads.place_of(failure, program) or (file, line)
    return NodeFault(
        kind,
        file,
        line=line,
        source_line=plain(linecache.getline(file, line).strip()),
        exception=exception,
        meaning=meaning(failure),
    )


def meaning(failure: Failure) -> Words | str:
    """Return the sentence for a failure, empty if there is none."""
    for rule in RULES:
        try:
            words = rule(failure)
        except Exception:  # noqa: BLE001 - a learner's objects may raise whatever is asked
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
