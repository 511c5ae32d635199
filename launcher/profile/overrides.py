"""`--set node.param=value`: parameters from the command line, overriding the profile."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from launcher.profile.params import flatten
from launcher.profile.reading import read_value
from text.sentences import say
from text.suggestions import did_you_mean
from text.yaml_tree import Branch, FilePlace, MappingEntry

if TYPE_CHECKING:
    from collections.abc import Iterable

    from launcher.profile.problems import Problems
    from launcher.profile.spec import NodeSpec


def read_sets(
    overrides: Iterable[str], nodes: dict[str, NodeSpec], left_out: set[str], problems: Problems
) -> dict[str, NodeSpec]:
    """Return the nodes with their parameters overridden; overrides without a node are problems.

    `left_out`: nodes in the file that do not run on this hardware.
    """
    result = dict(nodes)
    for text in overrides:
        place = FilePlace(f"--set {text}")
        target, equals, written = text.partition("=")
        node, dot, param = target.strip().partition(".")
        if not (equals and dot and node and param):
            message = say("expected node.param=value")
            problems.add(place, (), message, say("write --set sonar_front.rate=2.0"))
        elif node in left_out:
            problems.add(place, (), say("{name} does not run on this hardware", name=node))
        elif node not in result:
            known = did_you_mean(node, result) or say("known: {keys}", keys=", ".join(result))
            problems.add(place, (), say("there is no node {name!r}", name=node), known)
        else:
            value = read_value(written, place.file, problems)
            if value is not None:
                one = Branch({param: MappingEntry(place, value)}, place)
                params = {**result[node].params, **flatten(one, (node,), problems)}
                result[node] = replace(result[node], params=params)
    return result
