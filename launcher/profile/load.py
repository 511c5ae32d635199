"""Loading a profile: read, merge, override, validate; the result can be started.

`load_profile` is the only way to load one. It reports all problems at once, each with its position
in the file, and starts nothing.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from launcher.domain.domain import LAST_SAFE_DOMAIN, choose_domain
from launcher.errors import DomainError, ProfileError, ProfileProblem
from launcher.profile.check import applies, check_files, check_needs, check_node, check_steps
from launcher.profile.defaults import name_of, shown
from launcher.profile.devices import used_devices, with_devices
from launcher.profile.model import Profile
from launcher.profile.node import Node, Ready
from launcher.profile.params import flatten
from launcher.profile.reading import Problems, read_profile, read_value
from launcher.profile.validate import validate
from launcher.profile.when import HARDWARE
from launcher.serial_ports import SerialPort
from text.run_path import run_path
from text.sentences import say
from text.suggestions import did_you_mean
from text.yaml_tree import Branch, FilePlace, MappingEntry, Scalar, find

__all__ = ["Node", "Profile", "ProfileError", "ProfileProblem", "Ready", "load_profile"]


def load_profile(
    path: Path | str,
    *,
    hardware: str = "mock",
    overrides: Iterable[str] = (),
    domain: int | None = None,
    environ: Mapping[str, str] | None = None,
    ports: Callable[[], Sequence[SerialPort]] | None = None,
) -> Profile:
    """Load a profile and everything that it extends.

    Args:
        path: its file
        hardware: `mock` or `real`, for the conditions in `when`
        overrides: `node.param=value`, the value being read as YAML
        domain: the ROS domain, overriding the profile and the environment
        environ: where DECK_* and ROS_DOMAIN_ID are read from; default: that of this process
        ports: lists the serial ports, for devices with `port: auto`; pass `serial_ports` to start
            the profile, nothing to only read it

    Raises:
        ProfileError: with all problems.
        DomainError: if the chosen domain is invalid.
    """
    path = Path(path)
    env = os.environ if environ is None else environ
    problems = Problems()
    if hardware not in HARDWARE:
        problems.add(FilePlace("--hardware"), (), say("expected mock or real, found {found!r}", found=hardware))
    tree = read_profile(path, problems)
    if tree is None or problems.found:
        raise ProfileError(problems.in_order())
    places = {"run_dir": str(run_path(env).absolute()), "domain": _early_domain(tree, domain, env)}
    used = used_devices(tree, hardware)
    tree = problems.tree = with_devices(tree, hardware, places, env, problems, ports)
    profile, valid = validate(problems)
    nodes = _running(valid, hardware, path.absolute().parent, problems)
    if profile is not None:
        check_steps(profile, set(valid), problems)
    nodes = _with_overrides(overrides, nodes, set(valid) - set(nodes), problems)
    if problems.found or profile is None:
        raise ProfileError(problems.in_order())
    given: dict[str, Any] = {
        "path": path.absolute(),
        "name": name_of(path.absolute()),
        "nodes": nodes,
        "hardware": hardware,
        "domain": choose_domain(domain, _own_domain(tree), env),
        "is_domain_chosen": bool(domain is not None or _own_domain(tree) is not None or env.get("ROS_DOMAIN_ID")),
        "used": tuple(name for name in profile.devices if name in used),
        "warnings": _warnings(tree),
    }
    return profile.model_copy(update=given)


def _own_domain(tree: Branch) -> int | None:
    """Return the domain that the profile says, None if it says none, or nothing valid."""
    written = find(tree, ("domain",))
    value = written.value if isinstance(written, Scalar) else None
    return value if type(value) is int else None


def _early_domain(tree: Branch, asked: int | None, environ: Mapping[str, str]) -> str:
    """Return the value of `${domain}`, before anything is validated."""
    try:
        return str(choose_domain(asked, _own_domain(tree), environ))
    except DomainError:
        return ""  # Reported later, once everything else is valid.


def _warnings(tree: Branch) -> tuple[ProfileProblem, ...]:
    found = Problems(tree=tree)
    if (_own_domain(tree) or 0) > LAST_SAFE_DOMAIN:
        found.at(
            ("domain",),
            say("the ports of domains above {safe} may be taken", safe=LAST_SAFE_DOMAIN),
            say("choose one from 1 to {safe}", safe=LAST_SAFE_DOMAIN),
        )
    return found.in_order()


def _running(valid: Mapping[str, Node], hardware: str, folder: Path, problems: Problems) -> dict[str, Node]:
    """Return the nodes that run on this hardware, including those with problems."""
    every = find(problems.tree, ("nodes",))
    everybody = list(every.entries) if isinstance(every, Branch) else []
    for node in valid.values():
        check_node(node, problems)
    running = {name: node for name, node in valid.items() if applies(node, hardware, problems)}
    if not running and not problems.found:
        message = say("no node is left with --hardware {hardware}", hardware=hardware)
        problems.at(("nodes",), message if valid else say("there are no nodes to start"), key=True)
    check_needs(running, everybody, problems)
    for node in running.values():
        check_files(node, folder, problems)
    return {name: _resolved(node, running, folder, problems) for name, node in running.items()}


def _resolved(node: Node, running: Mapping[str, Node], folder: Path, problems: Problems) -> Node:
    """Return a node with what follows from the rest of the profile, and by default."""
    where = ("nodes", node.name, "params")
    params = find(problems.tree, where)
    changes: dict[str, Any] = {
        "params": {} if params is None else flatten(params, where, problems),
        "needs": tuple(other for other in node.needs if other in running),
    }
    if node.ready is None and node.run is not None and node.lifecycle is None:
        changes["ready"] = Ready(node=node.name)
    elif node.ready is not None and node.ready.lifecycle is not None and node.ready.node is None:
        changes["ready"] = replace(node.ready, node=node.name)
    words = node.exec or ()
    if node.file and words and node.cwd is None and os.path.isfile(folder / words[1]):  # noqa: PTH113
        changes["exec"] = (words[0], str(folder / words[1]), *words[2:])
    return replace(node, **changes)


def _with_overrides(
    overrides: Iterable[str], nodes: dict[str, Node], left_out: set[str], problems: Problems
) -> dict[str, Node]:
    """Return the nodes with the parameters of `--set node.param=value`.

    `left_out`: nodes in the file that do not run on this hardware.
    """
    result = dict(nodes)
    for text in overrides:
        place = FilePlace(f"--set {text}")
        target, equals, written = text.partition("=")
        name, dot, param = target.strip().partition(".")
        if not (equals and dot and name and param):
            problems.add(place, (), say("expected node.param=value"), say("write --set sonar_front.rate=2.0"))
        elif name in left_out:
            problems.add(place, (), say("{name} does not run on this hardware", name=name))
        elif name not in result:
            known = did_you_mean(name, result) or say("known: {keys}", keys=", ".join(result))
            problems.add(place, (), say("there is no node {name!r}", name=name), known)
        else:
            value = read_value(written, place.file, problems)
            if value is not None:
                one = Branch({param: MappingEntry(place, value)}, place)
                params = {**result[name].params, **flatten(one, (name,), problems)}
                result[name] = replace(result[name], params=params)
    return result


def faults_of(profile: Profile) -> tuple[ProfileProblem, ...]:
    """Return a problem for each of the learner's own files that does not compile, or imports what is not there."""
    from launcher.faults.source import look_at

    files = {node.file: name for name, node in profile.nodes.items() if node.file}
    faults = [(name, look_at(file)) for file, name in files.items()]
    return tuple(
        ProfileProblem(
            shown(Path(fault.file)), fault.line, fault.column, f"nodes.{name}", fault.exception, fault.meaning
        )
        for name, fault in faults
        if fault is not None
    )
