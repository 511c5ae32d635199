"""Checks across the parts of a profile: names, commands, needs, modules; ids and `${...}` of steps."""

from __future__ import annotations

import os
import pkgutil
import sys
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from typing import Any

from launcher.node_program import INSTALLATION
from launcher.profile.defaults import shown
from launcher.profile.model import Profile
from launcher.profile.node import LONGEST_NODE_NAME, NODE_NAME, Node, Ready, is_file
from launcher.profile.reading import Problems, file_of, files_beside
from launcher.profile.steps.checks import CheckDocument, FieldCheck, LogCheck, NodeCheck, PublishCheck, kind_of
from launcher.profile.steps.draw import draw
from launcher.profile.steps.expressions import Drawn, ExpressionError, evaluate, expressions
from launcher.profile.steps.model import ValueDocument
from launcher.profile.when import WhenError, holds
from text.sentences import say
from text.suggestions import did_you_mean
from text.yaml_tree import Where, empty, find, place_of

COURSE = "nodes"
"""The package of the course's nodes."""


def is_installed(module: str) -> bool:
    """Whether a node can run this module, that is, `launcher.node_program` finds it."""
    return _runnable(module, _places())


def likely_names(module: str) -> list[str]:
    """Return modules that may have been meant: those of the same package, and the course's."""
    package, _, _ = module.rpartition(".")
    names = []
    for parent in {package, COURSE} - {""}:
        spec = _find(parent, _places())
        inner = spec.submodule_search_locations if spec is not None else None
        names += [f"{parent}.{name}" for name in _inside(inner or ())]
    return names


def _places() -> list[str]:
    """The search path of a node's Python: without the current folder, unless PYTHONPATH has it."""
    here = os.getcwd()  # noqa: PTH109
    named = [part for part in os.environ.get("PYTHONPATH", "").split(os.pathsep) if part]
    others = (place for place in sys.path if place and place != here)
    return [INSTALLATION, *map(os.path.abspath, named), *others]


def _inside(places: Iterable[str]) -> list[str]:
    found = (module.name for module in pkgutil.iter_modules(list(places)))
    return [name for name in found if not name.startswith("_")]


def _runnable(module: str, places: Sequence[str]) -> bool:
    spec = _find(module, places)
    if spec is None or spec.submodule_search_locations is None:
        return spec is not None
    return _find_in(f"{module}.__main__", list(spec.submodule_search_locations)) is not None


def _find(module: str, places: Sequence[str]) -> ModuleSpec | None:
    """Find a module part by part: `find_spec` on the whole name would import its packages."""
    name, spec = "", None
    inner = list(places)
    for part in module.split("."):
        name = f"{name}.{part}" if name else part
        spec = _find_in(name, inner)
        if spec is None:
            return None
        inner = list(spec.submodule_search_locations or ())
    return spec


def _find_in(name: str, places: list[str]) -> ModuleSpec | None:
    for finder in sys.meta_path:
        find_spec = getattr(finder, "find_spec", None)
        # Only the path finder is given the places; those of editable installs have their own.
        where = places if finder is PathFinder or "." in name else None
        try:
            spec: ModuleSpec | None = find_spec(name, where) if find_spec else None
        except (ImportError, ValueError, OSError):
            continue
        if spec is not None:
            return spec
    return None


PASSIVE = ("field", "log", "python", "topic")
"""What may stand in `then`: what only looks."""


def applies(node: Node, hardware: str, problems: Problems) -> bool:
    """Whether a node's `when` allows it to run on this hardware."""
    try:
        return node.when is None or holds(node.when, {"hardware": hardware})
    except WhenError as error:
        problems.at(("nodes", node.name, "when"), error.message, error.hint)
        return True


def check_node(node: Node, problems: Problems) -> None:
    """Check one node on its own: its name, its command, its condition."""
    where = ("nodes", node.name)
    if not NODE_NAME.fullmatch(node.name) or len(node.name) > LONGEST_NODE_NAME:
        message = say("{name!r} is not a valid name for a ROS node", name=node.name)
        problems.at(where, message, say("letters, digits and _, not beginning with a digit"), key=True)
    given = [key for key in ("run", "exec") if not empty(find(problems.tree, (*where, key)))]
    if not given:
        problems.at(where, say("needs `run` or `exec`"), say("write run: nodes.hello"), key=True)
    elif len(given) > 1:
        place = place_of(problems.tree, (*where, "exec"), key=True)
        problems.add(place, where, say("has both `run` and `exec`"), say("keep one"))
    if node.ready is not None:
        _check_ready(node, node.ready, problems)


def _check_ready(node: Node, ready: Ready, problems: Problems) -> None:
    where = ("nodes", node.name, "ready")
    # A node whose lifecycle is meant may be named, too.
    one = ready.lifecycle if node.lifecycle else ready.lifecycle or ready.node
    count = sum(each is not None for each in (ready.topic, ready.service, one))
    if count != 1 and (count or node.lifecycle is None):
        message = say("expected exactly one of topic, service, node, lifecycle")
        problems.at(where, message, say("write ready: {topic: /chatter, within: 10}"))
    for key in ("type", "rate"):
        if getattr(ready, key) is not None and ready.topic is None:
            problems.at(
                (*where, key),
                say("`{key}` belongs to a topic, but none is given here", key=key),
                say("write ready: {topic: /chatter, type: std_msgs/msg/String, rate: 1}"),
                key=True,
            )


