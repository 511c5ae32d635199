"""Calls of OpenCV that it refuses: pictures that are none, arguments that it names itself."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence
from typing import Any

from launcher.faults.failure import UNKNOWN, Failure, is_message, shown
from launcher.faults.remedy import is_none
from text.sentences import Words, say

_WHOLE = re.compile(r"Argument '(?P<name>\w+)' is required to be an integer")
_ITEM = re.compile(r"Can't parse '(?P<name>\w+)'. Sequence item with index (?P<at>\d+) has a wrong")
_SINGLE = re.compile(r"Can't parse '(?P<name>\w+)'. Input argument doesn't provide sequence")
_COUNT = re.compile(r"Can't parse '(?P<name>\w+)'. Expected sequence length (?P<count>\d+), got")
_COLOUR = re.compile(r"Scalar value for argument '(?P<name>\w+)' is not numeric")
_ARRAY = re.compile(r"(?P<name>\w+) is not a numpy array, neither a scalar")
_UMAT = re.compile(r"Expected Ptr<cv::UMat> for argument '(?P<name>\w+)'")
_TEXT = re.compile(r"Can't convert object to 'str' for '(?P<name>\w+)'")
_FILE = re.compile(r"Expected '(?P<name>\w+)' to be a str or path-like")
_NUMBER = re.compile(r"Argument '(?P<name>\w+)' can not be treated as a double")
_MISSING = re.compile(r"missing required argument '(?P<name>\w+)'")
"""What OpenCV says of an argument: only its words tell which one it is."""


def opencv(failure: Failure) -> Words | None:
    """OpenCV refuses."""
    error = failure.error
    if type(error).__module__ != "cv2" and type(error).__name__ != "CvBridgeError":
        return None
    names = [each.func.attr for each in failure.all(ast.Call) if isinstance(each.func, ast.Attribute)]
    if {"imshow", "waitKey", "namedWindow", "destroyAllWindows"} & set(names):
        return say("This OpenCV has no windows: publish the picture, and look at it in Topics.")
    if type(error).__name__ == "CvBridgeError":
        words = _encoding(failure)
        if words is not None:
            return words
        return say(
            'The picture has another encoding than is asked for: look at msg.encoding, or ask for "passthrough".'
        )
    for call in failure.all(ast.Call):
        for each in call.args:
            value = failure.value(each)
            if is_message(value):
                return say(
                    '{what} is a message, not a picture: CvBridge().imgmsg_to_cv2({what}, "bgr8") makes one of it.',
                    what=shown(each),
                )
            if value is None or getattr(value, "size", 1) == 0:
                return say(
                    "{what} is not a picture, or is an empty one: was it read, has one arrived?", what=shown(each)
                )
    return _named(failure) or _shapes(failure)


def _encoding(failure: Failure) -> Words | None:
    """Say that there is no such encoding, or that an array cannot have it."""
    level = next((each for each in failure.levels if each.is_in("cv_bridge", "bridge")), None)
    if level is None:
        return None
    from cv_bridge.encodings import encoding  # Only where it has failed: it loads numpy.

    names = ("desired_encoding", "encoding", "dst_format")
    name = next((level.values[each] for each in names if each in level.values), "")
    picture = level.values.get("cvim")
    if isinstance(name, str) and name != "passthrough" and encoding(name) is None:
        return say("ROS has no encoding {name!r}; the usual ones are bgr8, rgb8, mono8, 16UC1 and 32FC1.", name=name)
    if picture is None or not hasattr(picture, "shape"):
        return None
    return say(
        "The array has the shape {shape} and the type {type}, which is not {name}: mono8 has one"
        " channel, bgr8 has three, both uint8.",
        shape=str(picture.shape),
        type=str(picture.dtype),
        name=name,
    )


def _named(failure: Failure) -> Words | None:
    """Say what is wrong with the argument that OpenCV names."""
    said = str(failure.error)
    call = next((each for each in failure.all(ast.Call) if _names(failure, each)), None)
    if call is None:
        return None
    found = _MISSING.search(said)
    if found and "(pos" in said:
        return say(
            "{what} is called without {missing}; it takes {takes}.",
            what=shown(call.func),
            missing=found["name"],
            takes=", ".join(_required(failure, call)),
        )
    for pattern, rule in _RULES:
        found = pattern.search(said)
        if found:
            node = _argument(failure, call, found["name"])
            if node is not None and failure.value(node) is None:
                return is_none(failure, node)
            return rule(failure, shown(call.func), node, found)
    return None


def _names(failure: Failure, call: ast.Call) -> list[str]:
    """Return the names of a function's arguments, which only its documentation has."""
    text = getattr(failure.called(call), "__doc__", None) or ""
    known = re.match(r"\w+\((?P<names>[^)]*)\)", text)
    return re.findall(r"\w+", known["names"]) if known else []


def _required(failure: Failure, call: ast.Call) -> list[str]:
    text = getattr(failure.called(call), "__doc__", None) or ""
    known = re.match(r"\w+\((?P<names>[^)[]*)", text)
    return re.findall(r"\w+", known["names"]) if known else []


def _argument(failure: Failure, call: ast.Call, name: str) -> ast.expr | None:
    """Return the learner's expression for an argument."""
    for keyword in call.keywords:
        if keyword.arg == name:
            return keyword.value
    names = _names(failure, call)
    at = names.index(name) if name in names else len(call.args)
    return call.args[at] if at < len(call.args) else None


