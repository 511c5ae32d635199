"""Values that are not what the line needs: no number, no such index or key, a zero."""

from __future__ import annotations

import array
import ast
import re
import sys

from launcher.faults.failure import UNKNOWN, Failure, shown
from launcher.faults.remedy import is_none, listed, of_list, unset_parameter
from text.sentences import Words, say
from text.suggestions import nearest


def number(failure: Failure) -> Words | None:
    """A text was to become a number, and is none."""
    if not isinstance(failure.error, (ValueError, OverflowError)) or not failure.is_own:
        return None
    for call in failure.all(ast.Call):
        function = failure.value(call.func)
        if function is map and failure.value(call.args[0]) in (int, float):
            return _among_several(failure, call)
        if function not in (int, float) or not call.args:
            continue
        what, value = shown(call.args[0]), failure.value(call.args[0])
        if isinstance(value, str):
            return _no_number(what, value)
        if isinstance(value, float):
            return say(
                "{what} is {value}, which is not a whole number: ask math.isfinite({what}) first.",
                what=what,
                value=str(value),
            )
        if isinstance(value, (list, tuple, array.array)):
            return of_list(what, shown(call.func))
        if value is not UNKNOWN:
            return None
        return say("{what} is a text that is not a number: look at what it is first.", what=what)
    return None


def _among_several(failure: Failure, call: ast.Call) -> Words | None:
    """Say which of several texts is no number: only the error has it."""
    found = re.search(r": '(?P<text>[^']*)'$", str(failure.error))
    return _no_number(shown(call), found["text"]) if found else None


def _no_number(what: str, value: str) -> Words:
    if not value.strip():
        return say("{what} is an empty text, which is not a number: ask if {what}: first.", what=what)
    try:
        float(value)
    except ValueError:
        pass
    else:
        return say("{value} has a fraction: int(float({what})) cuts it off.", value=value.strip(), what=what)
    if "," in value:
        return say("{value} is not a number: a fraction is written with a point.", value=value.strip())
    return say(
        "The text {value!r} is not a number ({what}): catch ValueError, or look at it first.", value=value, what=what
    )


def mathematics(failure: Failure) -> Words | None:
    """A function of `math` has no value there."""
    if not isinstance(failure.error, (ValueError, OverflowError)) or not failure.is_own:
        return None
    for call in failure.all(ast.Call):
        function = failure.value(call.func)
        if getattr(function, "__module__", None) != "math":
            continue
        name, what = function.__name__, shown(call.args[0]) if call.args else "x"
        if name in ("acos", "asin"):
            return say("{name} takes -1 to 1: limit it before, max(-1.0, min(1.0, {what})).", name=name, what=what)
        if name == "sqrt":
            return say("{name} has no value for {what}: it is negative.", name=name, what=what)
        if name in ("log", "log10", "log2"):
            return say("{name} has no value for {what}: it is negative, or zero.", name=name, what=what)
        return say("{name} has no value for {what}.", name=name, what=what)
    return None


def nothing_to_choose(failure: Failure) -> Words | None:
    """The least or the largest of nothing."""
    if not isinstance(failure.error, ValueError) or not failure.is_own:
        return None
    for call in failure.all(ast.Call):
        if failure.value(call.func) in (min, max) and len(call.args) == 1:
            value, what = failure.value(call.args[0]), shown(call.args[0])
            if value is UNKNOWN or (hasattr(value, "__len__") and not len(value)):
                return say(
                    "{what} is empty, and has neither a least nor a largest value: ask before, or"
                    " {call}(…, default=0.0).",
                    what=what,
                    call=shown(call.func),
                )
    return None


def pause(failure: Failure) -> Words | None:
    """Slept for less than nothing."""
    if not isinstance(failure.error, ValueError) or not failure.is_own:
        return None
    for call in failure.all(ast.Call):
        if shown(call.func) in ("time.sleep", "sleep") and call.args:
            return say("{what} is negative: nobody sleeps for less than 0 seconds.", what=shown(call.args[0]))
    return None


def unpacked(failure: Failure) -> Words | None:
    """More or fewer values than names to hold them."""
    statement = failure.statement
    if not isinstance(failure.error, ValueError) or not failure.is_own:
        return None
    if "unpack" not in str(failure.error):
        return None
    if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], (ast.Tuple, ast.List)):
        names, given = statement.targets[0].elts, failure.value(statement.value)
    elif isinstance(statement, ast.For) and isinstance(statement.target, (ast.Tuple, ast.List)):
        names, given = statement.target.elts, UNKNOWN
        if not isinstance(failure.node, (ast.Tuple, ast.For)):
            return None
        return say(
            "Each round has other than {count} values for the names {names}; enumerate() or zip() give pairs.",
            count=len(names),
            names=", ".join(map(shown, names)),
        )
    else:
        return None
    count = len(given) if isinstance(given, (list, tuple, str)) else 0
    if count == 1:
        return say(
            "{what} has a single value, and {count} names stand left of the equals sign.",
            what=shown(statement.value),
            count=len(names),
        )
    if count:
        return say(
            "{what} has {given} values, and {count} names stand left of the equals sign.",
            what=shown(statement.value),
            given=count,
            count=len(names),
        )
    return say(
        "{what} has other than the {count} values that names stand for.",
        what=shown(statement.value),
        count=len(names),
    )


