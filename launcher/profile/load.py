"""Loading a profile: read, merge, override, validate; the result can be started.

`load_profile` is the only way to load one. It reports all problems at once, each with its position
in the file, and starts nothing.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from launcher.domain.domain import LAST_SAFE_DOMAIN, choose_domain
from launcher.errors import DomainError, ProfileError, ProfileProblem
from launcher.profile.check import applies, check_needs, check_node, check_run
from launcher.profile.defaults import name_of
from launcher.profile.devices import with_devices
from launcher.profile.extends import read_profile
from launcher.profile.overrides import read_sets
from launcher.profile.params import flatten
from launcher.profile.problems import Problems
from launcher.profile.references import used_devices
from launcher.profile.spec import NodeSpec, Profile, Ready
from launcher.profile.steps.check import check_steps
from launcher.profile.text import shown
from launcher.profile.validate import validate
from launcher.profile.when import HARDWARE
from text.run_path import run_path
from text.sentences import say
from text.yaml_tree import Branch, FilePlace, Scalar, find, place_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from launcher.profile.model import NodeDocument, ProfileDocument
    from launcher.serial_ports import SerialPort

__all__ = ["NodeSpec", "Profile", "ProfileError", "ProfileProblem", "Ready", "load_profile"]


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
        message = say("expected mock or real, found {found!r}", found=hardware)
        problems.add(FilePlace("--hardware"), (), message)
    tree = read_profile(path, problems)
    if tree is None or problems.found:
        raise ProfileError(problems.in_order())
    places = {"run_dir": str(run_path(env).absolute()), "domain": _early_domain(tree, domain, env)}
    used = used_devices(tree, hardware)
    tree = with_devices(tree, hardware, places, env, problems, ports)
    document, valid = validate(tree, problems)
    reader = _SpecBuilder(path.absolute(), tree, problems, used)
    nodes = reader.nodes(valid, hardware)
    if document is not None:
        check_steps(document, set(valid), tree, problems)
    nodes = read_sets(overrides, nodes, set(valid) - set(nodes), problems)
    if problems.found or document is None:
        raise ProfileError(problems.in_order())
    chosen = choose_domain(domain, document.domain, env)
    return reader.profile(document, nodes, hardware, chosen)


def _early_domain(tree: Branch, asked: int | None, environ: Mapping[str, str]) -> str:
    """Return the value of `${domain}`, before anything is validated."""
    written = find(tree, ("domain",))
    value = written.value if isinstance(written, Scalar) else None
    try:
        return str(choose_domain(asked, value if type(value) is int else None, environ))
    except DomainError:
        return ""  # Reported later, once everything else is valid.


@dataclass
class _SpecBuilder:
    """Turns validated documents into specs that can be started."""

    path: Path
    tree: Branch
    problems: Problems
    used: set[str]
    """The devices that nodes refer to."""

    def nodes(self, valid: Mapping[str, NodeDocument], hardware: str) -> dict[str, NodeSpec]:
        """Return the nodes that run on this hardware, including those with problems."""
        tree, problems = self.tree, self.problems
        every = find(tree, ("nodes",))
        everybody = list(every.entries) if isinstance(every, Branch) else []
        for name, node in valid.items():
            check_node(name, node, tree, problems)
        running = {name: node for name, node in valid.items() if applies(name, node, hardware, tree, problems)}
        if not running and not problems.found:
            self._nothing_runs(bool(valid), hardware)
        optional = {name for name, node in running.items() if node.optional}
        needs = {name: node.needs for name, node in running.items()}
        check_needs(needs, everybody, optional, tree, problems)
        return {name: self._node(name, node, running) for name, node in running.items()}

    def _nothing_runs(self, left_out: bool, hardware: str) -> None:
        message = say("there are no nodes to start")
        if left_out:
            message = say("no node is left with --hardware {hardware}", hardware=hardware)
        self.problems.add(place_of(self.tree, ("nodes",), key=True), ("nodes",), message)

    def _node(self, name: str, node: NodeDocument, running: Mapping[str, Any]) -> NodeSpec:
        where = ("nodes", name, "params")
        params = find(self.tree, where)
        cwd = None if node.cwd is None else Path(node.cwd)
        # Unlike Path.is_dir, this does not raise for a name that no directory can have.
        if cwd is not None and not os.path.isdir(cwd):  # noqa: PTH112
            here = ("nodes", name, "cwd")
            message = say("there is no directory {path}", path=shown(cwd))
            self.problems.add(place_of(self.tree, here), here, message)
        if node.run is not None:
            folders = [self.path.parent, cwd or Path.cwd()]
            check_run(name, node.run, folders, self.tree, self.problems)
        return NodeSpec(
            name=name,
            document=node,
            params={} if params is None else flatten(params, where, self.problems),
            needs=tuple(other for other in node.needs if other in running),
            ready=_ready(name, node),
            cwd=cwd,
            folder=self.path.parent,
        )

    def profile(self, document: ProfileDocument, nodes: dict[str, NodeSpec], hardware: str, domain: int) -> Profile:
        return Profile(
            path=self.path,
            name=name_of(self.path),
            nodes=nodes,
            document=document,
            domain=domain,
            hardware=hardware,
            used=tuple(name for name in document.devices if name in self.used),
            warnings=self._warnings(document),
        )

    def _warnings(self, document: ProfileDocument) -> tuple[ProfileProblem, ...]:
        found = Problems()
        if document.domain is not None and document.domain > LAST_SAFE_DOMAIN:
            found.add(
                place_of(self.tree, ("domain",)),
                ("domain",),
                say("the ports of domains above {safe} may be taken", safe=LAST_SAFE_DOMAIN),
                say("choose one from 1 to {safe}", safe=LAST_SAFE_DOMAIN),
            )
        return found.in_order()


def _ready(name: str, node: NodeDocument) -> Ready | None:
    """Return the condition as written; by default a `run` node must be in the graph."""
    if node.ready is None:
        return None if node.run is None or node.lifecycle else Ready("node", name)
    ready = node.ready
    if ready.lifecycle is not None:
        return Ready("lifecycle", ready.node or name, ready.lifecycle, within_s=ready.within)
    # A node that is brought up is in the graph.
    for kind in ("topic", "service") if node.lifecycle else ("topic", "service", "node"):
        found = getattr(ready, kind)
        if found is not None:
            return Ready(kind, found, ready.type or "", ready.rate or 0.0, ready.within)
    return None
