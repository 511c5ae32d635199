"""Evaluates an expression about a message: every kind of syntax node that `condition` allows."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from graph.messages.making import no_such_field
from text.sentences import say

CONSTANTS: dict[str, Any] = {"true": True, "false": False, "inf": math.inf, "nan": math.nan}
MOST_BYTE = 255
MOST_WHOLE = 2**64
FUNCTIONS = ("abs", "len", "max", "min", "sum")
"""Functions of one argument."""
_ARITHMETIC: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
}
_OF_MANY: dict[str, Callable[[list[Any]], Any]] = {"max": max, "min": min, "sum": sum}
_ORDERS: dict[type[ast.cmpop], Callable[[Any, Any], bool]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}


class RefusalError(Exception):
    """A part of the expression has no value for this message."""

    def __init__(self, node: ast.AST, words: str) -> None:
        """Store the part, and the reason, made by `text.sentences.say`."""
        super().__init__(words)
        self.node = node
        self.words = words


def evaluate(node: ast.expr, names: Mapping[str, Any]) -> Any:  # noqa: ANN401 - any value
    """Return the value of an expression that has been checked. Raises RefusalError."""
    return _KINDS[type(node)](node, names)


def truth(node: ast.expr, value: Any) -> bool:  # noqa: ANN401
    """Return whether a value counts as true: a non-zero number, a non-empty string."""
    if _is_number(value) or isinstance(value, str):
        return bool(value)
    raise RefusalError(node, say("it is {kind}, which is neither true nor false", kind=_kind(value)))


def _name(node: ast.Name, names: Mapping[str, Any]) -> Any:  # noqa: ANN401
    return names[node.id]


def _constant(node: ast.Constant, _names: Mapping[str, Any]) -> Any:  # noqa: ANN401
    return node.value


def _listed(node: ast.List | ast.Tuple, names: Mapping[str, Any]) -> list[Any]:
    return [evaluate(each, names) for each in node.elts]


def _field(node: ast.Attribute, names: Mapping[str, Any]) -> Any:  # noqa: ANN401
    value = evaluate(node.value, names)
    if not isinstance(value, Mapping):
        raise RefusalError(node, say("{kind} has no fields", kind=_kind(value)))
    if node.attr not in value:
        raise RefusalError(node, no_such_field(node.attr, list(value)))
    return _plain(value[node.attr])


def _element(node: ast.Subscript, names: Mapping[str, Any]) -> Any:  # noqa: ANN401
    value, index = evaluate(node.value, names), evaluate(node.slice, names)
    if isinstance(value, Mapping) or not _has_length(value):
        raise RefusalError(node, say("{kind} has no elements", kind=_kind(value)))
    if not isinstance(index, int) or isinstance(index, bool):
        raise RefusalError(node, say("the index of an element must be a whole number"))
    if not -len(value) <= index < len(value):
        raise RefusalError(node, say("there are {n} elements, counted from 0", n=len(value)))
    return _plain(value[index])


def _bool(node: ast.BoolOp, names: Mapping[str, Any]) -> bool:
    parts = (truth(part, evaluate(part, names)) for part in node.values)
    return all(parts) if isinstance(node.op, ast.And) else any(parts)


def _unary(node: ast.UnaryOp, names: Mapping[str, Any]) -> Any:  # noqa: ANN401
    value = evaluate(node.operand, names)
    if isinstance(node.op, ast.Not):
        return not truth(node.operand, value)
    number = _number(node.operand, value)
    return -number if isinstance(node.op, ast.USub) else number


def _binary(node: ast.BinOp, names: Mapping[str, Any]) -> Any:  # noqa: ANN401
    # Numbers only: a string times a number could become arbitrarily long.
    left = _number(node.left, evaluate(node.left, names))
    right = _number(node.right, evaluate(node.right, names))
    try:
        return _ARITHMETIC[type(node.op)](left, right)
    except ZeroDivisionError as error:
        raise RefusalError(node, say("division by zero")) from error
    except ArithmeticError as error:
        raise RefusalError(node, say("the number is too large")) from error


def _compare(node: ast.Compare, names: Mapping[str, Any]) -> bool:
    left = evaluate(node.left, names)
    for sign, each in zip(node.ops, node.comparators, strict=True):
        right = evaluate(each, names)
        if not _compared(node, sign, left, right):
            return False
        left = right
    return True


def _compared(node: ast.Compare, sign: ast.cmpop, left: Any, right: Any) -> bool:  # noqa: ANN401
    if isinstance(sign, (ast.In, ast.NotIn)):
        return _is_in(node, left, right) is isinstance(sign, ast.In)
    if isinstance(sign, (ast.Eq, ast.NotEq)):
        if isinstance(left, Mapping) or isinstance(right, Mapping):
            raise RefusalError(node, say("compare one of the fields of a message"))
        return bool(_listed_out(left) == _listed_out(right)) is isinstance(sign, ast.Eq)
    same = (_is_number(left) and _is_number(right)) or (isinstance(left, str) and isinstance(right, str))
    if not same:
        kinds = {"left": _kind(left), "right": _kind(right)}
        raise RefusalError(node, say("{left} and {right} cannot be compared like this", **kinds))
    return _ORDERS[type(sign)](left, right)


def _is_in(node: ast.Compare, one: Any, many: Any) -> bool:  # noqa: ANN401
    if isinstance(many, str):
        if isinstance(one, str):
            return one in many
    elif not isinstance(many, Mapping) and _has_length(many):
        if isinstance(many, bytes):
            return _is_number(one) and 0 <= one <= MOST_BYTE and one == int(one) and int(one) in many
        if isinstance(many, list):
            return any(_listed_out(_plain(each)) == _listed_out(one) for each in many)
        # An array of numbers, however long. numpy refuses to compare what no array can hold.
        holdable = _is_number(one) and (isinstance(one, float) or abs(one) <= MOST_WHOLE)
        return holdable and bool((many == one).any())
    kinds = {"left": _kind(one), "right": _kind(many)}
    raise RefusalError(node, say("{left} cannot be in {right}", **kinds))


def _called(node: ast.Call, names: Mapping[str, Any]) -> Any:  # noqa: ANN401
    assert isinstance(node.func, ast.Name)
    name, argument = node.func.id, node.args[0]
    value = evaluate(argument, names)
    if name == "abs":
        return abs(_number(argument, value))
    if not _has_length(value):
        raise RefusalError(argument, say("{kind} has no elements", kind=_kind(value)))
    if name == "len":
        return len(value)
    if not isinstance(value, Mapping) and not isinstance(value, str):
        if not len(value):
            raise RefusalError(argument, say("it is empty"))
        if hasattr(value, "dtype") and name != "sum":
            # In numpy, as an array may have a million elements. Its own sum could overflow or warn.
            return _plain(getattr(value, name)())
        numbers = [_plain(each) for each in _listed_out(value)]
        if all(map(_is_number, numbers)):
            return _OF_MANY[name](numbers)
    raise RefusalError(argument, say("{name} takes a list of numbers", name=name))


_KINDS: dict[type[ast.expr], Callable[[Any, Mapping[str, Any]], Any]] = {
    ast.Name: _name,
    ast.Constant: _constant,
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


def _number(node: ast.expr, value: Any) -> Any:  # noqa: ANN401
    if _is_number(value):
        return value
    raise RefusalError(node, say("{kind} is not a number", kind=_kind(value)))


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
