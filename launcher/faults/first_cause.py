"""Which of several exceptions is the mistake: one may have happened while another was on its way.

Python tells of the last. In a `finally`, or at the end of a `with`, it hides the first, which
nobody has taken care of; in an `except` it is the mistake itself, unless what it misses is what the
first one kept from being made.
"""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from launcher.faults.failure import Failure

if TYPE_CHECKING:
    from collections.abc import Sequence

    from launcher.faults.failure import TraceLevel

_ENDS = ("KeyboardInterrupt", "SystemExit", "GeneratorExit", "ExternalShutdownException")
"""What ends a program in the usual way: what goes wrong after it is a mistake of its own."""


def first_cause(error: BaseException, folder: str) -> BaseException:
    """Return the exception that has led to this one, itself if none has."""
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
