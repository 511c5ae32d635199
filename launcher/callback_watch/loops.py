"""A loop of the learner's own that waits: for a future, or for what it does not change itself."""

from __future__ import annotations

import ast
import linecache

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import FrameType

_IDLE_CALLS = frozenset({"sleep", "debug", "info", "warning", "warn", "error", "print", "get_logger", "spin_once"})
"""What may be called in a loop that does nothing but wait."""


class Loop:
    """A `while` of the program's text."""

    def __init__(self, loop: ast.While) -> None:
        self.first, self.last = loop.lineno, loop.end_lineno or loop.lineno
        idle = all(map(_is_idle, loop.body))
        asked = [*_asked_done(loop.test)]
        if not asked and idle:
            for each in loop.body:
                asked += _asked_done(each.test) if isinstance(each, ast.If) else []
        self.futures = asked
        """The expressions whose `.done()` ends it."""
        self.endless = idle and _is_plain(loop.test)
        """Whether nothing in it changes what it waits for."""
        self.attributes = [each for each in ast.walk(loop.test) if isinstance(each, ast.Attribute)]
        self.spins = any(_called(each).startswith("spin") for each in ast.walk(loop) if isinstance(each, ast.Call))


def loop_at(frame: FrameType) -> Loop | None:
    """Return the innermost loop that a frame is in, if it waits for something."""
    loops = [each for each in _loops(frame.f_code.co_filename) if _holds(each, frame.f_lineno)]
    loop = max(loops, key=lambda each: each.first, default=None)
    return loop if loop is not None and (loop.futures or loop.endless) else None


def values_in(frame: FrameType, expression: ast.expr) -> list[object]:
    """Return what a name, or an attribute of one, stands for; if it is a list, what is in that."""
    value = _value(frame, expression)
    return list(value) if isinstance(value, list | tuple) else [value]


def is_property(frame: FrameType, attribute: ast.Attribute) -> bool:
    """Whether an attribute is worked out each time, by another than rclpy."""
    found = getattr(type(_value(frame, attribute.value)), attribute.attr, None)
    return isinstance(found, property) and "/rclpy/" not in str(getattr(found.fget, "__code__", None))


def _value(frame: FrameType, expression: ast.expr) -> object:
    """Return the value of a name, or of an attribute of one; None if that is not known."""
    if isinstance(expression, ast.Name):
        name = expression.id
        return frame.f_locals.get(name, frame.f_globals.get(name))
    if isinstance(expression, ast.Attribute):
        return getattr(_value(frame, expression.value), "__dict__", {}).get(expression.attr)
    return None


_known: dict[str, list[Loop]] = {}


def _loops(file: str) -> list[Loop]:
    if file not in _known:
        text = "".join(linecache.getlines(file))
        try:
            tree = ast.parse(text) if "while" in text else ast.Module([], [])
        except (SyntaxError, ValueError, RecursionError):
            tree = ast.Module([], [])
        _known[file] = [Loop(each) for each in ast.walk(tree) if isinstance(each, ast.While)]
    return _known[file]


def _holds(loop: Loop, line: int) -> bool:
    return loop.first <= line <= loop.last


def _asked_done(test: ast.expr) -> Sequence[ast.expr]:
    """Return what `.done()` is called of, or the list that this is taken from."""
    lists = {
        each.target.id: each.iter
        for each in ast.walk(test)
        if isinstance(each, ast.comprehension) and isinstance(each.target, ast.Name)
    }
    asked = [
        call.func.value
        for call in ast.walk(test)
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute) and call.func.attr == "done"
    ]
    return [lists.get(each.id, each) if isinstance(each, ast.Name) else each for each in asked]


def _is_idle(statement: ast.stmt) -> bool:
    if isinstance(statement, ast.If):
        ends = isinstance(statement.body[-1], ast.Break | ast.Return | ast.Raise)
        within = statement.orelse if ends else [*statement.body, *statement.orelse]
        return _is_plain(statement.test) and all(map(_is_idle, within))
    if isinstance(statement, ast.Expr):
        calls = [each for each in ast.walk(statement) if isinstance(each, ast.Call)]
        return all(_called(each) in _IDLE_CALLS for each in calls)
    return isinstance(statement, ast.Pass | ast.Continue)


def _is_plain(test: ast.expr) -> bool:
    """Whether what it tests can be changed by others only."""
    calls = [each for each in ast.walk(test) if isinstance(each, ast.Call)]
    return all(_called(each) in ("done", "ok", "is_set", "all", "any") for each in calls) and not any(
        isinstance(each, ast.NamedExpr | ast.Await | ast.Yield) for each in ast.walk(test)
    )


def _called(call: ast.Call) -> str:
    return getattr(call.func, "attr", getattr(call.func, "id", ""))
