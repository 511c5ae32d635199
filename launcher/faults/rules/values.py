"""Values that are not what the line needs: of another type, no number, no such index or key, a zero."""

from __future__ import annotations

import array
import ast
import inspect
import re
from typing import Any

from launcher.faults.failure import UNKNOWN, Failure, fields_of, is_message, name_of, shown
from launcher.faults.remedy import is_none, listed, of_list, remedy, unset_parameter
from launcher.faults.rules.fields import no_field
from text.i18n import N_
from text.sentences import Words, say
from text.suggestions import nearest

_SIGNS: dict[type[ast.AST], str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.FloorDiv: "//", ast.Mod: "%",
    ast.Pow: "**", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.In: "in", ast.NotIn: "not in",
    ast.BitAnd: "&", ast.BitOr: "|", ast.MatMult: "@", ast.LShift: "<<", ast.RShift: ">>", ast.BitXor: "^",
}  # fmt: skip
_REFUSED = re.compile(r"'(?P<type>[\w.]+)' object is not (?P<able>callable|subscriptable)")
"""What the interpreter says of a value that it knows and the source does not tell."""
_UNPACKED = re.compile(r"cannot unpack non-iterable (?P<type>\w+) object")
_PLAIN = (int, float, str, bytes, bool, list, tuple, dict, set, array.array)
_LISTS = (list, tuple, array.array)


def operands(failure: Failure) -> Words | None:
    """An operator joins two things of which one is not what it seems."""
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    pairs = _pairs(failure)
    words = (_pair(failure, left, sign, right) for left, sign, right in pairs)
    return next((each for each in words if each is not None), None)


def _pairs(failure: Failure) -> list[tuple[ast.expr, str, ast.expr]]:
    node = failure.node
    if isinstance(node, ast.BinOp):
        return [(node.left, _SIGNS[type(node.op)], node.right)]
    # Of what has a value it is known that the operator goes.
    joined = [each for each in failure.all(ast.BinOp) if failure.type_of(each) is None]
    pairs = [(each.left, _SIGNS[type(each.op)], each.right) for each in joined if not isinstance(node, ast.Compare)]
    for each in failure.all(ast.Compare):
        values = [each.left, *each.comparators]
        found = zip(values, each.ops, values[1:], strict=False)
        pairs += [(left, _SIGNS[type(op)], right) for left, op, right in found if type(op) in _SIGNS]
    return pairs + [(each.target, _SIGNS[type(each.op)], each.value) for each in failure.all(ast.AugAssign)]


def _pair(failure: Failure, left: ast.expr, sign: str, right: ast.expr) -> Words | None:
    kinds = failure.type_of(left), failure.type_of(right)
    words = _times(left, right, *kinds)
    if words is not None or sign in ("in", "not in"):
        return words or remedy(failure, right)
    for node, kind, other in ((left, kinds[0], kinds[1]), (right, kinds[1], kinds[0])):
        is_wrong = not _is_time(other) if _is_time(kind) else kind is not None and kind not in _PLAIN
        words = remedy(failure, node) if is_wrong else None
        if words is not None:
            return words
    return _plain(failure, left, sign, right)


def _plain(failure: Failure, left: ast.expr, sign: str, right: ast.expr) -> Words | None:
    kinds = failure.type_of(left), failure.type_of(right)
    for node, kind, other, number in ((left, *kinds, right), (right, *kinds[::-1], left)):
        if kind is str and other in (int, float):
            return _text(failure, node, number, sign)
        if kind in _LISTS and other in (int, float):
            phrase = N_(
                "{what} is a list, which cannot be calculated with as a whole: [v {sign} … for v in"
                " {what}], or np.array({what})."
            )
            return say(phrase, what=shown(node), sign=sign)
    if kinds[0] in _LISTS and sign != "+":
        phrase = N_(
            "Lists are not calculated with by {sign}: np.array({left}) {sign} np.array({right})"
            " does it value by value."
        )
        return say(phrase, sign=sign, left=shown(left), right=shown(right))
    if None in kinds:
        # Such as of a function without annotations: the interpreter has said it in words only.
        return None
    return say(
        "{left} is of type {first}, {right} of type {second}: {sign} does not go between them.",
        left=shown(left),
        first=name_of(kinds[0]),
        right=shown(right),
        second=name_of(kinds[1]),
        sign=sign,
    )


