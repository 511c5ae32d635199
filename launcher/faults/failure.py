"""An exception of a learner's program, with all that the interpreter knows of it.

The learner's own frame, the expression of the source that failed in it, and what its parts are:
looked up in the frame without calling anything. Positions within a line need Python 3.11; before,
the first fitting expression of the line is taken.
"""

from __future__ import annotations

import array
import ast
import builtins
import inspect
import itertools
import sys
import typing
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from types import CodeType, FrameType, ModuleType, TracebackType
from typing import Any, NamedTuple, TypeVar

from text.sentences import Words

Kind = TypeVar("Kind", bound=ast.AST)
LONGEST = 60
"""Characters of an expression that a sentence repeats."""


class _Unknown:
    """Stands for a value that cannot be had without running something."""

    def __repr__(self) -> str:
        return "UNKNOWN"


UNKNOWN = _Unknown()


class TraceLevel(NamedTuple):
    """One level of the traceback."""

    frame: FrameType
    line: int
    instruction: int

    @property
    def file(self) -> str:
        return self.frame.f_code.co_filename

    @property
    def function(self) -> str:
        return self.frame.f_code.co_name

    @property
    def values(self) -> dict[str, Any]:
        return self.frame.f_locals

    def is_in(self, package: str, module: str = "") -> bool:
        """Whether its code is part of a package, and of this module of it."""
        return f"/{package}/" in self.file and self.file.endswith(f"{module}.py")


