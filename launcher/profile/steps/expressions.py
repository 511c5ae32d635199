"""What may stand in `${...}` of a check: the drawn values, numbers, arithmetic, a few functions.

A text that is just one `${...}` becomes the value itself; in a longer text it is written out.
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

from text.i18n import LANGUAGES, decimal
from text.sentences import Words, say
from text.suggestions import did_you_mean

Drawn: TypeAlias = "str | int | float"
PLACE = re.compile(r"\$\{([^{}]*)\}")
LONGEST = 200
DEEPEST = 20
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "abs": abs,
    "atan": math.atan,
    "cos": math.cos,
    "degrees": math.degrees,
    "max": max,
    "min": min,
    "radians": math.radians,
    "round": round,
    "sin": math.sin,
    "sqrt": math.sqrt,
    "tan": math.tan,
}
CONSTANTS = {"pi": math.pi}
_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
_UNARY: dict[type[ast.unaryop], Callable[[Any], Any]] = {ast.UAdd: operator.pos, ast.USub: operator.neg}


class ExpressionError(ValueError):
    """An expression cannot be evaluated; `words` says why."""

    def __init__(self, words: Words) -> None:
        super().__init__(str(words))
        self.words = words


def expressions(text: str) -> list[str]:
    """Return what stands in the `${...}` of a text."""
    return PLACE.findall(text)


def evaluate(expression: str, values: Mapping[str, Drawn]) -> Drawn:
    """Return the value of what stands in `${...}`. Raises ExpressionError."""
    if len(expression) > LONGEST:
        raise ExpressionError(say("{n} characters at most", n=LONGEST))
    try:
        tree = ast.parse(expression.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise ExpressionError(say("{text!r} cannot be parsed", text=expression)) from error
    try:
        found: Drawn = _value(tree, values, 0)
    except (ArithmeticError, TypeError, ValueError) as error:
        if isinstance(error, ExpressionError):
            raise
        why = say("{text!r} cannot be computed: {reason}", text=expression, reason=str(error))
        raise ExpressionError(why) from error
    return found


def filled(value: Any, values: Mapping[str, Drawn], language: str = "en") -> Any:  # noqa: ANN401
    """Return a part of a check with every `${...}` in it replaced. Raises ExpressionError.

    `language`: the one that the text is in, where a number gets its decimal comma.
    """
    if isinstance(value, dict):
        return {key: filled(inner, values, key if key in LANGUAGES else "en") for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(filled(inner, values) for inner in value)
    if not isinstance(value, str):
        return value
    whole = PLACE.fullmatch(value)
    if whole:
        return evaluate(whole.group(1), values)
    return PLACE.sub(lambda found: _read(evaluate(found.group(1), values), language), value)


def _read(value: Drawn, language: str) -> str:
    text = written(value)
    return decimal(text, language) if isinstance(value, float) else text


def written(value: Drawn) -> str:
    """Write a drawn value as text: 0.3 and not 0.30000000000000004."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _value(node: ast.AST, values: Mapping[str, Drawn], depth: int) -> Any:  # noqa: ANN401 - any
    if depth > DEEPEST:
        raise ExpressionError(say("too many nested brackets"))
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return node.value
    if isinstance(node, ast.Name):
        return _named(node.id, values)
    if isinstance(node, ast.BinOp) and type(node.op) in _BINARY:
        left, right = (_value(side, values, depth + 1) for side in (node.left, node.right))
        return _BINARY[type(node.op)](left, right)
    if isinstance(node, ast.UnaryOp) and type(node.op) in _UNARY:
        return _UNARY[type(node.op)](_value(node.operand, values, depth + 1))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        if node.func.id not in FUNCTIONS:
            names = ", ".join(FUNCTIONS)
            raise ExpressionError(say("only these can be called: {names}", names=names))
        return FUNCTIONS[node.func.id](*(_value(each, values, depth + 1) for each in node.args))
    raise ExpressionError(say("only values, numbers, + - * / and functions can be used here"))


def _named(name: str, values: Mapping[str, Drawn]) -> Drawn:
    if name in values:
        return values[name]
    if name in CONSTANTS:
        return CONSTANTS[name]
    hint = did_you_mean(name, list(values)) or (
        say("known: {keys}", keys=", ".join(values)) if values else say("there are no `values:`")
    )
    raise ExpressionError(say("there is no value {name!r}: {hint}", name=name, hint=hint))
