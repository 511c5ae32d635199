"""The plan for a supervisor: plain data, so that it does not have to read profiles itself.

The client reads and validates the profile while the supervisor is already starting, and passes it
the plan as one line of JSON.
"""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

from launcher.consent import DEFAULT_RULES, AgentRules
from launcher.control.protocol import unpack_rules
from launcher.domain.discovery import settings_of_discovery
from launcher.domain.domain import ros_environment
from launcher.faults import CHECK_FIELDS
from launcher.profile.defaults import READY_WITHIN_S
from launcher.profile.driving import drives
from launcher.ros_tools import ros_tools, without_wheels
from launcher.supervisor.readiness import ReadyCondition
from text.nested import read_json

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from launcher.profile.load import NodeSpec, Profile

_COLD_PREFIXES = ("PYTHON", "LD_", "RMW_", "OPENBLAS_", "OMP_", "MALLOC_", "LTTNG_", "AMENT_")
"""Variables read when an interpreter or a library is loaded: after a fork it is too late."""


@dataclass(frozen=True)
class NodePlan:
    """How one node is started."""

    name: str
    command: str
    argv: tuple[str, ...]
    """The full command line for a start without the spawn server."""
    module: tuple[str, ...] = ()
    """The module or file with its arguments if it is to be forked warm, else empty."""
    env: dict[str, str | None] = field(default_factory=dict)
    """Changes to the supervisor's environment; None unsets."""
    cwd: str = "/"
    needs: tuple[str, ...] = ()
    ready: ReadyCondition | None = None
    lifecycle: ReadyCondition | None = None
    """The state that it is brought to before that."""
    within_s: float = READY_WITHIN_S
    restart: str = "never"
    optional: bool = False
    file: str = ""
    """The learner's own file that it runs, absolute."""
    ours: bool = False
    """Whether it is a module of Deck, which is never confined."""

    @property
    def conditions(self) -> tuple[ReadyCondition, ...]:
        """Everything that has to hold, in this order."""
        return tuple(each for each in (self.lifecycle, self.ready) if each is not None)


@dataclass(frozen=True)
class Plan:
    """How all nodes of a session are started."""

    profile: str
    name: str
    nodes: tuple[NodePlan, ...]
    env: dict[str, str | None]
    """Changes for all nodes and the probe: domain, discovery, language."""
    run_dir: str
    log_dir: str
    title: dict[str, str] = field(default_factory=dict)
    lesson: str = ""
    domain: int = 0
    discovery: str | tuple[str, ...] = "localhost"
    hardware: str = "mock"
    panels: tuple[str, ...] = ()
    foreground: bool = True
    within: tuple[str, ...] = ()
    """The beginning of a command line that confines a program, for nodes other than Deck's; empty: none is."""
    agents: AgentRules = DEFAULT_RULES
    """What agents may do."""

    @property
    def needs(self) -> dict[str, tuple[str, ...]]:
        return {node.name: node.needs for node in self.nodes}

    @property
    def drives(self) -> bool:
        """Whether any node commands the wheels."""
        return any(drives(node.command) for node in self.nodes)

    @property
    def warm(self) -> bool:
        return any(node.module for node in self.nodes)

    @property
    def packages(self) -> set[str]:
        """The packages of the modules that are to be forked warm."""
        modules = (node.module[0] for node in self.nodes if node.module)
        return {module.rpartition(".")[0] for module in modules if "/" not in module} - {""}

    def to_json(self) -> str:
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, line: str | bytes) -> Plan:
        """Read the output of `to_json`."""
        fields: dict[str, Any] = read_json(line)
        fields["nodes"] = tuple(_node_from(node) for node in fields["nodes"])
        fields["panels"] = tuple(fields["panels"])
        fields["within"] = tuple(fields["within"])
        fields["agents"] = unpack_rules(fields["agents"])
        if not isinstance(fields["discovery"], str):
            fields["discovery"] = tuple(fields["discovery"])
        return cls(**fields)


def _node_from(fields: dict[str, Any]) -> NodePlan:
    for key in ("argv", "module", "needs"):
        fields[key] = tuple(fields[key])
    for key in ("ready", "lifecycle"):
        if fields[key] is not None:
            fields[key] = ReadyCondition(**fields[key])
    return NodePlan(**fields)


def plan_of(
    profile: Profile, *, run_dir: str, log_dir: str, foreground: bool, node_lang: str, within: Iterable[str] = ()
) -> Plan:
    """Make the plan of a profile for this machine, environment and current folder."""
    return Plan(
        profile=str(profile.path),
        name=profile.name,
        nodes=tuple(_node_plan(node) for node in profile.nodes.values()),
        env=_common_env(profile, node_lang),
        run_dir=run_dir,
        log_dir=log_dir,
        title=dict(profile.document.title),
        lesson=profile.document.lesson,
        domain=profile.domain,
        discovery=profile.document.discovery,
        hardware=profile.hardware,
        panels=tuple(profile.document.panels),
        foreground=foreground,
        within=tuple(within),
        agents=AgentRules(**profile.document.agents.model_dump()),
    )


def _common_env(profile: Profile, node_lang: str) -> dict[str, str | None]:
    wanted = ros_environment(os.environ, profile.domain, profile.document.discovery)
    env: dict[str, str | None] = {
        name: wanted.get(name) for name in {*wanted, *os.environ} if wanted.get(name) != os.environ.get(name)
    }
    env.update(settings_of_discovery(os.environ, profile.document.discovery))
    # A single format of log lines, which can be parsed.
    env["RCUTILS_CONSOLE_OUTPUT_FORMAT"] = None
    env["RCUTILS_COLORIZED_OUTPUT"] = "0"
    env["PYTHONUNBUFFERED"] = "1"
    env["PYTHONIOENCODING"] = "utf-8:backslashreplace"
    if node_lang:
        env["DECK_LANG"] = node_lang
    return env


def _node_plan(node: NodeSpec) -> NodePlan:
    said = node.document
    argv = tuple(node.argv())
    env: dict[str, str | None] = {}
    module: tuple[str, ...] = ()
    if said.run is None:
        env.update({} if node.is_python else _foreign_env(argv[0]))
    elif said.warm and not any(name.startswith(_COLD_PREFIXES) for name in said.env):
        module = argv[argv.index(said.run) :]
    ready = node.ready
    return NodePlan(
        name=node.name,
        command=node.command,
        argv=argv,
        module=module,
        env={**_learner_env(node), **env, **said.env},
        cwd=str(node.cwd) if node.cwd is not None else os.getcwd(),  # noqa: PTH109
        needs=tuple(node.needs),
        ready=None if ready is None else ReadyCondition(ready.kind, ready.name, ready.type, ready.rate_hz),
        lifecycle=None
        if said.lifecycle is None
        else ReadyCondition("lifecycle", node.managed, said.lifecycle, goes=True),
        within_s=READY_WITHIN_S if said.ready is None else said.ready.within,
        restart=said.restart,
        optional=said.optional,
        file=node.own_file,
        ours=node.is_ours,
    )


def _learner_env(node: NodeSpec) -> Mapping[str, str | None]:
    """Return what makes mistakes of a learner's own node show at the line where they are made."""
    return {CHECK_FIELDS: os.environ.get(CHECK_FIELDS, "1")} if node.own_file else {}


def _foreign_env(program: str) -> Mapping[str, str | None]:
    """Return changes for a foreign program; `ros2` is found as in `deck shell`."""
    tools = ros_tools(os.environ) if program == "ros2" else {}
    return {**without_wheels(os.environ), **tools}
