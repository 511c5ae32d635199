"""Whether a message fits an expression: `m.data > 0.5`, as `ros2 topic echo --filter` takes it.

Only what is listed here is understood, and nothing is ever run as Python: fields, elements, comparisons,
arithmetic, `and`, `or`, `not`, `in` and a few functions. No method of a message can be called, and only its fields
can be reached.
(The evaluators on PyPI read attributes of live objects, look at all of a message for each part of the expression, and
do not say where in the text something is wrong.)
"""

from __future__ import annotations

import ast
import math
import operator
import warnings
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from graph.messages.making import no_such_field
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from graph.data import Value

MESSAGE = "m"
"""The name of the message in an expression."""
LONGEST = 500
DEEPEST = 40
"""Maximum nesting of brackets and signs."""
QUOTED = 60
"""Characters of the expression that an error repeats."""
CONSTANTS: dict[str, Any] = {"true": True, "false": False, "inf": math.inf, "nan": math.nan}
FUNCTIONS: dict[str, Callable[[Any], Any]] = {"abs": abs, "len": len, "max": max, "min": min, "sum": sum}
"""Functions of one argument."""
_ARITHMETIC: dict[type[ast.AST], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
}
_COMPARED: dict[type[ast.AST], Callable[[Any, Any], Any]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.In: lambda one, many: one in many,
    ast.NotIn: lambda one, many: one not in many,
}
_SIGNS: dict[type[ast.AST], Callable[[Any], Any]] = {
    ast.Not: operator.not_,
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
}
_INNER = (ast.And, ast.Or, ast.Load, *_ARITHMETIC, *_COMPARED, *_SIGNS)
"""What may stand in an expression, and has no value of its own."""


class ConditionError(ValueError):
    """An expression is wrong, or asks for something that a message does not have."""

    def __init__(self, column: int, part: str, message: str) -> None:
        """Report what is wrong with this part of the expression, which begins at this column."""
        message = say("{part}: {message}", part=part, message=message) if part else message
        self.words = say("column {column}: {message}", column=column, message=message)
        super().__init__(str(self.words))


class _RefusalError(Exception):
    """A part of the expression is not understood, or has no value for this message."""

    def __init__(self, node: ast.AST, words: str) -> None:
        super().__init__(words)
        self.node = node
        self.words = words


class MessageFilter:
    """An expression about a message, which is called `m`."""

    def __init__(self, text: str) -> None:
        """Parse and check the expression. Raises ConditionError."""
        self._text = text.strip()
        self._skipped = len(text) - len(text.lstrip())
        if len(text) > LONGEST:
            raise ConditionError(LONGEST + 1, "", say("{n} characters at most", n=LONGEST))
        self._root = self._parsed()
        try:
            _check(self._root, 0)
        except _RefusalError as refusal:
            raise self._error(refusal) from refusal

    def holds(self, message: Mapping[str, Value]) -> bool:
        """Return whether it is true of this message. Raises ConditionError."""
        try:
            return bool(_value(self._root, message))
        except _RefusalError as refusal:
            raise self._error(refusal) from refusal

    def _parsed(self) -> ast.expr:
        text = self._text
        why = say("cannot be parsed from here on")
        try:
            # Python warns about an odd escape in a string, on the terminal that is the screen.
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                return ast.parse(text, mode="eval").body
        except SyntaxError as error:
            # Python gives no position if the expression ends too early.
            at = min(error.offset or len(text) + 1, len(text) + 1)
            if text[at - 1 : at] == "=" or "'=='" in (error.msg or ""):
                why = say("write == to compare")
            raise ConditionError(at + self._skipped, "", why) from error
        except (ValueError, RecursionError, MemoryError) as error:
            raise ConditionError(1, "", why) from error

    def _error(self, refusal: _RefusalError) -> ConditionError:
        node = refusal.node
        # Positions are counted in UTF-8 bytes; an operator has none.
        at = len(self._text.encode()[: getattr(node, "col_offset", 0)].decode(errors="ignore"))
        part = (ast.get_source_segment(self._text, node) if isinstance(node, ast.expr) else "") or ""
        shown = part if len(part) <= QUOTED else part[: QUOTED - 1] + "…"
        return ConditionError(at + 1 + self._skipped, shown, refusal.words)


