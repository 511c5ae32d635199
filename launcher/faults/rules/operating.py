"""Operators between things that do not go together: a message and a number, a text and a number."""

from __future__ import annotations

import array
import ast
from typing import Any

from launcher.faults.failure import UNKNOWN, Failure, is_from, is_message_class, name_of, shown
from launcher.faults.remedy import listed, remedy
from text.sentences import Words, say

_BYTES = ("a bytes-like object is required, not 'str'", "please encode to bytes")
"""What Python and pyserial say of a text that is written where bytes go."""
SIGNS: dict[type[ast.AST], str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.FloorDiv: "//", ast.Mod: "%",
    ast.Pow: "**", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.In: "in",
    ast.NotIn: "not in", ast.BitAnd: "&", ast.BitOr: "|", ast.USub: "-", ast.MatMult: "@",
    ast.LShift: "<<", ast.RShift: ">>", ast.BitXor: "^",
}  # fmt: skip


def clocks(failure: Failure) -> Words | None:
    """Two times of different clocks were compared."""
    inner = failure.inner
    if inner is None or not isinstance(failure.error, TypeError) or not inner.is_in("rclpy", "time"):
        return None
    if not is_from(inner.values.get("other"), "rclpy", "Time"):
        return None
    return say(
        "The two times are of different clocks: Time() alone is the system's, the node's is that of"
        " ROS. Make both by self.get_clock().now() or Time.from_msg(stamp)."
    )


def percent(failure: Failure) -> Words | None:
    """The values for a text with % do not fit it."""
    found = failure.first(ast.BinOp)
    if not isinstance(failure.error, (TypeError, ValueError)) or not failure.is_own or found is None:
        return None
    if not isinstance(found.op, ast.Mod) or not isinstance(failure.value(found.left), str):
        return None
    text = failure.value(found.left)
    wanted = text.replace("%%", "").count("%")
    given = len(found.right.elts) if isinstance(found.right, ast.Tuple) else 1
    if wanted != given:
        return say(
            "The text has {wanted} places for values (%), and is given {given}. An f-string shows"
            ' where each goes: f"… {{x}}".',
            wanted=wanted,
            given=given,
        )
    first = found.right.elts[0] if isinstance(found.right, ast.Tuple) else found.right
    return remedy(failure, first) or say(
        '%d and %f stand for numbers, %s for any value; an f-string asks for neither: f"{x}".'
    )


def formatted(failure: Failure) -> Words | None:
    """A value in an f-string has no such format."""
    found = failure.first(ast.FormattedValue) or failure.first(ast.JoinedStr)
    if not isinstance(failure.error, (TypeError, ValueError)) or not failure.is_own or found is None:
        return None
    for each in failure.all(ast.FormattedValue):
        if each.format_spec is None:
            continue
        if failure.type_of(each.value) is float and shown(each.format_spec).endswith("d'"):
            return say(
                "{what} is of type float, and d in a format is for whole numbers: .0f rounds, or int({what}).",
                what=shown(each.value),
            )
        return remedy(failure, each.value) or say(
            "{what} is of type {type}, and the format behind its colon is for numbers:"
            " leave it out, or"
            " convert the value.",
            what=shown(each.value),
            type=name_of(failure.type_of(each.value)),
        )
    return None


def operands(failure: Failure) -> Words | None:
    """An operator joins two things of which one is not what it seems."""
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    for left, sign, right in _pairs(failure):
        words = _pair(failure, left, sign, right)
        if words is not None:
            return words
    for each in failure.all(ast.UnaryOp):
        words = remedy(failure, each.operand)
        if words is not None:
            return words
    return None


def written(failure: Failure) -> Words | None:
    """A text was written, or split by, where there are bytes."""
    if failure.own is None or not any(each in str(failure.error) for each in _BYTES):
        return None
    for call in failure.all(ast.Call):
        for each in call.args:
            if failure.type_of(each) is str or isinstance(each, ast.JoinedStr):
                of = shown(getattr(call.func, "value", None))
                if getattr(call.func, "attr", "") in ("split", "strip", "startswith", "replace"):
                    return say("{what} are bytes: {what}.decode() makes a text of them first.", what=of)
                return say("Bytes go there, and {what} is a text: {what}.encode().", what=shown(each))
    return say("Text and bytes do not go together: text.encode() makes bytes, data.decode() text.")


def _pairs(failure: Failure) -> list[tuple[ast.expr, str, ast.expr]]:
    node = failure.node
    if isinstance(node, ast.BinOp):
        return [(node.left, SIGNS[type(node.op)], node.right)]
    if isinstance(node, ast.UnaryOp):
        return []
    pairs: list[tuple[ast.expr, str, ast.expr]] = []
    pairs += (
        []
        if isinstance(node, ast.Compare)
        else [
            (each.left, SIGNS[type(each.op)], each.right)
            for each in failure.all(ast.BinOp)
            # Of what has a value it is known that the operator goes.
            if failure.type_of(each) is None
        ]
    )
    for compare in failure.all(ast.Compare):
        values = [compare.left, *compare.comparators]
        pairs += [
            (left, SIGNS[type(op)], right)
            for left, op, right in zip(values, compare.ops, values[1:], strict=False)
            if type(op) in SIGNS
        ]
    pairs += [(each.target, SIGNS[type(each.op)], each.value) for each in failure.all(ast.AugAssign)]
    return pairs


def _pair(failure: Failure, left: ast.expr, sign: str, right: ast.expr) -> Words | None:
    kinds = failure.type_of(left), failure.type_of(right)
    times = _times(left, right, *kinds)
    if times is not None:
        return times
    if sign in ("in", "not in"):
        return remedy(failure, right)
    for node, other, kind in ((left, kinds[1], kinds[0]), (right, kinds[0], kinds[1])):
        if kind is not None and not _is_plain(kind) and not _is_time(kind):
            words = remedy(failure, node)
            if words is not None:
                return words
        if kind is not None and _is_time(kind) and (other is None or _is_plain(other)):
            return remedy(failure, node)
    return _plain(failure, left, sign, right)


