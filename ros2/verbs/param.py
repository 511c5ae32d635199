"""`ros2 param`: the parameters of nodes, by the services that each node has for them."""

from __future__ import annotations

import re
import sys
from typing import TYPE_CHECKING

from graph.calls.parameters import SERVICES, TYPES, read, write
from graph.calls.parameters_file import dump as file_of
from graph.messages.yaml_text import value_of
from ros2 import naming
from ros2.joining import NoAnswerError, joined
from ros2.verb import ANSWERS, OF_GRAPH, arg, flag, hidden, verb
from text.i18n import localized
from text.plain import plain
from text.yaml_faults import YamlError

if TYPE_CHECKING:
    import argparse

    from graph.data import ParameterRow
    from ros2.joining import Guest

NOT_FOUND = "Node not found"
LIST = "list_parameters"
NODE = (OF_GRAPH, ANSWERS, arg("node_name", help="Name of the ROS node"))
PARAMETER = arg("parameter_name", help="Name of the parameter")


def _kind(type_name: str) -> str:
    """Return what the real tool calls a type: `boolean array`."""
    return type_name.replace("bool", "boolean").replace("_", " ")


def _rows(me: Guest, node: str) -> list[ParameterRow]:
    rows: list[ParameterRow] = []
    me.carry_out(node, read(rows), SERVICES)
    return rows


@verb("param set", "Set parameter", *NODE, PARAMETER, arg("value", help="Value of the parameter"))
def set_one(args: argparse.Namespace) -> str | None:
    """Set it; that the node refuses it goes to standard error, with the exit code 0."""
    try:
        value = value_of(args.value)
    except YamlError:
        value = None
    refused: dict[str, str] = {}
    with joined(args) as me:
        node = me.find(args.node_name, LIST)
        if not node:
            return NOT_FOUND
        # What is no value of a parameter is a text.
        given = args.value if value is None or isinstance(value, dict) else value
        me.carry_out(node, write({args.parameter_name: given}, refused), SERVICES)
    for reason in refused.values():
        print(f"Setting parameter failed: {localized(reason)}", file=sys.stderr)
    if not refused:
        print("Set parameter successful")
    return None


@verb("param get", "Get parameter", *NODE, PARAMETER, flag("--hide-type", help="Hide the type information"))
def get(args: argparse.Namespace) -> str | None:
    from rcl_interfaces.srv import GetParameters

    with joined(args) as me:
        node = me.find(args.node_name, LIST)
        if not node:
            return NOT_FOUND
        request = GetParameters.Request(names=[args.parameter_name])
        answer = me.call(f"{node}/get_parameters", GetParameters, node, request)
    if not answer.values:
        return "Parameter not set"
    number = answer.values[0].type
    if number == 0:
        print("None" if args.hide_type else "Parameter not set.")
        return None
    if number >= len(TYPES):
        return f"Unknown parameter type '{number}'"
    # As the message has it: an array prints as array('d', ...).
    held = getattr(answer.values[0], f"{TYPES[number]}_value")
    kind, _, many = _kind(TYPES[number]).partition(" ")
    label = f"{kind.title()} {'values are' if many else 'value is'}:"
    print(*([] if args.hide_type else [label]), held)
    return None


@verb(
    "param describe", "Show descriptive information about declared parameters", *NODE,
    arg("parameter_names", nargs="+", help="Names of the parameters"),
)  # fmt: skip
def describe(args: argparse.Namespace) -> str | None:
    """Print what the node has declared."""
    with joined(args) as me:
        node = me.find(args.node_name, LIST)
        if not node:
            return NOT_FOUND
        known = {row.name: row for row in _rows(me, node)}
    for row in (known[name] for name in args.parameter_names if name in known):
        whole = row.type_name.startswith("integer")
        limits = [(words, each) for words, each in _limits(row) if each is not None]
        print(f"Parameter name: {plain(row.name)}\n  Type: {_kind(row.type_name)}")
        print(f"  Description: {row.description}\n" if row.description else "", "  Constraints:", sep="")
        if row.read_only:
            print("    Read only: true")
        for words, limit in limits:
            print(f"    {words}: {int(limit) if whole else limit}")
        if row.constraints:
            print("    Additional constraints:", row.constraints)
    return None


def _limits(row: ParameterRow) -> tuple[tuple[str, float | None], ...]:
    return ("Min value", row.least), ("Max value", row.greatest), ("Step", row.step)


@verb("param dump", "Show all of the parameters of a node in a YAML file format", *NODE)
def dump(args: argparse.Namespace) -> str | None:
    """Print the file, which `--ros-args --params-file` takes."""
    with joined(args) as me:
        node = me.find(args.node_name, LIST)
        if not node:
            return NOT_FOUND
        print(file_of(node, _rows(me, node)))
    return None


@verb(
    "param list", "Output a list of available parameters", OF_GRAPH, ANSWERS,
    arg("node_name", nargs="?", help="Name of the ROS node"), hidden("nodes"),
    flag("--param-type", help="Print parameter types with parameter names"),
    arg("--filter", default="", help="Only list parameters that match the given regular expression"),
)  # fmt: skip
def list_parameters(args: argparse.Namespace) -> str | None:
    """Print their names, below the name of each node if there may be several."""
    silent = []
    with joined(args, settled=not args.node_name) as me:
        if args.node_name:
            found = [me.find(args.node_name, LIST)]
            if not found[0]:
                return NOT_FOUND
        else:
            serving = dict(me.node.get_service_names_and_types())
            nodes = set(naming.nodes(me.node, hidden=args.hidden))
            found = sorted(node for node in nodes if f"{node}/{LIST}" in serving)
        for node in found:
            try:
                rows = [row for row in _rows(me, node) if re.search(args.filter, row.name)]
            except NoAnswerError as error:
                silent.append(str(error))
                continue
            print("" if args.node_name else f"{node}:\n", end="")
            for row in rows:
                print(
                    f"  {plain(row.name)}{f' (type: {_kind(row.type_name)})' if args.param_type else ''}", flush=True
                )
    return "\n".join(silent) or None
