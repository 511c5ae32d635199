"""Whether a message fits an expression: `m.data > 0.5`, as `ros2 topic echo --filter` takes it.

Only what is listed here is understood, and nothing is ever run as Python: fields, elements,
comparisons, arithmetic, `and`, `or`, `not`, `in` and a few functions. No method of a message can
be called, and only its fields can be reached. (The evaluators on PyPI read attributes of live
objects, and do not say where in the text something is wrong.)
"""

from __future__ import annotations

import ast
import warnings
from typing import TYPE_CHECKING

from graph.messages.condition_values import CONSTANTS, FUNCTIONS, RefusalError, evaluate, truth
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import Value

MESSAGE = "m"
"""The name of the message in an expression."""
LONGEST = 500
DEEPEST = 40
"""Maximum nesting of brackets and signs."""
QUOTED = 60
"""Characters of the expression that an error repeats."""
_OPERATORS = (
    ast.Add, ast.Sub, ast.Mult, ast.Div, ast.FloorDiv, ast.Mod, ast.UAdd, ast.USub, ast.Not,
    ast.And, ast.Or, ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.In, ast.NotIn,
)  # fmt: skip
_NODES = (
    ast.BoolOp, ast.BinOp, ast.UnaryOp, ast.Compare, ast.Call, ast.Constant, ast.Attribute,
    ast.Subscript, ast.Name, ast.List, ast.Tuple,
)  # fmt: skip


class ConditionError(ValueError):
    """An expression is wrong, or asks for something that a message does not have."""

    def __init__(self, column: int, part: str, message: str) -> None:
        """Report what is wrong with this part of the expression, which begins at this column."""
        self.column = column
        """Counted from 1."""
        self.words = say(
            "column {column}: {message}", column=column,
            message=say("{part}: {message}", part=part, message=message) if part else message,
        )  # fmt: skip
        super().__init__(str(self.words))


class MessageFilter:
    """An expression about a message, which is called `m`."""

    def __init__(self, text: str) -> None:
        """Parse and check the expression. Raises ConditionError."""
        self._text = text
        self._skipped = len(text) - len(text.lstrip())
        if len(text) > LONGEST:
            raise ConditionError(LONGEST + 1, "", say("{n} characters at most", n=LONGEST))
        self._root = self._parsed(text.strip())
        self._check(self._root, 0)

    def holds(self, message: Mapping[str, Value]) -> bool:
        """Return whether it is true of this message. Raises ConditionError."""
        try:
            return truth(self._root, evaluate(self._root, {**CONSTANTS, MESSAGE: message}))
        except RefusalError as refusal:
            raise self._error(refusal.node, refusal.words) from refusal

    def _parsed(self, text: str) -> ast.expr:
        try:
            # Python warns about an odd escape in a string, on the terminal that is the screen.
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                return ast.parse(text, mode="eval").body
        except SyntaxError as error:
            # Python gives no position if the expression ends too early.
            at = min(error.offset or len(text) + 1, len(text) + 1)
            why = say("cannot be parsed from here on")
            if text[at - 1 : at] == "=" or "'=='" in (error.msg or ""):
                why = say("write == to compare")
            raise ConditionError(at + self._skipped, "", why) from error
        except (ValueError, RecursionError, MemoryError) as error:
            why = say("cannot be parsed from here on")
            raise ConditionError(1, "", why) from error

    def _check(self, node: ast.AST, depth: int) -> None:
        """Refuse whatever is not listed above, before any message arrives."""
        if depth > DEEPEST:
            raise self._error(node, say("too many nested brackets"))
        if isinstance(node, (*_OPERATORS, ast.Load)):
            return
        if not isinstance(node, _NODES):
            raise self._error(node, say("this cannot be used here"))
        if isinstance(node, ast.Name):
            self._check_name(node)
        if isinstance(node, ast.Constant) and not isinstance(node.value, (bool, int, float, str)):
            raise self._error(node, say("this cannot be used here"))
        if isinstance(node, ast.Call):
            self._check_call(node)
            children: list[ast.AST] = list(node.args)
        else:
            children = list(ast.iter_child_nodes(node))
        for child in children:
            # An operator has no position of its own.
            if not isinstance(child, (ast.expr, *_OPERATORS, ast.Load)):
                raise self._error(node, say("this cannot be used here"))
            self._check(child, depth + 1)

    def _check_name(self, node: ast.Name) -> None:
        if node.id in FUNCTIONS:
            raise self._error(node, say("it is a function: write {name}(…)", name=node.id))
        if node.id != MESSAGE and node.id not in CONSTANTS:
            why = say("the message is called m: write m.{name}", name=node.id)
            raise self._error(node, why)

    def _check_call(self, node: ast.Call) -> None:
        named = node.func.id if isinstance(node.func, ast.Name) else ""
        if named not in FUNCTIONS:
            names = ", ".join(FUNCTIONS)
            raise self._error(node.func, say("only these can be called: {names}", names=names))
        if node.keywords or len(node.args) != 1:
            raise self._error(node, say("{name} takes one value in its brackets", name=named))

    def _error(self, node: ast.AST, words: str) -> ConditionError:
        text = self._text.strip()
        # Positions are counted in UTF-8 bytes; an operator has none.
        at = len(text.encode()[: getattr(node, "col_offset", 0)].decode(errors="ignore"))
        part = ast.get_source_segment(text, node) if isinstance(node, ast.expr) else ""
        shown = part if part and len(part) <= QUOTED else (part or "")[: QUOTED - 1] + "…"
        return ConditionError(at + 1 + self._skipped, shown if part else "", words)