def _text(failure: Failure, text: ast.expr, number: ast.expr, sign: str) -> Words:
    value = failure.value(text)
    is_joined = isinstance(text, (ast.Constant, ast.JoinedStr)) and sign == "+"
    if isinstance(value, str) and value and not is_joined and not _is_number(value):
        phrase = N_("{text} is the text {value!r}, not a number: it does not go with {number}.")
        return say(phrase, text=shown(text), value=value, number=shown(number))
    if sign != "+":
        return say("{text} is a text, even if it looks like a number: float({text}).", text=shown(text))
    if isinstance(text, ast.Constant):
        phrase = N_('A text and a number cannot be added: str({number}), or in one f-string, f"{text} {{{number}}}".')
        return say(phrase, number=shown(number), text=str(text.value).strip())
    phrase = N_("{text} is a text and {number} a number: float({text}) to calculate, str({number}) to write both.")
    return say(phrase, text=shown(text), number=shown(number))


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _is_time(kind: type | None) -> bool:
    module = kind.__module__ if kind is not None else ""
    return module in ("rclpy.time", "rclpy.duration") or module.startswith("builtin_interfaces.")


def _times(left: ast.expr, right: ast.expr, first: type | None, second: type | None) -> Words | None:
    """Say how the time of a message and that of a clock become one kind."""
    if first is None or second is None or not (_is_time(first) and _is_time(second)):
        return None
    of_messages = [each.__module__.startswith("builtin_interfaces.") for each in (first, second)]
    if all(of_messages):
        phrase = N_(
            "Times of messages are not calculated with: make times of rclpy of both,"
            " Time.from_msg({first}) and Time.from_msg({second})."
        )
        return say(phrase, first=shown(left), second=shown(right))
    if not any(of_messages):
        return None
    return say(
        "{what} is the message {type}, the other one a time of rclpy:"
        " Time.from_msg({what}), from rclpy.time import Time.",
        what=shown(left if of_messages[0] else right),
        type=name_of(first if of_messages[0] else second),
    )


def formatted(failure: Failure) -> Words | None:
    """The values for a text with %, for format() or in an f-string do not fit it."""
    if not isinstance(failure.error, (TypeError, ValueError)) or not failure.is_own:
        return None
    for each in failure.all(ast.BinOp):
        text = failure.value(each.left)
        if not isinstance(each.op, ast.Mod) or not isinstance(text, str):
            continue
        wanted = text.replace("%%", "").count("%")
        values = each.right.elts if isinstance(each.right, ast.Tuple) else [each.right]
        if wanted != len(values):
            phrase = N_(
                "The text has {wanted} places for values (%), and is given {given}. An f-string shows"
                ' where each goes: f"… {{x}}".'
            )
            return say(phrase, wanted=wanted, given=len(values))
        return remedy(failure, values[0]) or say(
            '%d and %f stand for numbers, %s for any value; an f-string asks for neither: f"{x}".'
        )
    if "format" not in str(failure.error):
        return None
    made = [each.args for each in failure.all(ast.Call) if getattr(each.func, "attr", "") == "format"]
    nodes = [each.value for each in failure.all(ast.FormattedValue) if each.format_spec is not None]
    for node in [*nodes, *(each for args in made for each in args)]:
        if failure.type_of(node) is float:
            return say(
                "{what} is of type float, and d in a format is for whole numbers: .0f rounds, or int({what}).",
                what=shown(node),
            )
        return remedy(failure, node) or say(
            "{what} is of type {type}, and the format behind its colon is for numbers:"
            " leave it out, or"
            " convert the value.",
            what=shown(node),
            type=name_of(failure.type_of(node)),
        )
    return None


def not_callable(failure: Failure) -> Words | None:
    """Brackets stand behind something that cannot be called."""
    said = _REFUSED.search(str(failure.error))
    unknown = [each for each in failure.refused_calls() if failure.value(each.func) is UNKNOWN]
    for call in failure.refused_calls() if said and said["able"] == "callable" else ():
        value, what = failure.value(call.func), shown(call.func)
        if value is None:
            return is_none(failure, call.func)
        if inspect.ismodule(value):
            return say("{what} is a module: name what is meant in it, {what}.x.", what=what)
        if said and not callable(value) and (value is not UNKNOWN or call is failure.node or unknown == [call]):
            phrase = N_("{what} is a value of type {type}, not a function: write it without brackets.")
            return say(phrase, what=what, type=said["type"])
    return None


def not_indexable(failure: Failure) -> Words | None:
    """Square brackets stand behind something that has no values by number or key."""
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    said = _REFUSED.search(str(failure.error))
    for each in failure.all(ast.Subscript):
        value, what, index = failure.value(each.value), shown(each.value), failure.value(each.slice)
        if is_message(value):
            return _of_message(what, value, index)
        is_it = each is failure.node or failure.all(ast.Subscript) == [each]
        if inspect.isroutine(value) or (is_it and said and said["type"] in ("method", "function")):
            return say("{what} is a function: it is called with round brackets, {what}(…).", what=what)
        if isinstance(value, _LISTS) and isinstance(index, str):
            return say(
                "{what} is a list: its values have numbers, {what}[0], not names. If a dictionary"
                " was meant, it is one level further in.",
                what=what,
            )
        if (words := _fraction(each.slice)) is not None:
            return words
        if isinstance(value, (str, *_LISTS)) and isinstance(index, float):
            return say("An index is a whole number: {what}[int({index})].", what=what, index=shown(each.slice))
        words = remedy(failure, each.value)
        if words is not None:
            return words
    return None


