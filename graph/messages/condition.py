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
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from graph.messages.making import no_such_field
from text.sentences import say

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
MOST_BYTE = 255
MOST_WHOLE = 2**64
FUNCTIONS = ("abs", "len", "max", "min", "sum")
"""Functions of one argument."""
_OF_MANY: dict[str, Callable[[list[Any]], Any]] = {"max": max, "min": min, "sum": sum}
_OPERATIONS: dict[type[ast.AST], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}
_OTHERS = (ast.UAdd, ast.USub, ast.Not, ast.And, ast.Or, ast.Eq, ast.NotEq, ast.In, ast.NotIn, ast.Load)
"""What else may stand in an expression, and has no place of its own."""


class ConditionError(ValueError):
    """An expression is wrong, or asks for something that a message does not have."""

    def __init__(self, column: int, part: str, message: str) -> None:
        """Report what is wrong with this part of the expression, which begins at this column."""
        self.column = column
        """Counted from 1."""
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
            return _truth(self._root, {**CONSTANTS, MESSAGE: message})
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
    if isinstance(node, (*_OPERATIONS, *_OTHERS)):
        return
    of_no_use = isinstance(node, ast.Constant) and not isinstance(node.value, (bool, int, float, str))
    if type(node) not in _KINDS or of_no_use:
        raise _RefusalError(node, say("this cannot be used here"))
    if isinstance(node, ast.Name):
        _check_name(node)
    for child in _checked_call(node) if isinstance(node, ast.Call) else ast.iter_child_nodes(node):
        # An operator has no position of its own.
        if not isinstance(child, (ast.expr, *_OPERATIONS, *_OTHERS)):
            raise _RefusalError(node, say("this cannot be used here"))
        _check(child, depth + 1)


def _check_name(node: ast.Name) -> None:
    if node.id in FUNCTIONS:
        raise _RefusalError(node, say("it is a function: write {name}(…)", name=node.id))
    if node.id != MESSAGE and node.id not in CONSTANTS:
        raise _RefusalError(node, say("the message is called m: write m.{name}", name=node.id))


def _checked_call(node: ast.Call) -> list[ast.expr]:
    """Return the arguments of a call."""
    named = node.func.id if isinstance(node.func, ast.Name) else ""
    if named not in FUNCTIONS:
        raise _RefusalError(node.func, say("only these can be called: {names}", names=", ".join(FUNCTIONS)))
    if node.keywords or len(node.args) != 1:
        raise _RefusalError(node, say("{name} takes one value in its brackets", name=named))
    return node.args


def _value(node: ast.expr, names: Mapping[str, Any]) -> Any:  # noqa: ANN401 - any value
    """Return the value of an expression that has been checked. Raises _RefusalError."""
    return _KINDS[type(node)](node, names)


def _truth(node: ast.expr, names: Mapping[str, Any]) -> bool:
    """Return whether a value counts as true: a non-zero number, a non-empty string."""
    value = _value(node, names)
    if _is_number(value) or isinstance(value, str):
        return bool(value)
    raise _RefusalError(node, say("it is {kind}, which is neither true nor false", kind=_kind(value)))


def _number(node: ast.expr, names: Mapping[str, Any]) -> Any:  # noqa: ANN401
    value = _value(node, names)
    if _is_number(value):
        return value
    raise _RefusalError(node, say("{kind} is not a number", kind=_kind(value)))


def _field(node: Any, names: Mapping[str, Any]) -> Any:  # noqa: ANN401
    value = _value(node.value, names)
    if not isinstance(value, Mapping):
        raise _RefusalError(node, say("{kind} has no fields", kind=_kind(value)))
    if node.attr not in value:
        raise _RefusalError(node, no_such_field(node.attr, list(value)))
    return _plain(value[node.attr])


def _element(node: Any, names: Mapping[str, Any]) -> Any:  # noqa: ANN401
    value, index = _value(node.value, names), _value(node.slice, names)
    if isinstance(value, Mapping) or not _has_length(value):
        raise _RefusalError(node, say("{kind} has no elements", kind=_kind(value)))
    if not isinstance(index, int) or isinstance(index, bool):
        raise _RefusalError(node, say("the index of an element must be a whole number"))
    if not -len(value) <= index < len(value):
        raise _RefusalError(node, say("there are {n} elements, counted from 0", n=len(value)))
    return _plain(value[index])


def _bool(node: Any, names: Mapping[str, Any]) -> bool:  # noqa: ANN401
    parts = (_truth(part, names) for part in node.values)
    return all(parts) if isinstance(node.op, ast.And) else any(parts)


def _unary(node: Any, names: Mapping[str, Any]) -> Any:  # noqa: ANN401
    if isinstance(node.op, ast.Not):
        return not _truth(node.operand, names)
    number = _number(node.operand, names)
    return -number if isinstance(node.op, ast.USub) else number


