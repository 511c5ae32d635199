"""Checks across the parts of a profile: names, commands, needs, modules."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.profile.files import file_of, files_beside
from launcher.profile.model import LONGEST_NODE_NAME, NODE_NAME, is_file
from launcher.profile.modules import is_installed, likely_names
from launcher.profile.text import shown
from launcher.profile.when import WhenError, holds
from text.sentences import say
from text.suggestions import did_you_mean
from text.yaml_tree import empty, find, place_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from launcher.profile.model import NodeDocument, ReadyDocument
    from launcher.profile.problems import Problems
    from text.yaml_tree import Branch, Where


def applies(name: str, node: NodeDocument, hardware: str, tree: Branch, problems: Problems) -> bool:
    """Whether a node's `when` allows it to run on this hardware."""
    if node.when is None:
        return True
    try:
        return holds(node.when, {"hardware": hardware})
    except WhenError as error:
        where = ("nodes", name, "when")
        problems.add(place_of(tree, where), where, error.message, error.hint)
        return True


def check_node(name: str, node: NodeDocument, tree: Branch, problems: Problems) -> None:
    """Check one node on its own: its name, and that it has exactly one of `run` and `exec`."""
    where = ("nodes", name)
    place = place_of(tree, where, key=True)
    if not NODE_NAME.fullmatch(name) or len(name) > LONGEST_NODE_NAME:
        problems.add(
            place,
            where,
            say("{name!r} is not a valid name for a ROS node", name=name),
            say("letters, digits and _, not beginning with a digit"),
        )
    given = {key for key in ("run", "exec") if not empty(find(tree, (*where, key)))}
    if not given:
        problems.add(place, where, say("needs `run` or `exec`"), say("write run: nodes.hello"))
    elif len(given) > 1:
        message = say("has both `run` and `exec`")
        problems.add(place_of(tree, (*where, "exec"), key=True), where, message, say("keep one"))
    if node.ready is not None:
        if not _is_one_condition(node, node.ready):
            problems.add(
                place_of(tree, (*where, "ready")),
                (*where, "ready"),
                say("expected exactly one of topic, service, node, lifecycle"),
                say("write ready: {topic: /chatter, within: 10}"),
            )
        for key in ("type", "rate"):
            if getattr(node.ready, key) is not None and node.ready.topic is None:
                problems.add(
                    place_of(tree, (*where, "ready", key), key=True),
                    (*where, "ready", key),
                    say("`{key}` belongs to a topic, but none is given here", key=key),
                    say("write ready: {topic: /chatter, type: std_msgs/msg/String, rate: 1}"),
                )


def _is_one_condition(node: NodeDocument, ready: ReadyDocument) -> bool:
    """Whether one thing is waited for; a node whose lifecycle is meant may be named, too."""
    one = ready.lifecycle if node.lifecycle else ready.lifecycle or ready.node
    count = sum(each is not None for each in (ready.topic, ready.service, one))
    return count == 1 or (count == 0 and node.lifecycle is not None)


def check_run(name: str, run: str, folders: Sequence[Path], tree: Branch, problems: Problems) -> None:
    """Check that the module or file that a node runs exists.

    `folders`: that of the profile, and others where users may expect modules; Deck does not search
    them.
    """
    where = ("nodes", name, "run")
    if is_file(run):
        # Unlike Path.is_file, this does not raise for a name that no file can have.
        if not os.path.isfile(run):  # noqa: PTH113
            file = Path(run)
            message = say("there is no file {path}", path=shown(file))
            hint = did_you_mean(f"./{file.name}", files_beside(file.parent))
            problems.add(place_of(tree, where), where, message, hint)
    elif not is_installed(run):
        message = say("there is no module {module!r}", module=run)
        own = file_of(run.removesuffix(".py"), folders, folders[0])
        hint = say("for your own file write run: {file}", file=own) if own else ""
        problems.add(place_of(tree, where), where, message, hint or did_you_mean(run, likely_names(run)))


def check_needs(
    needs: Mapping[str, tuple[str, ...]],
    everybody: Sequence[str],
    optional: set[str],
    tree: Branch,
    problems: Problems,
) -> None:
    """Check that the nodes needed by others exist, are not optional, and form no cycles.

    `needs`: those of the nodes that run; `everybody`: all node names in the file.
    """
    for name, needed in needs.items():
        for index, other in enumerate(needed):
            where: Where = ("nodes", name, "needs", index)
            if other not in everybody:
                message = say("there is no node {name!r}", name=other)
                problems.add(place_of(tree, where), where, message, did_you_mean(other, everybody))
            elif other in optional:
                message = say("{name} is optional, so nothing can need it", name=other)
                problems.add(place_of(tree, where), where, message)
    for cycle in _cycles(needs):
        where = ("nodes", cycle[0], "needs")
        path = " -> ".join([*cycle, cycle[0]])
        message = say("nodes need each other in a cycle: {cycle}", cycle=path)
        problems.add(place_of(tree, where), where, message, say("remove one of the needs"))


def _cycles(needs: Mapping[str, tuple[str, ...]]) -> list[list[str]]:
    """Return cycles, each once, from its first node in the file; not all of an entangled group."""
    order = {name: position for position, name in enumerate(needs)}
    done: set[str] = set()
    cycles: list[list[str]] = []
    for start in needs:
        path: list[str] = []
        branches = [iter([start])]
        while branches:
            name = next(branches[-1], None)
            if name is None:
                branches.pop()
                if path:
                    done.add(path.pop())
            elif name in path:
                cycle = path[path.index(name) :]
                first = cycle.index(min(cycle, key=order.__getitem__))
                cycles.append(cycle[first:] + cycle[:first])
            elif name in needs and name not in done:
                path.append(name)
                branches.append(iter(needs[name]))
    return cycles
