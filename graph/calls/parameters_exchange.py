"""The exchange between Deck and a node about its parameters, request by request.

`graph.calls.exchanges` delivers the requests.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from graph.calls.exchanges import NodeRequest, ServiceSet
from graph.calls.parameters_values import WrongValueError, carried, row, type_of
from text.i18n import N_
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping, Sequence

    from graph.calls.exchanges import Exchange
    from graph.data import ParameterRow, Value

SERVICES = ServiceSet(
    {
        "list_parameters": "rcl_interfaces/srv/ListParameters",
        "describe_parameters": "rcl_interfaces/srv/DescribeParameters",
        "get_parameters": "rcl_interfaces/srv/GetParameters",
        "set_parameters": "rcl_interfaces/srv/SetParameters",
    },
    N_("{node} has no parameter services: it has just appeared, or was started without them"),
)
AT_ONCE = 200
"""Parameters in one request: a node with thousands of them must fit into its messages."""


def read(rows: list[ParameterRow]) -> Exchange:
    """Read all parameters into `rows`, which is sorted by name when this ends."""
    listed = yield NodeRequest("list_parameters", {"depth": 0})
    names = sorted(set(listed["result"]["names"]))
    descriptors = yield from _describe(names)
    values = yield from _of_each("get_parameters", "values", names)
    rows += [row(name, descriptors[name], values.get(name)) for name in names if name in descriptors]


def write(wanted: Mapping[str, Value], refused: dict[str, str]) -> Exchange:
    """Set parameters, keeping their types; each that is not accepted is put into `refused`."""
    descriptors = yield from _describe(list(wanted))
    made: dict[str, Value] = {}
    for name, value in wanted.items():
        word, tree = _made(descriptors.get(name), value)
        if tree is None:
            refused[name] = word
        else:
            made[name] = {"name": name, "value": tree}
    for some in _parts(list(made)):
        answer = yield NodeRequest("set_parameters", {"parameters": [made[name] for name in some]})
        results = answer["results"]
        for name, result in zip(some, results, strict=False):
            if not result["successful"]:
                refused[name] = result["reason"] or say("the node refuses it and gives no reason")
        for name in some[len(results) :]:
            refused[name] = say("the node's answer does not mention it")


def _made(descriptor: Mapping[str, Any] | None, value: Value) -> tuple[str, dict[str, Value] | None]:
    """Return why the value does not fit, or the tree of its ParameterValue."""
    if descriptor is None:
        return say("the node has no such parameter"), None
    if descriptor["read_only"]:
        return say("it is read-only: it can be set only when the node starts"), None
    type_name = type_of(descriptor)
    try:
        return "", carried(type_name, value)
    except WrongValueError as error:
        # A dynamically typed parameter keeps its type if the value fits.
        return _made_anew(value) if descriptor["dynamic_typing"] else (error.words, None)


def _made_anew(value: Value) -> tuple[str, dict[str, Value] | None]:
    try:
        return "", carried("not_set", value)
    except WrongValueError as error:
        return error.words, None


def _describe(names: list[str]) -> Generator[NodeRequest, Mapping[str, Any], dict[str, Any]]:
    return (yield from _of_each("describe_parameters", "descriptors", names))


def _of_each(service: str, field: str, names: list[str]) -> Generator[NodeRequest, Mapping[str, Any], dict[str, Any]]:
    """Ask for something about each parameter; those that the node does not have are left out."""
    found: dict[str, Any] = {}
    parts = list(_parts(names))
    while parts:
        some = parts.pop(0)
        answers = (yield NodeRequest(service, {"names": some}))[field]
        if len(answers) == len(some):
            found.update(zip(some, answers, strict=True))
        elif len(some) > 1:
            # One parameter that does not exist, or has no value, empties the answer for all.
            middle = len(some) // 2
            parts[:0] = [some[:middle], some[middle:]]
    return found


def _parts(names: Sequence[str]) -> list[list[str]]:
    return [list(names[start : start + AT_ONCE]) for start in range(0, len(names), AT_ONCE)]
