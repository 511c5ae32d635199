"""Lines of the learner's own that call, index or go through what is not made for it."""

from __future__ import annotations

import array
import ast
import inspect
import re
from types import ModuleType
from typing import Any

from launcher.faults.failure import ENTERING, UNKNOWN, Failure, fields_of, is_message, name_of, shown
from launcher.faults.remedy import is_none, of_list, remedy
from launcher.faults.rules import signatures
from launcher.faults.rules.field_lists import is_listlike
from launcher.faults.rules.field_names import no_field
from text.sentences import Words, say

_REFUSED = re.compile(r"'(?P<type>[\w.]+)' object is not (?P<able>callable|subscriptable)")
"""What the interpreter says of a value that it knows and the source does not tell."""
_UNORDERED = ("map", "filter", "zip", "generator", "dict_keys", "dict_values", "dict_items")
_MANY = (sum, max, min, list, tuple, set, sorted, enumerate, any, all)
"""Functions that go through what they are given."""
_UNPACKED = re.compile(r"cannot unpack non-iterable (?P<type>\w+) object")


def not_callable(failure: Failure) -> Words | None:
    """Brackets stand behind something that cannot be called."""
    for call in failure.refused_calls():
        value, what = failure.value(call.func), shown(call.func)
        if value is UNKNOWN and _is_the_one(failure, call):
            found = _REFUSED.search(str(failure.error))
            if found and found["able"] == "callable" and found["type"] != "NoneType":
                return say(
                    "{what} is a value of type {type}, not a function: write it without brackets.",
                    what=what,
                    type=found["type"],
                )
        if value is UNKNOWN or callable(value):
            continue
        if value is None:
            return is_none(failure, call.func)
        if isinstance(value, ModuleType):
            last = value.__name__.rpartition(".")[2]
            there = getattr(value, last, None) or getattr(value, last.title(), None)
            if callable(there):
                return say(
                    "{what} is a module; what is meant is in it: {what}.{name}().", what=what, name=there.__name__
                )
            return say("{what} is a module: name what is meant in it, {what}.x.", what=what)
        if isinstance(value, (list, tuple, dict, array.array)) and call.args:
            return say(
                "{what} is of type {type}: one of its values is had with square brackets, {what}[{index}].",
                what=what,
                type=type(value).__name__,
                index=shown(call.args[0]),
            )
        return say(
            "{what} is a value of type {type}, not a function: write it without brackets.",
            what=what,
            type=name_of(type(value)),
        )
    return None


def _is_the_one(failure: Failure, call: ast.Call) -> bool:
    """Whether this is the call that failed: by its place, or as the only one of an unknown."""
    if not isinstance(failure.node, ast.stmt):
        return call is failure.node
    unknown = [each for each in failure.all(ast.Call) if failure.value(each.func) is UNKNOWN]
    return unknown == [call]


def not_indexable(failure: Failure) -> Words | None:
    """Square brackets stand behind something that has no values by number or key."""
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    for each in failure.all(ast.Subscript):
        value, what = failure.value(each.value), shown(each.value)
        index = failure.value(each.slice)
        if is_message(value):
            return _of_message(what, value, index)
        if inspect.isroutine(value):
            return say("{what} is a function: it is called with round brackets, {what}(…).", what=what)
        if isinstance(value, (list, tuple, array.array)) and isinstance(index, str):
            return say(
                "{what} is a list: its values have numbers, {what}[0], not names. If a dictionary"
                " was meant, it is one level further in.",
                what=what,
            )
        if isinstance(value, (list, tuple, array.array, str)) and isinstance(index, float):
            return say("An index is a whole number: {what}[int({index})].", what=what, index=shown(each.slice))
        if isinstance(value, str) and isinstance(index, str):
            return say(
                "{what} is a text. If it is JSON, read it first: json.loads({what})[{index!r}].",
                what=what,
                index=index,
            )
        if isinstance(value, (str, tuple)) and isinstance(each.ctx, ast.Store):
            return say(
                "{what} is of type {type}, which cannot be changed: make a new one, such as list({what}).",
                what=what,
                type=type(value).__name__,
            )
        words = _no_order(failure, each) or _fraction(each.slice) or remedy(failure, each.value)
        if words is not None:
            return words
    return None


def _of_message(what: str, message: Any, index: Any) -> Words:  # noqa: ANN401
    """Say how the field is had that square brackets were to give."""
    fields = list(fields_of(message))
    if isinstance(index, str) and index not in fields:
        return no_field(type(message), index)
    if isinstance(index, str):
        field = index
    elif "data" in fields:
        is_list = isinstance(index, int) and is_listlike(message.data)
        field = f"data[{index}]" if is_list else "data"
    else:
        named = isinstance(index, int) and -len(fields) <= index < len(fields)
        field = fields[index if named else 0]
    return say(
        "{what} is a message, {type}: its fields are had with a point, {what}.{field}.",
        what=what,
        type=name_of(type(message)),
        field=field,
    )


