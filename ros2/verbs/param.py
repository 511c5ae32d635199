"""`ros2 param`: the parameters of nodes, by the services that each node has for them."""

from __future__ import annotations

import re
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from graph.messages.fields import to_tree
from graph.messages.making import to_message
from graph.messages.yaml_text import value_of
from ros2 import naming, options
from ros2.joining import NoAnswerError, joined
from ros2.verb import arg, flag, verb
from text.i18n import localized
from text.plain import plain
from text.yaml_faults import YamlError

if TYPE_CHECKING:
    import argparse

    from rcl_interfaces.msg import ParameterValue

    from graph.calls.exchanges import Exchange
    from graph.data import ParameterRow
    from ros2.joining import Guest

NOT_FOUND = "Node not found"
KINDS = (
    ("not set", "", ""),
    ("boolean", "bool_value", "Boolean value is:"),
    ("integer", "integer_value", "Integer value is:"),
    ("double", "double_value", "Double value is:"),
    ("string", "string_value", "String value is:"),
    ("byte array", "byte_array_value", "Byte values are:"),
    ("boolean array", "bool_array_value", "Boolean values are:"),
    ("integer array", "integer_array_value", "Integer values are:"),
    ("double array", "double_array_value", "Double values are:"),
    ("string array", "string_array_value", "String values are:"),
)
"""By the numbers of rcl_interfaces/msg/ParameterType: name, field of ParameterValue, and how `get` begins."""
EMPTY_LIST = 6
"""It has no type of its own; ROS's own tool sends this one."""
COMMON = (options.of_graph, options.answers)
NODE = (*COMMON, arg("node_name", help="Name of the ROS node"), options.hidden("nodes"))
PARAMETER = arg("parameter_name", help="Name of the parameter")


def find_node(me: Guest, args: argparse.Namespace) -> str:
    """Return the full name of a node once it is there, empty if it is not."""
    full = naming.absolute(args.node_name)
    hidden = args.hidden or full.rpartition("/")[2].startswith("_")
    return full if me.await_until(lambda: full in naming.nodes(me.node, hidden=hidden)) else ""


def call(me: Guest, node_name: str, service: str, **fields: object) -> Any:  # noqa: ANN401
    """Call one of a node's parameter services, named as its type: `GetParameters`."""
    from rcl_interfaces import srv

    kind = getattr(srv, service)
    name = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in service)
    return me.call(f"{node_name}/{name[1:]}", kind, node_name, **fields)


def carry_out(me: Guest, node_name: str, exchange: Exchange) -> None:
    """Put an exchange's requests to a node's parameter services, and hand it the answers."""
    from rcl_interfaces import srv

    with suppress(StopIteration):
        asked = next(exchange)
        while True:
            kind = getattr(srv, "".join(map(str.title, asked.service.split("_"))))
            request = to_message(kind.Request, asked.value)
            fields = {name: getattr(request, name) for name in asked.value}
            answer = me.call(f"{node_name}/{asked.service}", kind, node_name, **fields)
            asked = exchange.send(to_tree(answer))


def written_value(name: str, text: str) -> ParameterValue:
    """Return the value that a word means, as YAML or else as it stands; RuntimeError if no parameter can have it."""
    from rcl_interfaces.msg import ParameterValue

    from graph.calls.parameters_values import WrongValueError, carried

    try:
        given = value_of(text)
    except YamlError:
        given = text
    if isinstance(given, list) and not given:
        return ParameterValue(type=EMPTY_LIST)
    try:
        return to_message(
            ParameterValue, carried("not_set", text if given is None or isinstance(given, dict) else given)
        )
    except WrongValueError as error:
        raise RuntimeError(f"{name}: {localized(error.words)}") from error


@verb("param set", "Set parameter", *NODE, PARAMETER, arg("value", help="Value of the parameter"))
def set_one(args: argparse.Namespace) -> str | None:
    """Set it; that the node refuses it goes to standard error, with the exit code 0."""
    from rcl_interfaces.msg import Parameter

    wanted = Parameter(name=args.parameter_name, value=written_value(args.parameter_name, args.value))
    with joined(args) as me:
        node = find_node(me, args)
        if not node:
            return NOT_FOUND
        (result,) = call(me, node, "SetParameters", parameters=[wanted]).results
    reason = f": {result.reason}" if result.reason else ""
    if result.successful:
        print(f"Set parameter successful{reason}")
    else:
        print(f"Setting parameter failed{reason}", file=sys.stderr)
    return None


