"""`when:` expressions: which nodes run on mock and which on real hardware.

A tiny subset of Python expressions, parsed by `ast` and never executed: `hardware == "mock"`,
`hardware in ["real"]`, `and`, `or`, `not`, parentheses.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping

from text.sentences import say
from text.suggestions import did_you_mean

HARDWARE = ("mock", "real")
NAMES: Mapping[str, tuple[str, ...]] = {"hardware": HARDWARE}
"""The names that an expression may use, and their possible values."""
MAX_LENGTH = 200
EXAMPLE = 'hardware == "mock"'


class WhenError(ValueError):
    """An invalid expression."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint or say("write for example: {example}", example=EXAMPLE)


def holds(expression: str, facts: Mapping[str, str]) -> bool:
    """Return whether an expression is true for `facts`, such as {"hardware": "mock"}.

    Raises:
        WhenError: if it is not a valid expression.
    """
    if len(expression) > MAX_LENGTH:
        raise WhenError(say("is longer than {limit} characters", limit=MAX_LENGTH))
    try:
        tree = ast.parse(expression.strip(), mode="eval")
    except (SyntaxError, ValueError, MemoryError, RecursionError) as error:
        raise WhenError(say("{text!r} is not a condition", text=expression)) from error
    return _truth(tree.body, facts)


def _truth(node: ast.expr, facts: Mapping[str, str]) -> bool:
    if isinstance(node, ast.BoolOp):
        values = [_truth(value, facts) for value in node.values]
        return all(values) if isinstance(node.op, ast.And) else any(values)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        return not _truth(node.operand, facts)
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        return _comparison(node, facts)
    raise WhenError(say("{text!r} is neither true nor false", text=ast.unparse(node)))


def _comparison(node: ast.Compare, facts: Mapping[str, str]) -> bool:
    operator, left, right = node.ops[0], node.left, node.comparators[0]
    if isinstance(operator, (ast.In, ast.NotIn)):
        name = _name(left)
        among = [_word(item, name) for item in _items(right)]
        return (facts[name] in among) is isinstance(operator, ast.In)
    if isinstance(operator, (ast.Eq, ast.NotEq)):
        if isinstance(left, ast.Constant):
            left, right = right, left
        name = _name(left)
        return (facts[name] == _word(right, name)) is isinstance(operator, ast.Eq)
    raise WhenError(say("only ==, !=, in and not in compare here"))


def _items(node: ast.expr) -> list[ast.expr]:
    if isinstance(node, (ast.List, ast.Tuple, ast.Set)):
        return node.elts
    raise WhenError(say("{text!r} is not a list", text=ast.unparse(node)), say('write: hardware in ["real"]'))


def _name(node: ast.expr) -> str:
    if isinstance(node, ast.Name):
        if node.id in NAMES:
            return node.id
        raise WhenError(say("{name!r} is not known", name=node.id), did_you_mean(node.id, NAMES))
    raise WhenError(say("{text!r} is not a name that a condition can use", text=ast.unparse(node)))


def _word(node: ast.expr, name: str) -> str:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        if node.value in NAMES[name]:
            return node.value
        known = ", ".join(NAMES[name])
        raise WhenError(
            say("{name} is never {word!r}, only one of {known}", name=name, word=node.value, known=known),
            did_you_mean(node.value, NAMES[name]),
        )
    raise WhenError(say("{text!r} is not a quoted word", text=ast.unparse(node)), say("put it in quotes"))
