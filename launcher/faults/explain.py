"""An uncaught exception of a learner's program, explained within its own process.

There the interpreter still knows everything: the exception with its objects, the frames with their
variables, rclpy's own functions. What is printed afterwards is only words.
"""

from __future__ import annotations

import ast
import linecache
import re
import sys
from collections.abc import Sequence

from launcher.faults.failure import Failure, TraceLevel
from launcher.faults.rules import RULES
from launcher.faults.rules.callbacks import place_of
from launcher.faults.source import encoding_of, syntax
from launcher.status import NodeFault
from text.plain import plain
from text.sentences import Words

_ENDS = ("KeyboardInterrupt", "SystemExit", "GeneratorExit", "ExternalShutdownException")
"""What ends a program in the usual way: what goes wrong after it is a mistake of its own."""


def first_cause(error: BaseException, folder: str) -> BaseException:
    """Return the exception that has led to this one, itself if none has.

    One may have happened while another was on its way, and Python tells of the last. In a `finally`, or
    at the end of a `with`, it hides the first, which nobody has taken care of; in an `except` it is the
    mistake itself, unless what it misses is what the first one kept from being made.
    """
    met = {id(error)}
    while (before := _hidden_by(error, folder)) is not None and id(before) not in met:
        met.add(id(before))
        error = before
    return error


def _hidden_by(error: BaseException, folder: str) -> BaseException | None:
    before = error.__context__
    if before is None or error.__cause__ is not None or error.__suppress_context__:
        return None
    earlier = {id(each.frame): each for each in Failure(before, folder).levels}
    for level in Failure(error, folder).levels:
        began = earlier.get(id(level.frame))
        if began is not None and level.file.rpartition("/")[0] == folder:
            statement = _guarding(Failure(error, folder, level), began, level)
            if statement is not None and _follows(statement, error, before, level):
                return before
    return None


_With = (ast.With, ast.AsyncWith)


def _guarding(failure: Failure, began: TraceLevel, level: TraceLevel) -> ast.Try | ast.With | ast.AsyncWith | None:
    """Return the innermost `try` or `with` that the first has left, and that then failed itself."""
    found: list[ast.Try | ast.With | ast.AsyncWith] = [
        each
        for each in ast.walk(failure.tree)
        if isinstance(each, ast.Try)
        and (
            (_is_within(each.body, began.line) and _is_within(each.handlers, level.line))
            or (_is_within(_before_the_end(each), began.line) and _is_at_the_end(each, level))
        )
    ]
    found += [
        each
        for each in ast.walk(failure.tree)
        if isinstance(each, _With)
        and _is_within(each.body, began.line)
        and not _is_within(each.body, level.line)
        and _is_within([each], level.line)
    ]
    return max(found, key=lambda each: each.lineno, default=None)


def _before_the_end(statement: ast.Try) -> list[ast.AST]:
    return [*statement.body, *statement.handlers, *statement.orelse]


def _is_at_the_end(statement: ast.Try, level: TraceLevel) -> bool:
    return _is_within(statement.finalbody, level.line)


def _follows(
    statement: ast.Try | ast.With | ast.AsyncWith, error: BaseException, before: BaseException, level: TraceLevel
) -> bool:
    """Whether the second exception comes of the first one."""
    if isinstance(error, (NameError, AttributeError)):
        tree = Failure(error, level.file.rpartition("/")[0], level).tree
        if _missed(error, tree, level.line) & _made(statement.body):
            return True
    ends = isinstance(statement, _With) or _is_at_the_end(statement, level)
    return ends and type(before).__name__ not in _ENDS


def _missed(error: NameError | AttributeError, tree: ast.Module, line: int) -> set[str]:
    """Return the names of the variables or attributes of a line that may have no value."""
    if isinstance(error, AttributeError) and error.obj is None:
        # What has been None before, and should have got its value.
        return {
            str(getattr(each.value, "id", getattr(each.value, "attr", "")))
            for each in ast.walk(tree)
            if isinstance(each, ast.Attribute) and each.attr == error.name and each.lineno == line
        }
    # That of a local variable stands in the text only.
    found = re.search(r"variable '(\w+)'", str(error))
    return {found[1] if found else str(error.name or "")}


def _made(body: list[ast.stmt]) -> set[str]:
    """Return the names that these lines would have given a value."""
    nodes = [each for statement in body for each in ast.walk(statement)]
    kept = [each for each in nodes if isinstance(getattr(each, "ctx", None), ast.Store)]
    return {str(getattr(each, "id", getattr(each, "attr", ""))) for each in kept}


def _is_within(body: Sequence[ast.AST], line: int) -> bool:
    return any(each.lineno <= line <= (each.end_lineno or 0) for each in body)  # type: ignore[attr-defined]


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