def _fraction(node: ast.expr) -> Words | None:
    """Say that / gives a fraction where a whole number is needed."""
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Div):
        return None
    whole = ast.BinOp(node.left, ast.FloorDiv(), node.right)
    return say("/ always gives a fraction; a whole number is had by //: {what}.", what=shown(whole))


def _of_message(what: str, message: Any, index: Any) -> Words:
    """Say how the field is had that square brackets were to give."""
    fields = list(fields_of(message))
    if isinstance(index, str) and index not in fields:
        return no_field(type(message), index)
    field = index if isinstance(index, str) else "data" if "data" in fields else fields[0]
    if isinstance(index, int) and "data" not in fields and -len(fields) <= index < len(fields):
        field = fields[index]
    if isinstance(index, int) and field == "data" and isinstance(message.data, _LISTS):
        field = f"data[{index}]"
    phrase = N_("{what} is a message, {type}: its fields are had with a point, {what}.{field}.")
    return say(phrase, what=what, type=name_of(type(message)), field=field)


def builtin(failure: Failure) -> Words | None:
    """`float`, `range` and the like were given something that they do not take."""
    for call in failure.refused_calls():
        function = failure.value(call.func)
        if inspect.isfunction(function) or inspect.ismethod(function):
            continue
        for each in call.args:
            value = failure.value(each)
            if function is bytes and isinstance(value, (list, tuple)) and value and isinstance(value[0], bytes):
                return say('{what} is a list of single bytes: b"".join({what}) puts them together.', what=shown(each))
            if function is range and isinstance(value, float) and len(call.args) < 3:
                return say("range takes whole numbers: range(int({what})).", what=shown(each))
            if (function in (float, int) or getattr(function, "__module__", "") == "math") and isinstance(
                value, _LISTS
            ):
                return of_list(shown(each), shown(call.func))
            words = (_fraction(each) if function is range else None) or remedy(failure, each)
            if words is not None:
                return words
    return None


def not_iterable(failure: Failure) -> Words | None:
    """Something that is no list stands where one is gone through."""
    statement = failure.statement
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    gone = [statement.iter] if isinstance(statement, ast.For) else []
    gone += [each.iter for each in failure.all(ast.comprehension)]
    if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], (ast.Tuple, ast.List)):
        gone.append(statement.value)
    found = _UNPACKED.search(str(failure.error))
    for each in gone:
        value = failure.value(each)
        if isinstance(value, (int, float)) and not isinstance(statement, ast.Assign):
            if isinstance(value, int):
                return say("{what} is a number: for i in range({what}) counts to it.", what=shown(each))
            return say("{what} is one number, and not a list that is gone through.", what=shown(each))
        words = is_none(failure, each) if found and found["type"] == "NoneType" else remedy(failure, each)
        if words is not None:
            return words
        if found and isinstance(statement, ast.Assign):
            phrase = N_("{what} is one value of type {type}, and several names stand left of the equals sign.")
            return say(phrase, what=shown(each), type=found["type"])
    return None


def number(failure: Failure) -> Words | None:
    """A text was to become a number, and is none."""
    if not isinstance(failure.error, (ValueError, OverflowError)) or not failure.is_own:
        return None
    quoted = re.search(r": '(?P<text>[^']*)'$", str(failure.error))
    for call in failure.all(ast.Call):
        function, what = failure.value(call.func), shown(call.args[0]) if call.args else "x"
        value: Any = failure.value(call.args[0]) if call.args else UNKNOWN
        if function is map and value in (int, float) and quoted:
            return _no_number(shown(call), quoted["text"])
        if function in (int, float) and isinstance(value, str):
            return _no_number(what, value)
        if function in (int, float) and isinstance(value, _LISTS):
            return of_list(what, shown(call.func))
        if function in (int, float) and value is UNKNOWN and quoted:
            return _no_number(what, quoted["text"])
        if function in (int, float) and isinstance(value, float):
            phrase = N_("{what} is {value}, which is not a whole number: ask math.isfinite({what}) first.")
            return say(phrase, what=what, value=str(value))
        if function in (min, max) and len(call.args) == 1 and (value is UNKNOWN or not len(value)):
            phrase = N_(
                "{what} is empty, and has neither a least nor a largest value: ask before, or {call}(…, default=0.0)."
            )
            return say(phrase, what=what, call=shown(call.func))
        if getattr(function, "__module__", None) == "math":
            return _mathematics(function.__name__, what)
    return None


