"""The plan for a supervisor, so that it does not have to read profiles itself.

The client reads and validates the profile while the supervisor is already starting, and passes it
the plan as one line of JSON. The order in which nodes start and stop is here as well.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from launcher.domain.discovery import settings_of_discovery
from launcher.domain.domain import settings_of_domain
from launcher.faults import CHECK_FIELDS
from launcher.profile.node import Node
from launcher.ros_tools import ros_tools, without_wheels
from launcher.status import SessionInfo
from launcher.wire import pack, unpack
from text.nested import read_json

if TYPE_CHECKING:
    # It is of pydantic, which a supervisor has no use for.
    from launcher.profile.model import Profile

Changes = dict[str, str | None]
"""Changes to the supervisor's environment; None unsets."""


@dataclass(frozen=True)
class Plan:
    """How all nodes of a session are started."""

    session: SessionInfo
    """What is known of it before it has a supervisor; `log_dir` is the folder of all logs."""
    nodes: tuple[Node, ...]
    env: Changes
    """For all nodes and the probe: domain, discovery, language."""
    foreign: dict[str, Changes] = field(default_factory=dict)
    """By node, for the programs of another environment."""
    run_dir: str = ""
    within: tuple[str, ...] = ()
    """The beginning of a command line that confines a program, for nodes other than Deck's; empty: none is."""

    @property
    def needs(self) -> dict[str, tuple[str, ...]]:
        return {node.name: node.needs for node in self.nodes}

    @property
    def drives(self) -> bool:
        """Whether any node commands the wheels."""
        return any(node.drives for node in self.nodes)

    @property
    def warm(self) -> bool:
        return any(node.is_forked for node in self.nodes)

    def env_of(self, node: Node) -> Changes:
        # Mistakes of a learner's own node show at the line where they are made.
        own: Changes = {CHECK_FIELDS: os.environ.get(CHECK_FIELDS, "1")} if node.file else {}
        foreign = self.foreign.get(node.name, {}) if _is_foreign(node) else {}
        return {**self.env, **own, **foreign, **node.env}

    def to_json(self) -> str:
        """Return it as one line; file names in it may contain lone surrogates."""
        return json.dumps(pack(self))

    @classmethod
    def from_json(cls, line: str | bytes) -> Plan:
        """Read the output of `to_json`."""
        plan: Plan = unpack(cls, read_json(line))
        return plan


def plan_of(
    profile: Profile, *, run_dir: str, log_dir: str, foreground: bool, node_lang: str, within: Iterable[str] = ()
) -> Plan:
    """Make the plan of a profile for this machine, environment and current folder."""
    session = SessionInfo(
        run_id="",
        profile=str(profile.path),
        name=profile.name,
        title=profile.title,
        lesson=profile.lesson,
        domain=profile.domain,
        discovery=profile.discovery,
        hardware=profile.hardware,
        panels=profile.panels,
        log_dir=log_dir,
        foreground=foreground,
        agents=profile.agents,
    )
    nodes = tuple(
        replace(node, cwd=node.cwd or os.getcwd())  # noqa: PTH109
        for node in profile.nodes.values()
    )
    return Plan(
        session=session,
        nodes=nodes,
        env=_common_env(profile, node_lang),
        foreign={node.name: _foreign_env(node.argv()[0]) for node in nodes if _is_foreign(node)},
        run_dir=run_dir,
        within=tuple(within),
    )


def _common_env(profile: Profile, node_lang: str) -> Changes:
    env: Changes = {
        **settings_of_domain(profile.domain, profile.discovery),
        **settings_of_discovery(os.environ, profile.discovery),
    }
    # A single format of log lines, which can be parsed.
    env["RCUTILS_CONSOLE_OUTPUT_FORMAT"] = None
    env["RCUTILS_COLORIZED_OUTPUT"] = "0"
    env["PYTHONUNBUFFERED"] = "1"
    env["PYTHONIOENCODING"] = "utf-8:backslashreplace"
    if node_lang:
        env["DECK_LANG"] = node_lang
    return env


def _is_foreign(node: Node) -> bool:
    return node.run is None and not node.is_python


def _foreign_env(program: str) -> Changes:
    """Return changes for a foreign program; `ros2` is found as in `deck shell`."""
    tools = ros_tools(os.environ) if program == "ros2" else {}
    return {**without_wheels(os.environ), **tools}


def with_needs(names: Iterable[str], needs: Mapping[str, Sequence[str]]) -> list[str]:
    """Return `names` and everything they need, directly or not, in starting order."""
    ordered: list[str] = []

    def visit(name: str) -> None:
        if name not in ordered:
            for needed in needs.get(name, ()):
                visit(needed)
            ordered.append(name)

    for name in names:
        visit(name)
    return ordered


def stop_waves(names: Iterable[str], needs: Mapping[str, Sequence[str]]) -> list[list[str]]:
    """Group `names` so that none is stopped before the others that need it."""
    left = list(names)
    waves = []
    while left:
        still_needed = {other for name in left for other in with_needs([name], needs) if other != name}
        wave = [name for name in left if name not in still_needed]
        waves.append(wave)
        left = [name for name in left if name in still_needed]
    return waves
