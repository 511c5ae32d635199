"""Calls to the parameter services of a node."""

from __future__ import annotations

import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from graph.messages.making import to_message
from graph.messages.values import to_tree
from graph.messages.yaml_reading import value_of
from ros2.joining import joined
from ros2.naming import absolute, nodes
from text.i18n import localized
from text.yaml_faults import YamlError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from rcl_interfaces.msg import Parameter, ParameterValue

    from graph.calls.exchanges import Exchange
    from ros2.joining import Guest

NOT_FOUND = "Node not found"
TYPES = (
    "not set", "boolean", "integer", "double", "string", "byte array", "boolean array",
    "integer array", "double array", "string array",
)  # fmt: skip
"""By the numbers of rcl_interfaces/msg/ParameterType."""
FIELDS = (
    "", "bool_value", "integer_value", "double_value", "string_value", "byte_array_value",
    "bool_array_value", "integer_array_value", "double_array_value", "string_array_value",
)  # fmt: skip
"""Where a value of that number is in rcl_interfaces/msg/ParameterValue."""


def find_node(me: Guest, name: str, *, hidden: bool) -> str:
    """Return the full name of a node once it is there, empty if it is not."""
    full = absolute(name)
    hidden = hidden or full.rpartition("/")[2].startswith("_")
    return full if me.await_until(lambda: full in nodes(me.node, hidden=hidden)) else ""


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


def write(args: argparse.Namespace, wanted: Sequence[Parameter], *, done: str, failed: str) -> str | None:
    """Have a node take parameters; print `done`, or `failed` to standard error, with the reason.

    Both may have `{name}` in them. Returns why the node was not asked; None if it was, whatever it
    answered.
    """
    with joined(args) as me:
        node = find_node(me, args.node_name, hidden=args.include_hidden_nodes)
        if not node:
            return NOT_FOUND
        response = call(me, node, "SetParameters", parameters=list(wanted))
    for parameter, result in zip(wanted, response.results, strict=True):
        reason = f": {result.reason}" if result.reason else ""
        if result.successful:
            print(f"{done.format(name=parameter.name)}{reason}")
        else:
            print(f"{failed.format(name=parameter.name)}{reason}", file=sys.stderr)
    return None


def typed_value(name: str, given: Any) -> ParameterValue:  # noqa: ANN401 - plain values
    """Return a value with the type it has itself; RuntimeError if a parameter cannot have it."""
    from rcl_interfaces.msg import ParameterValue

    from graph.calls.parameters_values import WrongValueError, carried

    if isinstance(given, list) and not given:
        # It has no type; ROS's own tool sends this one.
        return ParameterValue(type=FIELDS.index("bool_array_value"))
    try:
        return to_message(ParameterValue, carried("not_set", given))
    except WrongValueError as error:
        raise RuntimeError(f"{name}: {localized(error.words)}") from error


def written_value(name: str, text: str) -> ParameterValue:
    """Return the value that a word of a command line means, as YAML or else as it stands."""
    try:
        meant = value_of(text)
    except YamlError:
        meant = text
    return typed_value(name, text if meant is None or isinstance(meant, dict) else meant)