def _no_number(what: str, value: str) -> Words:
    if not value.strip():
        return say("{what} is an empty text, which is not a number: ask if {what}: first.", what=what)
    if _is_number(value):
        return say("{value} has a fraction: int(float({what})) cuts it off.", value=value.strip(), what=what)
    return say(
        "The text {value!r} is not a number ({what}): catch ValueError, or look at it first.", value=value, what=what
    )


def _mathematics(name: str, what: str) -> Words:
    if name == "sqrt":
        return say("{name} has no value for {what}: it is negative.", name=name, what=what)
    return say("{name} has no value for {what}.", name=name, what=what)


def unpacked(failure: Failure) -> Words | None:
    """More or fewer values than names to hold them."""
    statement = failure.statement
    if not isinstance(failure.error, ValueError) or not failure.is_own or "unpack" not in str(failure.error):
        return None
    if not isinstance(statement, ast.Assign) or not isinstance(statement.targets[0], (ast.Tuple, ast.List)):
        return None
    count, given = len(statement.targets[0].elts), failure.value(statement.value)
    if isinstance(given, (list, tuple, str)) and len(given) > 1:
        phrase = N_("{what} has {given} values, and {count} names stand left of the equals sign.")
        return say(phrase, what=shown(statement.value), given=len(given), count=count)
    return say(
        "{what} has other than the {count} values that names stand for.", what=shown(statement.value), count=count
    )


def index(failure: Failure) -> Words | None:
    """A list has no value of that number."""
    for each in failure.all(ast.Subscript) if isinstance(failure.error, IndexError) else ():
        of, what, number = failure.value(each.value), shown(each.value), failure.value(each.slice)
        if of is UNKNOWN or not hasattr(of, "__len__"):
            continue
        if not len(of):
            return say("{what} is empty: ask if {what}: before. Has anything come yet?", what=what)
        if len(of) == 1:
            return say("{what} has a single value, {what}[0].", what=what)
        if isinstance(number, int):
            phrase = N_("{what} has {count} values, [0] to [{last}]; there is no [{index}].")
            return say(phrase, what=what, count=len(of), last=len(of) - 1, index=number)
        return say("{what} has {count} values, [0] to [{last}].", what=what, count=len(of), last=len(of) - 1)
    if not isinstance(failure.error, IndexError):
        return None
    return say("The list has no value of that number: is it empty, or shorter than expected?")


def key(failure: Failure) -> Words | None:
    """A dictionary has no such key."""
    if not isinstance(failure.error, KeyError) or not failure.error.args:
        return None
    wanted = failure.error.args[0]
    for each in failure.all(ast.Subscript):
        of, said = failure.value(each.value), {"what": shown(each.value), "key": wanted}
        if not isinstance(of, dict) or not of:
            continue
        meant = nearest(wanted, [k for k in of if isinstance(k, str)]) if isinstance(wanted, str) else ""
        if meant:
            return say("{what} has no key {key!r}; did you mean {meant!r}?", **said, meant=meant)
        phrase = N_("{what} has no key {key!r}; it has {known}. {what}.get({key!r}) gives None instead.")
        return say(phrase, **said, known=listed([repr(k) for k in of]))
    return say("There is no key {key!r}.", key=wanted)


def zero(failure: Failure) -> Words | None:
    """Divided by zero."""
    if not isinstance(failure.error, ZeroDivisionError):
        return None
    found: list[ast.BinOp | ast.AugAssign] = [*failure.all(ast.BinOp), *failure.all(ast.AugAssign)]
    for each in found:
        by = each.right if isinstance(each, ast.BinOp) else each.value
        if isinstance(each.op, (ast.Div, ast.FloorDiv, ast.Mod)) and not isinstance(by, ast.Constant):
            return say("{what} is 0 here, and nothing is divided by 0: ask before, if {what} != 0.", what=shown(by))
    return say("Divided by zero: ask before whether it is 0.")


def missing_value(failure: Failure) -> Words | None:
    """Nothing more is known than that something is None."""
    if not isinstance(failure.error, TypeError) or not failure.is_own or "None" not in str(failure.error):
        return None
    for each in ast.walk(failure.statement or ast.Pass()):
        if isinstance(each, ast.Call) and (words := unset_parameter(failure, each)) is not None:
            return words
        if isinstance(each, (ast.Name, ast.Attribute)) and failure.value(each) is None:
            return is_none(failure, each)
    return None
