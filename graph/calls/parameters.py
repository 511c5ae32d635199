"""Reads and sets the parameters of any node, any number of nodes at once, without blocking."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from graph.calls.exchanges import NodeRequest, ServiceSet, full_name
from graph.data import ParameterRow, ParametersResult, SetResult
from graph.messages.fields import FieldType
from graph.messages.making import FieldError, one_made, shown
from graph.messages.yaml_text import value_of
from text.i18n import N_
from text.sentences import say
from text.yaml_faults import YamlError
from text.yaml_scalars import meaning

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping, Sequence
    from concurrent.futures import Future

    from graph.calls.exchanges import Exchange, Exchanges
    from graph.data import Value


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
    for some in _batches(list(made)):
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
    try:
        return "", carried(type_of(descriptor), value)
    except FieldError as error:
        if not descriptor["dynamic_typing"]:
            return error.message, None
    # A dynamically typed parameter keeps its type if the value fits.
    try:
        return "", carried(TYPES[0], value)
    except FieldError as error:
        return error.message, None


def _describe(names: list[str]) -> Generator[NodeRequest, Mapping[str, Any], dict[str, Any]]:
    return (yield from _of_each("describe_parameters", "descriptors", names))


def _of_each(service: str, field: str, names: list[str]) -> Generator[NodeRequest, Mapping[str, Any], dict[str, Any]]:
    """Ask for something about each parameter; those that the node does not have are left out."""
    found: dict[str, Any] = {}
    parts = list(_batches(names))
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


def _batches(names: Sequence[str]) -> list[list[str]]:
    return [list(names[start : start + AT_ONCE]) for start in range(0, len(names), AT_ONCE)]


class ParameterCalls:
    """The requests about parameters."""

    def __init__(self, exchanges: Exchanges) -> None:
        """Ask through `exchanges`, which reports every failure in words."""
        self._exchanges = exchanges

    def read(self, node: str, timeout_s: float, future: Future[ParametersResult]) -> None:
        """Read all parameters of a node, with their descriptors; failures are reported in words."""
        node, started_s = full_name(node), time.monotonic()
        rows: list[ParameterRow] = []

        def end(error: str) -> None:
            taken = () if error else tuple(rows)
            future.set_result(ParametersResult(node, taken, error, time.monotonic() - started_s))

        self._exchanges.begin(node, read(rows), SERVICES, timeout_s, end)

    def write(self, node: str, values: Mapping[str, Value], timeout_s: float, future: Future[SetResult]) -> None:
        """Set parameters of a node, each independently; failures are reported in words."""
        node, started_s = full_name(node), time.monotonic()
        refused: dict[str, str] = {}

        def end(error: str) -> None:
            future.set_result(SetResult(node, refused, error, time.monotonic() - started_s))

        if values:
            self._exchanges.begin(node, write(values, refused), SERVICES, timeout_s, end)
        else:
            end("")


TYPES = (
    *("not_set", "bool", "integer", "double", "string", "byte_array", "bool_array", "integer_array"),
    *("double_array", "string_array"),
)
"""By their numbers (source: rcl_interfaces/msg/ParameterType)."""
_FIELDS = {
    "bool": FieldType("boolean"),
    "integer": FieldType("int64"),
    "double": FieldType("double"),
    "string": FieldType("string"),
    "byte": FieldType("octet"),
}


def row(name: str, descriptor: Mapping[str, Any], carried: Mapping[str, Any] | None) -> ParameterRow:
    """Return one parameter from the trees of its ParameterDescriptor and its ParameterValue.

    A parameter that was declared but never given a value has its declared type and no value.
    """
    value = plain(carried) if carried is not None else None
    type_name = TYPES[carried["type"]] if carried is not None and value is not None else ""
    ranges = [*descriptor["floating_point_range"], *descriptor["integer_range"]]
    least, greatest, step = (
        (float(ranges[0]["from_value"]), float(ranges[0]["to_value"]), float(ranges[0]["step"]))
        if ranges
        else (None, None, None)
    )
    return ParameterRow(
        name,
        type_name or type_of(descriptor),
        value,
        descriptor["description"],
        descriptor["additional_constraints"],
        descriptor["read_only"],
        least,
        greatest,
        step or None,
    )


def type_of(descriptor: Mapping[str, Any]) -> str:
    """Return the type that a parameter was declared with; `not_set` if any type will do."""
    number = descriptor["type"]
    return TYPES[number] if number in range(len(TYPES)) else TYPES[0]


def plain(carried: Mapping[str, Any]) -> Value | None:
    """Return the plain value that the tree of a ParameterValue carries; None if it has none."""
    number = carried["type"]
    if number not in range(1, len(TYPES)):
        return None
    value: Value = carried[f"{TYPES[number]}_value"]
    return value.tolist() if hasattr(value, "tolist") else value


def carried(type_name: str, value: Value) -> dict[str, Value]:
    """Return the tree of the ParameterValue of this type for a value that a person gave.

    An integer is accepted for a double, and the text of a value for the value. For `not_set` the
    type is that of the value. Raises FieldError if it does not fit.
    """
    type_name = _type_for(value) if type_name == TYPES[0] else type_name
    single, _, many = type_name.partition("_")
    made: Value = bytes(value) if isinstance(value, (bytes, bytearray)) else []
    if not many:
        made = _one(single, value)
    elif not isinstance(value, (bytes, bytearray)):
        elements: Any = [_one(single, each) for each in _elements(value)]
        made = bytes(elements) if single == "byte" else elements
    return {"type": TYPES.index(type_name), f"{type_name}_value": made}


def _one(type_name: str, value: Value) -> Any:  # noqa: ANN401 - of the type of the parameter
    """Return a single value; text that was typed means what it would mean in YAML."""
    if isinstance(value, str) and type_name != "string":
        meant = meaning(value.strip())
        if isinstance(meant, (int, float)) and isinstance(meant, bool) == (type_name == "bool"):
            value = meant
    return one_made(_FIELDS[type_name], value, "")


def _type_for(value: Value) -> str:
    if isinstance(value, (bytes, bytearray)):
        return "byte_array"
    for kind, name in ((bool, "bool"), (int, "integer"), (float, "double"), (str, "string")):
        if isinstance(value, kind):
            return name
    elements = _elements(value)
    if not elements:
        raise FieldError("", say("an empty list has no type, and the parameter has none either"))
    names = {_type_for(each) for each in elements}
    if names == {"integer", "double"}:
        return "double_array"
    if len(names) > 1 or f"{min(names)}_array" not in TYPES:
        raise FieldError("", say("expected a list of values of one type, got {value}", value=shown(value)))
    return f"{names.pop()}_array"


def _elements(value: Value) -> list[Value]:
    if isinstance(value, str):
        text = value
        try:
            value = value_of(text)
        except YamlError as error:
            if text.lstrip().startswith("["):
                raise FieldError("", error.message) from None
    if hasattr(value, "tolist"):
        value = value.tolist()
    if not isinstance(value, (list, tuple)):
        raise FieldError("", say("expected a list, such as [1, 2], got {value}", value=shown(value)))
    return list(value)
