"""Values that are not what the line needs: no number, no such index or key, a zero."""

from __future__ import annotations

import array
import ast
import errno
import sys

from launcher.faults.failure import UNKNOWN, Failure, is_from, shown
from launcher.faults.remedy import is_none, listed, of_list
from text.sentences import Words, say
from text.suggestions import nearest


def number(failure: Failure) -> Words | None:
    """A text was to become a number, and is none."""
    if not isinstance(failure.error, ValueError) or not failure.is_own:
        return None
    for call in failure.all(ast.Call):
        function = failure.value(call.func)
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


def _no_number(what: str, value: str) -> Words:
    if not value.strip():
        return say(
            "{what} is an empty text, which is not a number: ask if {what}: first.", what=what
        )
    try:
        float(value)
    except ValueError:
        pass
    else:
        return say(
            "{value} has a fraction: int(float({what})) cuts it off.",
            value=value.strip(),
            what=what,
        )
    if "," in value:
        return say(
            "{value} is not a number: a fraction is written with a point.", value=value.strip()
        )
    return say(
        "The text {value!r} is not a number ({what}): catch ValueError, or look at it first.",
        value=value,
        what=what,
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
            return say(
                "{name} takes -1 to 1: limit it before, max(-1.0, min(1.0, {what})).",
                name=name,
                what=what,
            )
        if name == "sqrt":
            return say("{name} has no value for {what}: it is negative.", name=name, what=what)
        if name in ("log", "log10", "log2"):
            return say(
                "{name} has no value for {what}: it is negative, or zero.", name=name, what=what
            )
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
            return say(
                "{what} is negative: nobody sleeps for less than 0 seconds.",
                what=shown(call.args[0]),
            )
    return None


def unpacked(failure: Failure) -> Words | None:
    """More or fewer values than names to hold them."""
    statement = failure.statement
    if not isinstance(failure.error, ValueError) or not failure.is_own:
        return None
    if isinstance(statement, ast.Assign) and isinstance(
        statement.targets[0], (ast.Tuple, ast.List)
    ):
        names, given = statement.targets[0].elts, failure.value(statement.value)
    elif isinstance(statement, ast.For) and isinstance(statement.target, (ast.Tuple, ast.List)):
        names, given = statement.target.elts, UNKNOWN
        if not isinstance(failure.node, (ast.Tuple, ast.For)):
            return None
        return say(
            "Each round has other than {count} values for the names {names}; enumerate() or zip()"
            " give pairs.",
            count=len(names),
            names=", ".join(map(shown, names)),
        )
    else:
        return None
    count = len(given) if isinstance(given, (list, tuple, str)) else 0
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
    for each in failure.all(ast.Subscript):
        of, what, number = failure.value(each.value), shown(each.value), failure.value(each.slice)
        if of is sys.argv:
            return say("The program was given no such argument: look at len(sys.argv) before.")
        if of is UNKNOWN or not hasattr(of, "__len__"):
            continue
        if not len(of) and isinstance(each.value, (ast.Name, ast.Attribute)):
            return say("{what} is empty: ask if {what}: before. Has anything come yet?", what=what)
        if isinstance(number, int) and len(of):
            return say(
                "{what} has {count} values, [0] to [{last}]; there is no [{index}].",
                what=what,
                count=len(of),
                last=len(of) - 1,
                index=number,
            )
        if len(of):
            return say(
                "{what} has {count} values, [0] to [{last}].",
                what=what,
                count=len(of),
                last=len(of) - 1,
            )
    if failure.is_own and any(
        isinstance(each.func, ast.Attribute) and each.func.attr == "pop"
        for each in failure.all(ast.Call)
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
        meant = (
            nearest(wanted, [k for k in of if isinstance(k, str)])
            if isinstance(wanted, str)
            else ""
        )
        if meant:
            return say(
                "{what} has no key {key!r}; did you mean {meant!r}?",
                what=what,
                key=wanted,
                meant=meant,
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
            return say(
                "{what} is 0 here, and nothing is divided by 0: ask before, if {what} != 0.",
                what=shown(by),
            )
    return say("Divided by zero: ask before whether it is 0.")


def recursion(failure: Failure) -> Words | None:
    """A function calls itself without end."""
    if not isinstance(failure.error, RecursionError) or failure.own is None:
        return None
    return say(
        "{name} calls itself again and again, and never comes to an end.", name=failure.own.function
    )


def files(failure: Failure) -> Words | None:
    """A file is not there, or is not to be had."""
    error = failure.error
    name = getattr(error, "filename", None)
    if isinstance(error, FileNotFoundError) and name:
        return say(
            "There is no file {name}. A name without a slash in front is looked for in the folder"
            " that the program was started in, not beside its file: Path(__file__).parent / …",
            name=str(name),
        )
    if isinstance(error, IsADirectoryError) and name:
        return say("{name} is a folder, not a file.", name=str(name))
    if isinstance(error, PermissionError) and name:
        return say(
            "{name} may not be opened: whose is it? For a device, is the user in its group"
            " (dialout, video, audio)?",
            name=str(name),
        )
    if isinstance(error, ConnectionRefusedError):
        return say("Nobody listens there: is the server running, and is the port right?")
    if isinstance(error, EOFError):
        return say(
            "A node has no keyboard: input() gets nothing. Take a parameter, or a topic that is"
            " published to."
        )
    return None


def device(failure: Failure) -> Words | None:
    """A serial port is not there, or is another's."""
    error = failure.error
    if type(error).__name__ != "SerialException":
        return None
    call = failure.first(ast.Call)
    port = failure.value(call.args[0]) if call is not None and call.args else UNKNOWN
    if not isinstance(port, str):
        return None
    number = getattr(error, "errno", None)
    if number == errno.ENOENT:
        return say("{port} is not there: is the device plugged in?", port=port)
    if number == errno.EACCES:
        return say("{port} may not be opened: is the user in the group dialout?", port=port)
    if number == errno.EBUSY:
        return say("{port} is in use by another program.", port=port)
    return None


def texts(failure: Failure) -> Words | None:
    """Bytes that are no text, text that is no JSON, JSON that does not fit."""
    error = failure.error
    kind = type(error).__name__
    if isinstance(error, UnicodeDecodeError):
        return say('The bytes are not UTF-8: decode("utf-8", errors="replace").')
    if isinstance(error, UnicodeEncodeError):
        return say(
            'The text has letters that {encoding} has not: encode("utf-8").',
            encoding=error.encoding,
        )
    if kind == "JSONDecodeError":
        document = str(getattr(error, "doc", ""))
        if not document.strip():
            return say(
                "The text is empty, which is not JSON: catch the exception, and move nothing."
            )
        if document.lstrip().startswith(("{'", "['")):
            return say(
                "JSON has double quotes, and this has single ones: json.dumps writes it right."
            )
        return say("The text is not JSON: catch the exception, and move nothing.")
    if kind == "ValidationError" and type(error).__module__.startswith("pydantic"):
        return say("The JSON does not fit the model: catch ValidationError, and move nothing.")
    return None


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
            "{what} has many values, and if asks one question: any({what}) or all({what}).",
            what=_question(statement),
        )
    calls = [
        each.func.attr for each in failure.all(ast.Call) if isinstance(each.func, ast.Attribute)
    ]
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
    return None


def _question(statement: ast.If | ast.While | ast.Assert) -> str:
    return shown(statement.test)


def asserted(failure: Failure) -> Words | None:
    """The learner's own assert."""
    statement = failure.statement
    if (
        not isinstance(failure.error, AssertionError)
        or not failure.is_own
        or not isinstance(statement, ast.Assert)
    ):
        return None
    return say("What your own assert asks for does not hold: {what}.", what=shown(statement.test))


def missing_value(failure: Failure) -> Words | None:
    """Nothing more is known than that something is None."""
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    for each in ast.walk(failure.statement or ast.Pass()):
        if isinstance(each, ast.Call) and (words := _unset_parameter(failure, each)) is not None:
            return words
        if isinstance(each, (ast.Name, ast.Attribute)) and failure.value(each) is None:
            return is_none(failure, each)
    return None


def _unset_parameter(failure: Failure, call: ast.Call) -> Words | None:
    """Say that a parameter has no value, if it is asked for here and has none."""
    node = failure.named("self")
    if (
        not isinstance(call.func, ast.Attribute)
        or not call.args
        or not is_from(node, "rclpy", "Node")
    ):
        return None
    name = failure.value(call.args[0])
    if (
        call.func.attr != "get_parameter"
        or not isinstance(name, str)
        or not node.has_parameter(name)
    ):
        return None
    if node.get_parameter(name).value is not None:
        return None
    return say(
        "The parameter {name!r} has no value: declare it with a default,"
        " self.declare_parameter({name!r}, 0.0), or set it in the profile.",
        name=name,
    )


RULES = (
    number, mathematics, nothing_to_choose, pause, unpacked, index, key, zero, recursion, device,
    files, texts, arrays, asserted, missing_value,
)  # fmt: skip