def _no_order(failure: Failure, node: ast.Subscript) -> Words | None:
    """Say that a set, or a function whose brackets are missing, has no values by number."""
    what, found = shown(node.value), _REFUSED.search(str(failure.error))
    if isinstance(failure.value(node.value), (set, frozenset)):
        return say("{what} is a set, which has no order: list({what}) has.", what=what)
    only = isinstance(failure.node, ast.stmt) and len(failure.all(ast.Subscript)) == 1
    if (node is failure.node or only) and found and found["type"] in _UNORDERED:
        return say("{what} has no values by number: list({what}) has.", what=what)
    if (node is failure.node or only) and found and found["type"] in ("method", "function"):
        return say("{what} is a function: it is called with round brackets, {what}(…).", what=what)
    return None


def _fraction(node: ast.expr) -> Words | None:
    """Say that / gives a fraction where a whole number is needed."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div):
        whole = ast.BinOp(node.left, ast.FloorDiv(), node.right)
        return say(
            "/ always gives a fraction; a whole number is had by //: {what}.",
            what=shown(ast.copy_location(whole, node)),
        )
    return None


def builtin(failure: Failure) -> Words | None:
    """`float`, `len`, `range` and the like were given something that they do not take."""
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    for call in failure.refused_calls():
        function = failure.value(call.func)
        if inspect.isfunction(function) or inspect.ismethod(function):
            continue
        for each in call.args:
            value = failure.value(each)
            if function is range and (words := _counted(call, each, value)) is not None:
                return words
            if isinstance(getattr(function, "__self__", None), array.array):
                return say(
                    "{what} is a list of numbers of one type, and {given} is of type {type}.",
                    what=shown(getattr(call.func, "value", None)),
                    given=shown(each),
                    type=name_of(type(value)) if value is not UNKNOWN else "?",
                )
            if function is sum and isinstance(value, (list, tuple)):
                return _summed(shown(each), value)
            words = _of_bytes(call, function, value) or _of_single(call, function, each, value)
            if words is not None:
                return words
            if function in (float, int) and isinstance(value, (list, tuple, array.array)):
                return of_list(shown(each), shown(call.func))
            words = remedy(failure, each)
            if words is not None:
                return words
    return None


def _of_bytes(call: ast.Call, function: Any, value: Any) -> Words | None:  # noqa: ANN401
    is_about = _is_join(call) or function in (bytes, bytearray)
    return _bytes(call, value) if is_about else None


def _of_single(
    call: ast.Call,
    function: Any,  # noqa: ANN401
    node: ast.expr,
    value: Any,  # noqa: ANN401
) -> Words | None:
    """Say that a function takes a list, and was given single numbers."""
    if type(value) not in (int, float) or node is not call.args[0]:
        return None
    if function is len:
        return say("{what} is one number: only a list or a text has a length.", what=shown(call.args[0]))
    if function not in _MANY:
        return None
    return say(
        "{call} takes a list, and {what} is one number: {call}([{arguments}]).",
        call=shown(call.func),
        what=shown(call.args[0]),
        arguments=", ".join(map(shown, call.args)),
    )


def unsorted(failure: Failure) -> Words | None:
    """Texts and numbers were to be brought into an order."""
    if "not supported between instances" not in str(failure.error):
        return None
    for call in failure.refused_calls():
        is_sort = isinstance(call.func, ast.Attribute) and call.func.attr == "sort"
        if not is_sort and failure.value(call.func) not in (sorted, min, max):
            continue
        assert isinstance(call.func, ast.Attribute) or call.args
        value = failure.value(call.func.value if is_sort else call.args[0])  # type: ignore[attr-defined]
        kinds = sorted({name_of(type(each)) for each in value}) if isinstance(value, list) else []
        if len(kinds) > 1:
            return say(
                "Values of the types {types} have no order among each other: make numbers of all, or texts.",
                types=", ".join(kinds),
            )
    return None


def _counted(call: ast.Call, node: ast.expr, value: Any) -> Words | None:  # noqa: ANN401
    """Say that a range counts in whole numbers."""
    if isinstance(value, float) and len(call.args) == 3:
        return say(
            "range takes whole numbers, for its steps as well: [i * {step} for i in range(…)], or"
            " np.arange({arguments}).",
            step=shown(call.args[2]),
            arguments=", ".join(map(shown, call.args)),
        )
    if isinstance(value, float):
        return say("range takes whole numbers: range(int({what})).", what=shown(node))
    return _fraction(node)


def _summed(what: str, values: Any) -> Words | None:  # noqa: ANN401
    if any(isinstance(each, str) for each in values):
        return say("{what} has texts in it, and sum adds numbers: sum(float(v) for v in {what}).", what=what)
    return None


def not_iterable(failure: Failure) -> Words | None:
    """Something that is no list stands where one is gone through."""
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    statement = failure.statement
    gone = [statement.iter] if isinstance(statement, ast.For) else []
    gone += [each.iter for each in failure.all(ast.comprehension)]
    if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], (ast.Tuple, ast.List)):
        gone.append(statement.value)
    for each in gone:
        value = failure.value(each)
        if isinstance(statement, ast.Assign) and isinstance(value, (int, float)):
            return _no_pairs(failure, gone)
        if isinstance(value, int):
            return say("{what} is a number: for i in range({what}) counts to it.", what=shown(each))
        if isinstance(value, float):
            return say("{what} is one number, and not a list that is gone through.", what=shown(each))
        words = remedy(failure, each)
        if words is not None:
            return words
    return _no_pairs(failure, gone)


def _no_pairs(failure: Failure, gone: list[ast.expr]) -> Words | None:
    """Say that one value stands where several names are to get one each."""
    found, statement = _UNPACKED.search(str(failure.error)), failure.statement
    if not found or not gone:
        return None
    if isinstance(statement, ast.Assign):
        if found["type"] == "NoneType":
            return is_none(failure, gone[0])
        return say(
            "{what} is one value of type {type}, and several names stand left of the equals sign.",
            what=shown(gone[0]),
            type=found["type"],
        )
    return say(
        "Each round gives one value of type {type}, and there are several names for it: for i, x in"
        " enumerate({what}) numbers them.",
        type=found["type"],
        what=shown(gone[0]),
    )


def context(failure: Failure) -> Words | None:
    """`with` was used with something that is not made for it."""
    statement = failure.statement
    if not isinstance(failure.error, (TypeError, AttributeError)) or not isinstance(statement, ast.With):
        return None
    if not failure.is_own or not _is_about_with(failure):
        return None
    for item in statement.items:
        if shown(item.context_expr).startswith(("rclpy.init(", "init(")):
            return say(
                "`with rclpy.init()` needs a newer ROS than Jazzy. Here: rclpy.init(args=args) on a"
                " line of its own, and rclpy.try_shutdown() at the end."
            )
        value = failure.value(item.context_expr)
        if value is None:
            return is_none(failure, item.context_expr)
        if isinstance(value, type) or inspect.isroutine(value):
            return remedy(failure, item.context_expr)
        return say(
            "{what} cannot stand behind with: only files, locks and the like can.", what=shown(item.context_expr)
        )
    return None


def _is_about_with(failure: Failure) -> bool:
    name = getattr(failure.error, "name", None) or str(failure.error)
    return isinstance(failure.error, TypeError) or name in ENTERING


def awaited(failure: Failure) -> Words | None:
    """Something was awaited that is not a future."""
    found = failure.first(ast.Await)
    if not isinstance(failure.error, TypeError) or found is None or not failure.is_own:
        return None
    return say(
        "{what} cannot be awaited: await goes with a future, such as await self.client.call_async(request).",
        what=shown(found.value),
    )


def raised(failure: Failure) -> Words | None:
    """Something was raised that is no exception."""
    statement = failure.statement
    if not isinstance(failure.error, TypeError) or not isinstance(statement, ast.Raise):
        return None
    value = failure.value(statement.exc)
    if not failure.is_own or value is UNKNOWN or isinstance(value, BaseException):
        return None
    return say("raise goes with an exception: raise ValueError({what}).", what=shown(statement.exc))


def _is_join(call: ast.Call) -> bool:
    return isinstance(call.func, ast.Attribute) and call.func.attr == "join"


def _bytes(call: ast.Call, value: Any) -> Words | None:  # noqa: ANN401
    if isinstance(value, (list, tuple)) and value and isinstance(value[0], bytes):
        what = shown(call.args[0])
        return say('{what} is a list of single bytes: b"".join({what}) puts them together.', what=what)
    if isinstance(value, (list, tuple)) and _is_join(call):
        return say(
            "join puts texts together, and {what} has other values: [str(v) for v in {what}].",
            what=shown(call.args[0]),
        )
    return None


RULES = (context, raised, awaited, not_callable, not_indexable, signatures.arguments, unsorted, builtin, not_iterable)
