"""`ros2 param list`: the parameters of one node, or of all."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ros2 import naming, options, parameters
from ros2.joining import NoAnswerError, joined
from text.plain import plain

if TYPE_CHECKING:
    import argparse

    from ros2.joining import Guest

SUMMARY = "Output a list of available parameters"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    options.answers(parser)
    add = parser.add_argument
    add("node_name", nargs="?", help="Name of the ROS node")
    add("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")
    add("--param-prefixes", nargs="+", default=[], help="Only list parameters with the provided prefixes")
    add("--param-type", action="store_true", help="Print parameter types with parameter names")
    add("--filter", help="Only list parameters that match the given regular expression")


def main(args: argparse.Namespace) -> int | str | None:
    """Print their names, below the name of each node if there may be several."""
    hidden = args.include_hidden_nodes
    pattern = re.compile(args.filter or "")
    with joined(args, settled=not args.node_name) as me:
        if args.node_name:
            node = parameters.find_node(me, args.node_name, hidden=hidden)
            if not node:
                return parameters.NOT_FOUND
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
        response = parameters.call(me, node, "ListParameters", prefixes=args.param_prefixes)
        names = [name for name in sorted(response.result.names) if pattern.search(name)]
        lines = [plain(name) for name in names]
        if args.param_type:
            described = parameters.call(me, node, "DescribeParameters", names=names)
            lines = [f"{plain(each.name)} (type: {parameters.TYPES[each.type]})" for each in described.descriptors]
    except NoAnswerError as error:
        return error
    if not args.node_name:
        print(f"{node}:")
    print("".join(f"  {line}\n" for line in lines), end="", flush=True)
    return None