def index(failure: Failure) -> Words | None:
    """A list has no value of that number."""
    if not isinstance(failure.error, IndexError):
        return None
    if "only integers" in str(failure.error):
        return say("The index of an array is a whole number, or several with commas: a[1, 2].")
    if "Replacement index" in str(failure.error):
        return say("The text has more places for values than format() is given.")
    for each in failure.all(ast.Subscript):
        of, what, number = failure.value(each.value), shown(each.value), failure.value(each.slice)
        if of is sys.argv:
            return say("The program was given no such argument: look at len(sys.argv) before.")
        if of is UNKNOWN or not hasattr(of, "__len__"):
            continue
        if not len(of) and isinstance(each.ctx, ast.Store) and hasattr(of, "append"):
            return say(
                "{what} is empty, and {what}[…] = … changes only what is there: {what}.append(…) adds a value.",
                what=what,
            )
        if not len(of) and isinstance(each.value, (ast.Name, ast.Attribute)):
            return say("{what} is empty: ask if {what}: before. Has anything come yet?", what=what)
        if len(of) == 1:
            return say("{what} has a single value, {what}[0].", what=what)
        if isinstance(number, int) and len(of):
            return say(
                "{what} has {count} values, [0] to [{last}]; there is no [{index}].",
                what=what,
                count=len(of),
                last=len(of) - 1,
                index=number,
            )
        if len(of):
            return say("{what} has {count} values, [0] to [{last}].", what=what, count=len(of), last=len(of) - 1)
    if failure.is_own and any(
        isinstance(each.func, ast.Attribute) and each.func.attr == "pop" for each in failure.all(ast.Call)
    ):
        return say("The list is empty: there is nothing to take out.")
    return say("The list has no value of that number: is it empty, or shorter than expected?")


def key(failure: Failure) -> Words | None:
    """A dictionary has no such key."""
    if not isinstance(failure.error, KeyError) or not failure.error.args:
        return None
    wanted = failure.error.args[0]
    for each in failure.all(ast.Subscript):
        of, what = failure.value(each.value), shown(each.value)
        if not isinstance(of, dict):
            continue
        meant = nearest(wanted, [k for k in of if isinstance(k, str)]) if isinstance(wanted, str) else ""
        if meant:
            return say("{what} has no key {key!r}; did you mean {meant!r}?", what=what, key=wanted, meant=meant)
        if not of or isinstance(each.ctx, ast.Store) or isinstance(getattr(each, "parent", None), ast.Subscript):
            return say(
                "{what} has no key {key!r} yet: {what}[{key!r}] = … puts a value there first.", what=what, key=wanted
            )
        return say(
            "{what} has no key {key!r}; it has {known}. {what}.get({key!r}) gives None instead.",
            what=what,
            key=wanted,
            known=listed([repr(k) for k in of]) or "-",
        )
    return say("There is no key {key!r}.", key=wanted)


def zero(failure: Failure) -> Words | None:
    """Divided by zero."""
    if not isinstance(failure.error, ZeroDivisionError):
        return None
    operations: list[ast.BinOp | ast.AugAssign] = [*failure.all(ast.BinOp)]
    for each in [*operations, *failure.all(ast.AugAssign)]:
        if isinstance(each.op, (ast.Div, ast.FloorDiv, ast.Mod)):
            by = each.right if isinstance(each, ast.BinOp) else each.value
            if isinstance(by, ast.Constant):
                continue
            return say("{what} is 0 here, and nothing is divided by 0: ask before, if {what} != 0.", what=shown(by))
    return say("Divided by zero: ask before whether it is 0.")


def recursion(failure: Failure) -> Words | None:
    """A function calls itself without end."""
    if not isinstance(failure.error, RecursionError) or failure.own is None:
        return None
    return say("{name} calls itself again and again, and never comes to an end.", name=failure.own.function)


def thread(failure: Failure) -> Words | None:
    """A thread was made without the name of its argument, or started twice."""
    if not any(each.file.endswith("threading.py") for each in failure.levels):
        return None
    made = [each for each in failure.all(ast.Call) if shown(each.func).endswith("Thread")]
    call = next(iter(made), None)
    if isinstance(failure.error, AssertionError) and call is not None and call.args:
        return say(
            "A thread takes its function by name: {call}(target={what}).",
            call=shown(call.func),
            what=shown(call.args[0]),
        )
    if isinstance(failure.error, RuntimeError) and "once" in str(failure.error):
        return say("A thread is started once: make a new one for each time.")
    return None


def asserted(failure: Failure) -> Words | None:
    """The learner's own assert."""
    statement = failure.statement
    if not isinstance(failure.error, AssertionError) or not failure.is_own or not isinstance(statement, ast.Assert):
        return None
    return say("What your own assert asks for does not hold: {what}.", what=shown(statement.test))


def missing_value(failure: Failure) -> Words | None:
    """Nothing more is known than that something is None."""
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    for each in ast.walk(failure.statement or ast.Pass()):
        if isinstance(each, ast.Call) and (words := unset_parameter(failure, each)) is not None:
            return words
        if isinstance(each, (ast.Name, ast.Attribute)) and failure.value(each) is None:
            return is_none(failure, each)
    return None


RULES = (
    number, mathematics, nothing_to_choose, pause, unpacked, index, key, zero, recursion, thread,
    asserted,
)  # fmt: skip
LAST = (missing_value,)