class Failure:
    """An exception, where it happened, and what is known there."""

    def __init__(self, error: BaseException, folder: str, at: TraceLevel | None = None) -> None:
        """`folder`: that of the learner's own files; `at`: a level of his to look at instead."""
        self.error = error
        self.folder = folder
        self.levels = list(_levels(error.__traceback__))
        own = [each for each in self.levels if each.file.rpartition("/")[0] == folder]
        self.own: TraceLevel | None = at or (own[-1] if own else None)
        """The last level that is in the learner's own file."""

    @property
    def inner(self) -> TraceLevel | None:
        return self.levels[-1] if self.levels else None

    @property
    def is_own(self) -> bool:
        """Whether the learner's own line has raised it, and nothing that this line calls."""
        return self.own is not None and self.own is self.inner

    def below(self, package: str) -> Iterator[TraceLevel]:
        """Yield the levels of a package that are below the learner's own."""
        begin = self.levels.index(self.own) + 1 if self.own is not None else 0
        yield from (each for each in self.levels[begin:] if each.is_in(package))

    # The source.

    @cached_property
    def tree(self) -> ast.Module:
        """The source of the learner's own file; empty if it cannot be read."""
        try:
            assert self.own is not None
            tree = ast.parse(Path(self.own.file).read_bytes())
        except (AssertionError, OSError, SyntaxError, ValueError, RecursionError):
            return ast.Module([], [])
        for parent in ast.walk(tree):
            for child in ast.iter_child_nodes(parent):
                child.parent = parent  # type: ignore[attr-defined]
        return tree

    @cached_property
    def node(self) -> ast.AST | None:
        """The expression or statement that failed; the whole statement where no more is known."""
        if self.own is None:
            return None
        place = _position(self.own)
        on_line = [each for each in ast.walk(self.tree) if _covers(each, self.own.line)]
        if place is not None:
            exact = [each for each in on_line if _place(each) == place]
            if exact:
                return exact[-1]
        statements = [each for each in on_line if isinstance(each, ast.stmt)]
        return statements[-1] if statements else None

    @property
    def statement(self) -> ast.stmt | None:
        node = self.node
        while node is not None and not isinstance(node, ast.stmt):
            node = getattr(node, "parent", None)
        return node

    def all(self, kind: type[Kind]) -> list[Kind]:
        """Return the expressions of a kind that may have failed, the likeliest first."""
        if self.node is None or self.own is None:
            return []
        if isinstance(self.node, kind):
            return [self.node]
        inside = self.node if isinstance(self.node, ast.stmt) else self.statement
        assert inside is not None
        found = [each for each in ast.walk(inside) if isinstance(each, kind)]
        return [each for each in found if _covers(each, self.own.line)]

    def first(self, kind: type[Kind]) -> Kind | None:
        """Return the expression of a kind that has failed, None if there is none."""
        return next(iter(self.all(kind)), None)

    def refused_calls(self) -> list[ast.Call]:
        """Return the calls of the learner's own line, one of which Python may have refused."""
        is_refused = isinstance(self.error, TypeError) and self.is_own
        if isinstance(self.node, (ast.Subscript, ast.BinOp, ast.Compare, ast.UnaryOp)):
            return []
        return self.all(ast.Call) if is_refused else []

    @cached_property
    def own_class(self) -> ast.ClassDef | None:
        node: ast.AST | None = self.statement
        while node is not None and not isinstance(node, ast.ClassDef):
            node = getattr(node, "parent", None)
        return node

    # Values.

    def value(self, node: ast.AST | None) -> Any:
        """Return what an expression stands for, `UNKNOWN` if something would have to be run."""
        if isinstance(node, ast.Constant):
            return node.value
        if isinstance(node, ast.Name):
            return self.named(node.id)
        if isinstance(node, ast.Attribute):
            return attribute(self.value(node.value), node.attr)
        if isinstance(node, ast.Subscript):
            return _item(self.value(node.value), self.value(node.slice))
        if isinstance(node, (ast.List, ast.Tuple)):
            values = [self.value(each) for each in node.elts]
            if UNKNOWN in map(_plainly, values):
                return UNKNOWN
            return tuple(values) if isinstance(node, ast.Tuple) else values
        if isinstance(node, ast.JoinedStr):
            return ""
        if isinstance(node, ast.Call):
            return self._parameter(node)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            inner = self.value(node.operand)
            return -inner if isinstance(inner, (int, float)) else UNKNOWN
        return UNKNOWN

    def _parameter(self, call: ast.Call) -> Any:
        """Return the parameter that a call of a node's `get_parameter` gives."""
        func = call.func
        if not isinstance(func, ast.Attribute) or func.attr != "get_parameter" or not call.args:
            return UNKNOWN
        node, name = self.value(func.value), self.value(call.args[0])
        if not is_from(node, "rclpy", "Node") or not isinstance(name, str):
            return UNKNOWN
        return node._parameters.get(name, UNKNOWN)

    def named(self, name: str) -> Any:
        """Return the value of a variable."""
        if self.own is None:
            return UNKNOWN
        for space in (self.own.values, self.own.frame.f_globals, vars(builtins)):
            if name in space:
                return space[name]
        return UNKNOWN

    def given_by(self, node: ast.AST | None) -> ast.Call | None:
        """Return the call that has given a variable of this function its value, if one has."""
        if not isinstance(node, ast.Name) or self.own is None:
            return None
        found = [
            each.value
            for each in ast.walk(self.tree)
            if isinstance(each, ast.Assign)
            and isinstance(each.value, ast.Call)
            and [shown(target) for target in each.targets] == [node.id]
            and self.own.frame.f_code.co_firstlineno <= each.lineno < self.own.line
        ]
        return found[-1] if found else None

    def type_of(self, node: ast.AST | None) -> type | None:
        """Return the type of an expression; of a call, what its function says that it returns."""
        value = self.value(node)
        if value is not UNKNOWN:
            return type(value)
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub):
            left, right = self.type_of(node.left), self.type_of(node.right)
            return _difference(left, right)
        if not isinstance(node, ast.Call):
            return None
        called = self.called(node)
        if isinstance(called, type):
            return called
        return _returned(called)

    def called(self, call: ast.Call) -> Any:
        """Return the function or class that is called, `UNKNOWN` if it is not known."""
        value = self.value(call.func)
        if value is UNKNOWN and isinstance(call.func, ast.Attribute):
            owner = self.type_of(call.func.value)
            if owner is not None:
                return inspect.getattr_static(owner, call.func.attr, UNKNOWN)
        return value


def shown(node: ast.AST | None) -> str:
    """Return an expression as the learner has written it, shortened."""
    text = ast.unparse(node) if node is not None else ""
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"


def attribute(of: Any, name: str) -> Any:
    """Return an attribute if that runs nothing of the learner's own."""
    if of is UNKNOWN:
        return UNKNOWN
    if isinstance(of, ModuleType) or is_message(of):
        return getattr(of, name, UNKNOWN)
    found = inspect.getattr_static(of, name, UNKNOWN)
    if inspect.isdatadescriptor(found) and not inspect.isgetsetdescriptor(found):
        ours = not isinstance(found, property) or "/rclpy/" in _file_of(found)
        return getattr(of, name, UNKNOWN) if ours else UNKNOWN
    return found if found is UNKNOWN else getattr(of, name, UNKNOWN)