def _plain(failure: Failure, left: ast.expr, sign: str, right: ast.expr) -> Words | None:
    kinds = failure.type_of(left), failure.type_of(right)
    if None in kinds:
        # Such as of a function without annotations: the interpreter has said it in words only.
        return None
    for node, other in ((left, kinds[1]), (right, kinds[0])):
        kind = failure.type_of(node)
        if kind is str and other in (int, float) and _is_word(failure.value(node), node, sign):
            return say(
                "{text} is the text {value!r}, not a number: it does not go with {number}.",
                text=shown(node),
                value=failure.value(node),
                number=shown(left if node is right else right),
            )
        if kind is str and other in (int, float):
            return _text(node, left if node is right else right, sign)
        if {kind, other} == {str, bytes}:
            return say("Text and bytes do not go together: text.encode() makes bytes, data.decode() text.")
        if kind in (list, tuple, array.array) and other in (int, float):
            return say(
                "{what} is a list, which cannot be calculated with as a whole: [v {sign} … for v in"
                " {what}], or np.array({what}).",
                what=shown(node),
                sign=sign,
            )
    if set(kinds) == {list, tuple} and sign == "+":
        return say(
            "A list and a tuple are not added: list({left}) + list({right}).", left=shown(left), right=shown(right)
        )
    if kinds[0] in (list, tuple, array.array):
        return say(
            "Lists are not calculated with by {sign}: np.array({left}) {sign} np.array({right})"
            " does it value by value.",
            sign=sign,
            left=shown(left),
            right=shown(right),
        )
    return say(
        "{left} is of type {first}, {right} of type {second}: {sign} does not go between them.",
        left=shown(left),
        first=name_of(kinds[0]),
        right=shown(right),
        second=name_of(kinds[1]),
        sign=sign,
    )


def _is_word(value: object, node: ast.expr, sign: str) -> bool:
    """Whether it is a text that can become no number, and that is not to be joined to one."""
    if not isinstance(value, str) or not value:
        return False
    if isinstance(node, (ast.Constant, ast.JoinedStr)) and sign == "+":
        return False
    try:
        float(value)
    except ValueError:
        return True
    return False


def _text(text: ast.expr, number: ast.expr, sign: str) -> Words:
    if sign != "+":
        return say("{text} is a text, even if it looks like a number: float({text}).", text=shown(text))
    if isinstance(text, ast.Constant):
        return say(
            'A text and a number cannot be added: str({number}), or in one f-string, f"{text} {{{number}}}".',
            number=shown(number),
            text=str(text.value).strip(),
        )
    return say(
        "{text} is a text and {number} a number: float({text}) to calculate, str({number}) to write both.",
        text=shown(text),
        number=shown(number),
    )


def _times(left: ast.expr, right: ast.expr, first: type | None, second: type | None) -> Words | None:
    """Say how the time of a message and that of a clock become one kind."""
    if first is second and first is not None and first.__module__.startswith("builtin_interfaces."):
        return say(
            "Times of messages are not calculated with: make times of rclpy of both,"
            " Time.from_msg({first}) and Time.from_msg({second}).",
            first=shown(left),
            second=shown(right),
        )
    for kind, other, node in ((first, second, right), (second, first, left)):
        if kind is None or other is None:
            continue
        if kind.__module__.startswith("rclpy.") and is_message_class(other) and _is_time(other):
            return say(
                "{what} is the message {type}, the other one a time of rclpy:"
                " Time.from_msg({what}), from rclpy.time import Time.",
                what=shown(node),
                type=name_of(other),
            )
    return None


def _is_plain(kind: type) -> bool:
    return kind in (int, float, str, bytes, bool, list, tuple, dict, set, array.array)


def _is_time(kind: type) -> bool:
    return kind.__module__ in ("rclpy.time", "rclpy.duration") or kind.__module__.startswith("builtin_interfaces.")


def serialized(failure: Failure) -> Words | None:
    """`json` was given something that is no JSON, or no text."""
    inner = failure.inner
    if inner is None or "/json/" not in inner.file:
        return None
    if isinstance(failure.error, AttributeError) and inner.function == "load":
        return say(
            "json.load reads from a file that is open: with open(…) as file: json.load(file). Of a"
            " text it is json.loads."
        )
    if not isinstance(failure.error, TypeError):
        return None
    if inner.function == "default" and "o" in inner.values:
        return _dumped(inner.values["o"])
    if inner.function == "loads":
        call = failure.first(ast.Call)
        node = call.args[0] if call is not None and call.args else None
        return remedy(failure, node, inner.values.get("s", UNKNOWN)) or say(
            "json.loads reads a text; {what} is of type {type} already.",
            what=shown(node),
            type=type(inner.values.get("s")).__name__,
        )
    return None


def _dumped(value: Any) -> Words:  # noqa: ANN401
    if is_message_class(type(value)):
        fields = list(type(value).get_fields_and_field_types())
        return say(
            "A message, {type}, is not JSON: put its fields into a dictionary: {fields}.",
            type=name_of(type(value)),
            fields=listed(fields),
        )
    if isinstance(value, bytes):
        return say("Bytes are no JSON: data.decode() makes a text of them.")
    if type(value).__module__ == "numpy":
        return say("Values of numpy are no JSON: array.tolist(), float(x) or int(x).")
    return say("{type} is not JSON: only texts, numbers, lists and dictionaries are.", type=type(value).__name__)


RULES = (clocks, serialized, written, percent, formatted, operands)