@verb("param get", "Get parameter", *NODE, PARAMETER, flag("--hide-type", help="Hide the type information"))
def get(args: argparse.Namespace) -> str | None:
    with joined(args) as me:
        node = find_node(me, args)
        if not node:
            return NOT_FOUND
        response = call(me, node, "GetParameters", names=[args.parameter_name])
    if not response.values:
        return "Parameter not set"
    (value,) = response.values
    if value.type >= len(KINDS):
        return f"Unknown parameter type '{value.type}'"
    _kind, field, label = KINDS[value.type]
    # As the message has it: an array prints as array('d', ...).
    held = getattr(value, field) if field else None
    if args.hide_type:
        print(held)
    elif held is None:
        print("Parameter not set.")
    else:
        print(label, held)
    return None


@verb(
    "param describe", "Show descriptive information about declared parameters", *NODE,
    arg("parameter_names", nargs="+", help="Names of the parameters"),
)  # fmt: skip
def describe(args: argparse.Namespace) -> int | str | None:
    """Print what the node has declared."""
    with joined(args) as me:
        node = find_node(me, args)
        if not node:
            return NOT_FOUND
        response = call(me, node, "DescribeParameters", names=args.parameter_names)
    for each in response.descriptors:
        print("Parameter name:", plain(each.name))
        print("  Type:", KINDS[each.type][0])
        if each.description:
            print("  Description:", each.description)
        print("  Constraints:")
        if each.read_only:
            print("    Read only: true")
        for limits in [*each.floating_point_range, *each.integer_range][:1]:
            print("    Min value:", limits.from_value)
            print("    Max value:", limits.to_value)
            if limits.step:
                print("    Step:", limits.step)
        if each.additional_constraints:
            print("    Additional constraints:", each.additional_constraints)
    return None


@verb("param dump", "Show all of the parameters of a node in a YAML file format", *NODE)
def dump(args: argparse.Namespace) -> int | str | None:
    """Print the file, which `--ros-args --params-file` takes."""
    import yaml

    from graph.calls.parameters_exchange import read

    rows: list[ParameterRow] = []
    with joined(args) as me:
        node = find_node(me, args)
        if not node:
            return NOT_FOUND
        carry_out(me, node, read(rows))
    tree: dict[str, Any] = {}
    for row in rows:
        # What was declared without a value has none that a file could hold.
        if row.value is not None:
            _place(tree, row)
    print(yaml.dump({node: {"ros__parameters": tree}}, default_flow_style=False))
    return None


def _place(tree: dict[str, Any], row: ParameterRow) -> None:
    """Nest a name at its dots, unless a part of it is the name of another parameter."""
    value = list(row.value) if isinstance(row.value, (bytes, bytearray)) else row.value
    *above, last = row.name.split(".")
    place = tree
    for step in above:
        place = place.setdefault(step, {})
        if not isinstance(place, dict):
            tree[row.name] = value
            return
    place[last] = value


@verb(
    "param list", "Output a list of available parameters", *COMMON,
    arg("node_name", nargs="?", help="Name of the ROS node"), options.hidden("nodes"),
    arg("--param-prefixes", nargs="+", default=[], help="Only list parameters with the provided prefixes"),
    flag("--param-type", help="Print parameter types with parameter names"),
    arg("--filter", help="Only list parameters that match the given regular expression"),
)  # fmt: skip
def list_parameters(args: argparse.Namespace) -> int | str | None:
    """Print their names, below the name of each node if there may be several."""
    hidden = args.hidden
    pattern = re.compile(args.filter or "")
    with joined(args, settled=not args.node_name) as me:
        if args.node_name:
            node = find_node(me, args)
            if not node:
                return NOT_FOUND
            found = [node]
        else:
            serving = dict(me.node.get_service_names_and_types())
            found = sorted(
                node for node in set(naming.nodes(me.node, hidden=hidden)) if f"{node}/list_parameters" in serving
            )
        silent = [str(told) for node in found if (told := _tell(me, node, args, pattern)) is not None]
    return "\n".join(silent) or None


def _tell(me: Guest, node: str, args: argparse.Namespace, pattern: re.Pattern[str]) -> NoAnswerError | None:
    """Print what a node has; return why it did not say."""
    try:
        response = call(me, node, "ListParameters", prefixes=args.param_prefixes)
        names = [name for name in sorted(response.result.names) if pattern.search(name)]
        lines = [plain(name) for name in names]
        if args.param_type:
            described = call(me, node, "DescribeParameters", names=names)
            lines = [f"{plain(each.name)} (type: {KINDS[each.type][0]})" for each in described.descriptors]
    except NoAnswerError as error:
        return error
    if not args.node_name:
        print(f"{node}:")
    print("".join(f"  {line}\n" for line in lines), end="", flush=True)
    return None
