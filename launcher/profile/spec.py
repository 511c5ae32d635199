"""The result of loading a profile: plain data that can be started."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from launcher import node_program
from launcher.profile.defaults import READY_WITHIN_S
from launcher.profile.params import as_arguments

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from launcher.errors import ProfileProblem
    from launcher.profile.model import NodeDocument, ProfileDocument
    from launcher.profile.params import Param


PYTHONS = ("python", "python3")


@dataclass(frozen=True)
class Ready:
    """The condition under which a node counts as ready."""

    kind: str
    """`topic`, `service`, `node` or `lifecycle`."""
    name: str
    """A ROS name as in the profile, absolute or not."""
    type: str = ""
    """For a topic: the expected type, `std_msgs/msg/Float32`; empty: any. For a lifecycle: the
    state, `active`."""
    rate_hz: float = 0.0
    """For a topic: how often messages must arrive; 0: none need to."""
    within_s: float = READY_WITHIN_S


@dataclass(frozen=True)
class NodeSpec:
    """One node: what to run, how, and after which others."""

    name: str
    """Its key in the profile; for a `run` node also its name in the ROS graph."""
    document: NodeDocument
    """Everything the profile says; the fields below hold the results, under the same names."""
    params: Mapping[str, Param]
    """Flattened: `{"limits.front": 0.5}`."""
    needs: tuple[str, ...]
    """Only nodes that run: those excluded by `when` are not waited for."""
    ready: Ready | None
    """By default, a `run` node must be in the graph."""
    cwd: Path | None
    """An absolute path; None: the folder in which the launcher was started."""
    folder: Path = field(compare=False)
    """That of the profile."""

    @property
    def managed(self) -> str:
        """The name in the graph of the node whose lifecycle is meant, absolute or not."""
        ready = self.document.ready
        return self.name if ready is None or ready.node is None else ready.node

    @property
    def command(self) -> str:
        run = self.document.run
        if run is None:
            return " ".join(self.document.exec or ())
        return f"./{os.path.basename(run)}" if "/" in run else run  # noqa: PTH119

    @property
    def is_python(self) -> bool:
        """Whether it is a command that begins with `python`: Deck's own, which knows rclpy."""
        return bool(self.document.exec) and (self.document.exec or ("",))[0] in PYTHONS

    @property
    def is_ours(self) -> bool:
        return self.document.run is not None and node_program.is_ours(self.document.run)

    @property
    def own_file(self) -> str:
        """The user's own Python file that it runs, absolute; empty if it runs none."""
        run = self.document.run
        if run is not None:
            return run if "/" in run else ""
        words = self.document.exec or ()
        if not self.is_python or len(words) < 2 or not words[1].endswith(".py"):
            return ""
        return self._beside(words[1])

    def _beside(self, file: str) -> str:
        """Return the path of a file: as it is meant from the working directory, or the profile."""
        here = os.path.join(self.cwd or os.getcwd(), file)  # noqa: PTH109, PTH118
        beside = os.path.join(self.folder, file)  # noqa: PTH118
        found = here if self.cwd is not None or not os.path.isfile(beside) else beside  # noqa: PTH113
        return os.path.normpath(found)

    def ros_args(self) -> list[str]:
        """Return `--ros-args` and everything after it; empty for a command without parameters."""
        named = ["-r", f"__node:={self.name}"] if self.document.run is not None else []
        remaps = [part for old, new in self.document.remap.items() for part in ("-r", f"{old}:={new}")]
        arguments = [*named, *remaps, *as_arguments(self.params)]
        return ["--ros-args", *arguments] if arguments else []

    def argv(self) -> list[str]:
        """Return the full command line for a start without the spawn server."""
        if self.document.run is not None:
            return [sys.executable, "-u", node_program.__file__, self.document.run, *self.ros_args()]
        words = list(self.document.exec or ())
        if self.own_file:
            words[:2] = [sys.executable, "-u", node_program.__file__, self.own_file]
        elif self.is_python:
            words[0] = sys.executable
        return [*words, *self.ros_args()]


@dataclass(frozen=True)
class Profile:
    """A profile that is ready to be started."""

    path: Path
    """Absolute."""
    name: str
    """File name without its suffix: `09-brain`; of a lesson.yaml, the name of its folder."""
    nodes: Mapping[str, NodeSpec]
    """In file order; only those that run on this hardware."""
    document: ProfileDocument
    """The rest of the profile: title, panels, devices and so on."""
    domain: int
    """The effective domain, wherever it was set."""
    hardware: str
    used: tuple[str, ...] = ()
    """The devices that its nodes refer to, in file order."""
    warnings: tuple[ProfileProblem, ...] = ()
    """Things that are allowed but probably not intended."""
