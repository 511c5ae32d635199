"""The spawn server: a child of the supervisor from which all nodes are forked.

It is the only part of the launcher that loads ROS. The supervisor starts it by `start` and uses it
through `spawner`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class SpawnRequest:
    """One process to be started."""

    kind: str
    """`module`: run in the warm interpreter; `exec`: a program; `probe`: the graph probe;
    `lifecycle`: watch one node's lifecycle."""
    name: str
    title: str
    argv: tuple[str, ...]
    """For `module`: the module or file with its arguments; for `exec`: the command line."""
    cwd: str
    env: Mapping[str, str | None] = field(default_factory=dict)
    """Changes to the supervisor's environment; None unsets."""