def check_files(node: Node, folder: Path, problems: Problems) -> None:
    """Check that the module or file that a node runs exists, and the directory it runs in.

    `folder`: that of the profile, where users may expect modules; Deck does not search it.
    """
    # Unlike Path.is_dir and Path.is_file, those of os.path do not raise for a name that nothing can have.
    if node.cwd is not None and not os.path.isdir(node.cwd):  # noqa: PTH112
        message = say("there is no directory {path}", path=shown(Path(node.cwd)))
        problems.at(("nodes", node.name, "cwd"), message)
    run, where = node.run, ("nodes", node.name, "run")
    if run is None:
        return
    if is_file(run):
        if not os.path.isfile(run):  # noqa: PTH113
            file = Path(run)
            hint = did_you_mean(f"./{file.name}", files_beside(file.parent))
            problems.at(where, say("there is no file {path}", path=shown(file)), hint)
    elif not is_installed(run):
        own = file_of(run.removesuffix(".py"), [folder, Path(node.cwd or Path.cwd())], folder)
        hint = say("for your own file write run: {file}", file=own) if own else ""
        problems.at(
            where, say("there is no module {module!r}", module=run), hint or did_you_mean(run, likely_names(run))
        )


def check_needs(nodes: Mapping[str, Node], everybody: Sequence[str], problems: Problems) -> None:
    """Check that the nodes needed by others exist, are not optional, and form no cycles.

    `nodes`: those that run; `everybody`: all node names in the file.
    """
    for name, node in nodes.items():
        for index, other in enumerate(node.needs):
            where: Where = ("nodes", name, "needs", index)
            if other not in everybody:
                problems.at(where, say("there is no node {name!r}", name=other), did_you_mean(other, everybody))
            elif other in nodes and nodes[other].optional:
                problems.at(where, say("{name} is optional, so nothing can need it", name=other))
    try:
        TopologicalSorter({name: node.needs for name, node in nodes.items()}).prepare()
    except CycleError as error:
        # Each of these is needed by the next; it is told from its first node in the file.
        *cycle, _first = reversed(error.args[1])
        first = cycle.index(min(cycle, key=list(nodes).index))
        cycle = [*cycle[first:], *cycle[:first], cycle[first]]
        message = say("nodes need each other in a cycle: {cycle}", cycle=" -> ".join(cycle))
        problems.at(("nodes", cycle[0], "needs"), message, say("remove one of the needs"))


def check_steps(profile: Profile, nodes: Collection[str], problems: Problems) -> None:
    """Check the steps and values of a profile with these nodes."""
    for name, value in profile.values.items():
        _check_value(("values", name), value, problems)
    if problems.found:
        return
    values = draw(profile.values, seed=1)
    before: list[str] = []
    for index, step in enumerate(profile.steps):
        where: Where = ("steps", index)
        if step.id in before:
            problems.at((*where, "id"), say("there is a step {id!r} already", id=step.id))
        for number, other in enumerate(step.needs):
            if other not in before:
                message = say("no step before this one is called {id!r}", id=other)
                problems.at((*where, "needs", number), message, did_you_mean(other, before))
        before.append(step.id)
        _check_checks(step.checks, (*where, "checks"), nodes, problems)
        for here, text in _texts(step.checks, (*where, "checks")):
            _check_text(text, here, values, problems)


def _check_value(where: Where, value: ValueDocument, problems: Problems) -> None:
    if (value.between is None) == (not value.one_of):
        problems.at(where, say("expected exactly one of between, one_of"))
    elif value.between is not None and value.between[0] >= value.between[1]:
        problems.at(where, say("the first number must be the smaller one"))
    elif not all(isinstance(each, (str, int, float)) for each in value.one_of):
        problems.at(where, say("expected texts or numbers"))


def _check_checks(
    checks: tuple[CheckDocument, ...], above: Where, nodes: Collection[str], problems: Problems
) -> None:
    for index, check in enumerate(checks):
        where = (*above, index)
        if isinstance(check, LogCheck) or (isinstance(check, NodeCheck) and check.ends is not None):
            kind = str(kind_of(check))
            name = str(getattr(check, kind)).lstrip("/")
            if name not in nodes:
                message = say("there is no node {name!r}", name=name)
                problems.at((*where, kind), message, did_you_mean(name, nodes))
        if isinstance(check, FieldCheck):
            given = (check.between, check.equals, check.changes, check.matches)
            if sum(each is not None for each in given) != 1:
                problems.at(where, say("expected exactly one of between, equals, changes, matches"))
        if isinstance(check, PublishCheck):
            then = (*where, "then")
            for number, follows in enumerate(check.then):
                if kind_of(follows) not in PASSIVE:
                    problems.at((*then, number), say("only these can follow: {kinds}", kinds=", ".join(PASSIVE)))
            _check_checks(check.then, then, nodes, problems)


def _texts(value: Any, where: Where) -> Iterator[tuple[Where, str]]:  # noqa: ANN401 - any YAML
    if isinstance(value, CheckDocument):
        value = value.model_dump(by_alias=True)
    if isinstance(value, str):
        yield where, value
    elif isinstance(value, dict):
        for key, inner in value.items():
            if key not in ("look", "what"):
                yield from _texts(inner, (*where, key))
    elif isinstance(value, (list, tuple)):
        for index, inner in enumerate(value):
            yield from _texts(inner, (*where, index))


def _check_text(text: str, where: Where, values: Mapping[str, Drawn], problems: Problems) -> None:
    try:
        for expression in expressions(text):
            evaluate(expression, values)
    except ExpressionError as error:
        problems.at(where, error.words)