def _check(node: ast.AST, depth: int) -> None:
    """Refuse whatever is not listed here, before any message arrives."""
    if depth > DEEPEST:
        raise _RefusalError(node, say("too many nested brackets"))
    of_no_use = isinstance(node, ast.Constant) and not isinstance(node.value, (bool, int, float, str))
    if type(node) not in {*_EVALUATED, *_INNER} or of_no_use:
        raise _RefusalError(node, say("this cannot be used here"))
    if isinstance(node, ast.Name):
        if node.id in FUNCTIONS:
            raise _RefusalError(node, say("it is a function: write {name}(…)", name=node.id))
        if node.id != MESSAGE and node.id not in CONSTANTS:
            raise _RefusalError(node, say("the message is called m: write m.{name}", name=node.id))
    if isinstance(node, ast.Call):
        named = node.func.id if isinstance(node.func, ast.Name) else ""
        if named not in FUNCTIONS:
            raise _RefusalError(node.func, say("only these can be called: {names}", names=", ".join(FUNCTIONS)))
        if node.keywords or len(node.args) != 1:
            raise _RefusalError(node, say("{name} takes one value in its brackets", name=named))
    for child in node.args if isinstance(node, ast.Call) else ast.iter_child_nodes(node):
        _check(child, depth + 1)


def _value(node: ast.expr, message: Any) -> Any:  # noqa: ANN401 - of any kind
    """Return the value of an expression that has been checked. Raises _RefusalError, in Python's words as a rule."""
    try:
        return _EVALUATED[type(node)](node, message)
    except (ArithmeticError, LookupError, TypeError, ValueError) as error:
        raise _RefusalError(node, reason_of(error)) from error


def _listed(node: Any, message: Any) -> list[Any]:  # noqa: ANN401
    return [_value(each, message) for each in node.elts]


def _joined(node: Any, message: Any) -> bool:  # noqa: ANN401
    parts = (_value(part, message) for part in node.values)
    return all(parts) if isinstance(node.op, ast.And) else any(parts)


def _computed(node: Any, message: Any) -> Any:  # noqa: ANN401
    # Numbers only: a string times a number could become arbitrarily long.
    return _ARITHMETIC[type(node.op)](_number(node.left, message), _number(node.right, message))


def _compared(node: Any, message: Any) -> bool:  # noqa: ANN401
    values = [_value(each, message) for each in (node.left, *node.comparators)]
    return all(_COMPARED[type(sign)](*pair) for sign, *pair in zip(node.ops, values, values[1:], strict=False))


def _element(node: Any, message: Any) -> Any:  # noqa: ANN401
    value = _value(node.value, message)
    if isinstance(value, Mapping):
        raise _RefusalError(node, say("a message has no elements"))
    return _plain(value[_value(node.slice, message)])


def _field(node: Any, message: Any) -> Any:  # noqa: ANN401
    value = _value(node.value, message)
    if not isinstance(value, Mapping):
        raise _RefusalError(node, say("only a message has fields"))
    if node.attr not in value:
        raise _RefusalError(node, no_such_field(node.attr, list(value)))
    return _plain(value[node.attr])


_EVALUATED: dict[type[ast.AST], Callable[[Any, Any], Any]] = {
    ast.Name: lambda node, message: message if node.id == MESSAGE else CONSTANTS[node.id],
    ast.Constant: lambda node, _message: node.value,
    ast.List: _listed,
    ast.Tuple: _listed,
    ast.Attribute: _field,
    ast.Subscript: _element,
    ast.BoolOp: _joined,
    ast.UnaryOp: lambda node, message: _SIGNS[type(node.op)](_value(node.operand, message)),
    ast.BinOp: _computed,
    ast.Compare: _compared,
    ast.Call: lambda node, message: FUNCTIONS[node.func.id](_value(node.args[0], message)),
}


def _number(node: ast.expr, message: Any) -> Any:  # noqa: ANN401
    value = _value(node, message)
    if isinstance(value, (bool, int, float)):
        return value
    raise _RefusalError(node, say("it is not a number"))


def _plain(value: Any) -> Any:  # noqa: ANN401
    """Return what numpy holds as Python's numbers, which neither warn nor wrap around, and compare as a whole."""
    if hasattr(value, "tolist"):
        return value.tolist()
    return list(value) if isinstance(value, bytes) else value