def _binary(node: Any, names: Mapping[str, Any]) -> Any:  # noqa: ANN401
    # Numbers only: a string times a number could become arbitrarily long.
    left, right = _number(node.left, names), _number(node.right, names)
    try:
        return _OPERATIONS[type(node.op)](left, right)
    except ZeroDivisionError as error:
        raise _RefusalError(node, say("division by zero")) from error
    except ArithmeticError as error:
        raise _RefusalError(node, say("the number is too large")) from error


def _compare(node: Any, names: Mapping[str, Any]) -> bool:  # noqa: ANN401
    left = _value(node.left, names)
    for sign, each in zip(node.ops, node.comparators, strict=True):
        right = _value(each, names)
        if not _compared(node, sign, left, right):
            return False
        left = right
    return True


def _compared(node: ast.expr, sign: ast.cmpop, left: Any, right: Any) -> bool:  # noqa: ANN401
    if isinstance(sign, (ast.In, ast.NotIn)):
        return _is_in(node, left, right) is isinstance(sign, ast.In)
    if isinstance(sign, (ast.Eq, ast.NotEq)):
        if isinstance(left, Mapping) or isinstance(right, Mapping):
            raise _RefusalError(node, say("compare one of the fields of a message"))
        return bool(_listed_out(left) == _listed_out(right)) is isinstance(sign, ast.Eq)
    if not (_is_number(left) and _is_number(right)) and not (isinstance(left, str) and isinstance(right, str)):
        kinds = {"left": _kind(left), "right": _kind(right)}
        raise _RefusalError(node, say("{left} and {right} cannot be compared like this", **kinds))
    return bool(_OPERATIONS[type(sign)](left, right))


def _is_in(node: ast.expr, one: Any, many: Any) -> bool:  # noqa: ANN401
    if isinstance(many, str) and isinstance(one, str):
        return one in many
    if isinstance(many, (str, Mapping)) or not _has_length(many):
        kinds = {"left": _kind(one), "right": _kind(many)}
        raise _RefusalError(node, say("{left} cannot be in {right}", **kinds))
    if isinstance(many, bytes):
        return _is_number(one) and 0 <= one <= MOST_BYTE and one == int(one) and int(one) in many
    if isinstance(many, list):
        return any(_listed_out(_plain(each)) == _listed_out(one) for each in many)
    # An array of numbers, however long. numpy refuses to compare what no array can hold.
    holdable = _is_number(one) and (isinstance(one, float) or abs(one) <= MOST_WHOLE)
    return holdable and bool((many == one).any())


def _called(node: Any, names: Mapping[str, Any]) -> Any:  # noqa: ANN401
    name, argument = node.func.id, node.args[0]
    if name == "abs":
        return abs(_number(argument, names))
    value = _value(argument, names)
    if not _has_length(value):
        raise _RefusalError(argument, say("{kind} has no elements", kind=_kind(value)))
    if name == "len":
        return len(value)
    if not isinstance(value, (Mapping, str)):
        if not len(value):
            raise _RefusalError(argument, say("it is empty"))
        if hasattr(value, "dtype") and name != "sum":
            # In numpy, as an array may have a million elements. Its own sum could overflow or warn.
            return _plain(getattr(value, name)())
        numbers = [_plain(each) for each in _listed_out(value)]
        if all(map(_is_number, numbers)):
            return _OF_MANY[name](numbers)
    raise _RefusalError(argument, say("{name} takes a list of numbers", name=name))


def _listed(node: Any, names: Mapping[str, Any]) -> list[Any]:  # noqa: ANN401
    return [_value(each, names) for each in node.elts]


_KINDS: dict[type[ast.AST], Callable[[Any, Mapping[str, Any]], Any]] = {
    ast.Name: lambda node, names: names[node.id],
    ast.Constant: lambda node, _names: node.value,
    ast.List: _listed,
    ast.Tuple: _listed,
    ast.Attribute: _field,
    ast.Subscript: _element,
    ast.BoolOp: _bool,
    ast.UnaryOp: _unary,
    ast.BinOp: _binary,
    ast.Compare: _compare,
    ast.Call: _called,
}


def _plain(value: Any) -> Any:  # noqa: ANN401
    """Return a numpy scalar as a Python number, which neither warns nor wraps around."""
    return value.item() if hasattr(value, "item") and not getattr(value, "ndim", 0) else value


def _listed_out(value: Any) -> Any:  # noqa: ANN401
    """Return an array as a list, which compares as a whole."""
    if hasattr(value, "tolist"):
        return value.tolist()
    return list(value) if isinstance(value, bytes) else value


def _is_number(value: Any) -> bool:  # noqa: ANN401
    return isinstance(value, (bool, int, float))


def _has_length(value: Any) -> bool:  # noqa: ANN401
    return isinstance(value, (Sequence, Mapping)) or hasattr(value, "dtype")


def _kind(value: Any) -> str:  # noqa: ANN401
    if isinstance(value, Mapping):
        return say("a message")
    if isinstance(value, str):
        return say("a string")
    return say("a number") if _is_number(value) else say("a list")