def _whole(failure: Failure, call: str, node: ast.expr | None, found: re.Match[str]) -> Words:
    value, what = failure.value(node), shown(node) or "x"
    if _is_number(value):
        return say(
            "{call}: {name} is a whole number: int({what}) cuts the fraction off.",
            call=call,
            name=found["name"],
            what=what,
        )
    return say("{call}: {name} is a whole number, and {what} is none.", call=call, name=found["name"], what=what)


def _is_number(value: object) -> bool:
    """Whether it is a number, or it is not known what it is."""
    if value is UNKNOWN or isinstance(value, (int, float)):
        return True
    return isinstance(value, str) and value.strip().lstrip("-").isdecimal()


def _items(failure: Failure, call: str, node: ast.expr | None, found: re.Match[str]) -> Words:
    value = failure.value(node)
    item = value[int(found["at"])] if isinstance(value, Sequence) else UNKNOWN
    if isinstance(item, str) or item is None:
        return say(
            "{call}: the values of {name} are numbers, and {what} is none.",
            call=call,
            name=found["name"],
            what=repr(item),
        )
    made = f"tuple(int(v) for v in {shown(node) or 'x'})"
    if isinstance(node, (ast.Tuple, ast.List)):
        parts = ", ".join(_as_whole(failure, each) for each in node.elts)
        made = f"({parts})"
    return say("{call}: the values of {name} are whole numbers: {made}.", call=call, name=found["name"], made=made)


def _as_whole(failure: Failure, node: ast.expr) -> str:
    return shown(node) if isinstance(failure.value(node), int) else f"int({shown(node)})"


def _single(_failure: Failure, call: str, node: ast.expr | None, found: re.Match[str]) -> Words:
    return say(
        "{call}: {name} is several values in brackets, such as ({what}, {what}).",
        call=call,
        name=found["name"],
        what=shown(node) or "x",
    )


def _count(failure: Failure, call: str, node: ast.expr | None, found: re.Match[str]) -> Words:
    value = failure.value(node)
    if isinstance(value, str):
        return say(
            "{call}: {name} is {count} numbers in brackets, and {what} is a text.",
            call=call,
            name=found["name"],
            count=int(found["count"]),
            what=shown(node),
        )
    return say(
        "{call}: {name} has {count} values, and {what} has another number of them.",
        call=call,
        name=found["name"],
        count=int(found["count"]),
        what=shown(node) or "x",
    )


def _colour(_failure: Failure, call: str, _node: ast.expr | None, found: re.Match[str]) -> Words:
    return say(
        "{call}: {name} is numbers, blue, green and red from 0 to 255: (0, 0, 255) is red.",
        call=call,
        name=found["name"],
    )


def _array(failure: Failure, call: str, node: ast.expr | None, found: re.Match[str]) -> Words:
    value, what = failure.value(node), shown(node) or "x"
    if isinstance(value, str) and found["name"] in ("src", "img", "image"):
        return say(
            "{call}: {name} is a picture, and {what} a text: cv2.imread({what}) reads the picture of a file.",
            call=call,
            name=found["name"],
            what=what,
        )
    return say("{call}: {name} is an array of numpy, and {what} is none.", call=call, name=found["name"], what=what)


def _text(_failure: Failure, call: str, node: ast.expr | None, found: re.Match[str]) -> Words:
    return say("{call}: {name} is a text: str({what}).", call=call, name=found["name"], what=shown(node) or "x")


def _file(_failure: Failure, call: str, node: ast.expr | None, found: re.Match[str]) -> Words:
    return say(
        "{call}: {name} is the name of a file, a text in quotes, and {what} is none.",
        call=call,
        name=found["name"],
        what=shown(node) or "x",
    )


def _number(failure: Failure, call: str, node: ast.expr | None, found: re.Match[str]) -> Words:
    value, what = failure.value(node), shown(node) or "x"
    if isinstance(value, str) and re.fullmatch(r"\s*-?\d+(\.\d*)?\s*", value):
        return say("{call}: {name} is a number: float({what}).", call=call, name=found["name"], what=what)
    return say("{call}: {name} is a number, and {what} is none.", call=call, name=found["name"], what=what)


def _shapes(failure: Failure) -> Words:
    """Say which picture a function has refused that says no more."""
    said = str(failure.error)
    if "ksize" in said and "% 2 == 1" in said:
        return say("The size of the filter is odd, in both directions: 3, 5, 7.")
    if "could not find a writer" in said:
        return say("The name of the file tells the format by its ending: .png or .jpg.")
    for call in failure.all(ast.Call):
        if not _names(failure, call):
            continue
        for each in call.args:
            value: Any = failure.value(each)
            if hasattr(value, "dtype") and hasattr(value, "shape"):
                return say(
                    "{call} does not take these values: {what} has the shape {shape} and the type"
                    " {dtype}. Is that what it needs, and are the other values?",
                    call=shown(call.func),
                    what=shown(each),
                    shape=str(value.shape),
                    dtype=str(value.dtype),
                )
    return say(
        "OpenCV does not take these values: look at the picture's shape and dtype before the call,"
        " and at the other arguments."
    )


_RULES = (
    (_ITEM, _items), (_WHOLE, _whole), (_SINGLE, _single), (_COLOUR, _colour), (_TEXT, _text),
    (_FILE, _file), (_NUMBER, _number), (_ARRAY, _array), (_UMAT, _array), (_COUNT, _count),
)  # fmt: skip
RULES = (opencv,)
