"""Arrays of numpy of another shape than the line needs, or with nothing in them."""

from __future__ import annotations

import ast
import re
import sys

from launcher.faults.failure import Failure, shown
from text.sentences import Words, say


def arrays(failure: Failure) -> Words | None:
    """Arrays of numpy of other shapes than the line needs."""
    error = failure.error
    numpy = sys.modules.get("numpy")
    if not isinstance(error, (ValueError, TypeError)) or numpy is None or failure.own is None:
        return None
    values = [
        (shown(node), failure.value(node))
        for node in ast.walk(failure.statement or ast.Pass())
        if isinstance(node, (ast.Name, ast.Attribute))
    ]
    found = [(what, value) for what, value in values if isinstance(value, numpy.ndarray)]
    statement = failure.statement
    if (
        isinstance(error, ValueError)
        and found
        and isinstance(statement, (ast.If, ast.While, ast.Assert))
        and found[0][1].size != 1
    ):
        return say(
            "{what} has many values, and if asks one question: any({what}) or all({what}).", what=_question(statement)
        )
    calls = [each.func.attr for each in failure.all(ast.Call) if isinstance(each.func, ast.Attribute)]
    if "reshape" in calls and isinstance(error, ValueError) and found:
        return say(
            "{what} has {count} values, which is not height × width × channels: look at"
            " msg.step and msg.encoding, or use cv_bridge.",
            what=found[0][0],
            count=found[0][1].size,
        )
    if isinstance(error, ValueError) and len(found) > 1:
        (first, one), (second, two) = found[:2]
        return say(
            "{first} has the shape {one}, {second} the shape {two}: they do not fit each other.",
            first=first,
            one=str(one.shape),
            second=second,
            two=str(two.shape),
        )
    return _told_by_numpy(failure)


def _told_by_numpy(failure: Failure) -> Words | None:
    """Say what numpy tells of arrays that stand in no variable: in its words alone."""
    said = str(failure.error)
    calls = [shown(each.func) for each in failure.all(ast.Call)]
    if not any(each.startswith(("np.", "numpy.")) for each in calls) or not failure.own:
        return None
    if "zero-size array" in said or "of an empty sequence" in said:
        return say("The array is empty: ask len(…) before.")
    if "as a data type" in said:
        return say("The shape of an array stands in brackets of its own: np.zeros((2, 3)).")
    found = re.search(r"array of size (?P<count>\d+) into shape (?P<shape>\([\d, ]+\))", said)
    if found:
        return say(
            "{count} values do not make an array of the shape {shape}.",
            count=int(found["count"]),
            shape=found["shape"],
        )
    if any(each in said for each in ("matmul", "not aligned", "broadcast", "number of dimensions")):
        return say("The shapes of the two arrays do not fit each other: look at a.shape, b.shape.")
    return None


def _question(statement: ast.If | ast.While | ast.Assert) -> str:
    return shown(statement.test)


RULES = (arrays,)