def is_message(value: object) -> bool:
    """Whether it is a message, a request or the like, not its class."""
    return not isinstance(value, type) and is_message_class(type(value))


def is_message_class(value: object) -> bool:
    """Whether it is the class of messages."""
    return isinstance(value, type) and hasattr(value, "get_fields_and_field_types")


def is_service_class(value: object) -> bool:
    """Whether it is the class of a service."""
    return isinstance(value, type) and hasattr(value, "Request") and hasattr(value, "Response")


def is_action_class(value: object) -> bool:
    """Whether it is the class of an action."""
    return isinstance(value, type) and hasattr(value, "Goal") and hasattr(value, "Feedback")


def fields_of(message: Any) -> dict[str, str]:
    """Return the fields of a message or its class, and their types."""
    fields: dict[str, str] = message.get_fields_and_field_types()
    return {name: of for name, of in fields.items() if not name.startswith("_")}


def is_from(value: object, package: str, *names: str) -> bool:
    """Whether it is an object of one of these classes of a package."""
    return any(
        each.__name__ in names and each.__module__.partition(".")[0] == package for each in type(value).__mro__
    )


def name_of(kind: type | None) -> str:
    """Return the name of a type as a learner writes it: `AddTwoInts.Request`, `None`."""
    if kind is None:
        return "?"
    if kind is type(None):
        return "None"
    outer, _, inner = kind.__name__.rpartition("_")
    return f"{outer}.{inner}" if outer and is_message_class(kind) else kind.__name__


def _levels(trace: TracebackType | None) -> Iterator[TraceLevel]:
    while trace is not None:
        yield TraceLevel(trace.tb_frame, trace.tb_lineno, trace.tb_lasti)
        trace = trace.tb_next


def _position(level: TraceLevel) -> tuple[int, int, int, int] | None:
    positions = getattr(level.frame.f_code, "co_positions", None)
    if positions is None or level.instruction < 0:
        return None
    width = 2
    found = next(itertools.islice(positions(), level.instruction // width, None), None)
    return None if found is None or None in found else found


def _place(node: ast.AST) -> tuple[int | None, ...]:
    names = ("lineno", "end_lineno", "col_offset", "end_col_offset")
    return tuple(getattr(node, name, None) for name in names)


def _covers(node: ast.AST, line: int) -> bool:
    begin = getattr(node, "lineno", None)
    return begin is not None and begin <= line <= (node.end_lineno or begin)  # type: ignore[attr-defined]


def _item(of: Any, index: Any) -> Any:
    if isinstance(of, (list, tuple, dict, str, bytes, array.array)) and index is not UNKNOWN:
        try:
            return of[index]
        except (LookupError, TypeError):
            return UNKNOWN
    return UNKNOWN


def _plainly(value: object) -> object:
    """Make a value that `in` can compare: arrays compare by element."""
    return value if value is UNKNOWN else None


def _file_of(found: property) -> str:
    code: CodeType | None = getattr(found.fget, "__code__", None)
    return code.co_filename if code else ""


def _difference(left: type | None, right: type | None) -> type | None:
    """Return the type of a difference of two times of rclpy: a Duration."""
    if left is None or left is not right or left.__module__ != "rclpy.time":
        return None
    return getattr(sys.modules.get("rclpy.duration"), "Duration", None)


def _returned(called: object) -> type | None:
    if called in (input, str):
        return str
    if getattr(called, "__qualname__", "") == "Parameter.get_parameter_value":
        return getattr(sys.modules.get("rcl_interfaces.msg"), "ParameterValue", None)
    try:
        returns = typing.get_type_hints(called).get("return")
    except Exception:  # noqa: BLE001 - a hint may be anything
        return None
    return returns if isinstance(returns, type) else None


class Rule(typing.Protocol):
    """What recognises mistakes of one kind, and says what they mean."""

    __module__: str
    __name__: str

    def __call__(self, failure: Failure, /) -> Words | None: ...
