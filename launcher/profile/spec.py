"""The result of loading a profile: plain data that can be started."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING

from launcher import node_program
from launcher.profile.defaults import READY_WITHIN_S
from launcher.profile.params import as_arguments

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from launcher.errors import ProfileProblem
    from launcher.profile.defaults import READY_WITHIN_S
    from launcher.profile.model import NodeDocument, ProfileDocument
from launcher.profile.params import Param


@dataclass(frozen=True)
class Ready:
    """The condition under which a node counts as ready."""

    kind: str
    """`topic`, `service` or `node`."""
    name: str
    """As in the profile: a ROS name, absolute or not."""
    type: str = ""
    """Of a topic: the type awaited, `std_msgs/msg/Float32`; empty: any."""
    rate_hz: float = 0.0
    """Of a topic: how often messages must come; 0: none need come."""
    within_s: float = READY_WITHIN_S


@dataclass(frozen=True)
class NodeSpec:
    """One node: what to run, how, and after which others."""

    name: str
    """Its key in the profile; of a `run` node also its name in the ROS graph."""
    document: NodeDocument
    """All that the profile says; what it comes to here stands below, by the same names."""
    params: Mapping[str, Param]
    """Flat: `{"limits.front": 0.5}`."""
    needs: tuple[str, ...]
    """Only nodes that run: those that `when` leaves out are not waited for."""
    ready: Ready | None
    """For `run`, if nothing is said, that the node is in the graph."""
    cwd: Path | None
    """Absolute; None: where the launcher was started."""

    @property
    def command(self) -> str:
        """What is run, for people."""
        run = self.document.run
        if run is None:
            return " ".join(self.document.exec or ())
        return f"./{os.path.basename(run)}" if "/" in run else run  # noqa: PTH119

    def ros_args(self) -> list[str]:
        """Return `--ros-args` and all that follows; empty for a command without parameters."""
        named = ["-r", f"__node:={self.name}"] if self.document.run is not None else []
        remaps = [
            part for old, new in self.document.remap.items() for part in ("-r", f"{old}:={new}")
        ]
        arguments = [*named, *remaps, *as_arguments(self.params)]
        return ["--ros-args", *arguments] if arguments else []

    def argv(self) -> list[str]:
        """Return the full command line, as it is started without the spawn server."""
        if self.document.run is not None:
            return [
                sys.executable,
                "-u",
                node_program.__file__,
                self.document.run,
                *self.ros_args(),
            ]
        return [*(self.document.exec or ()), *self.ros_args()]


@dataclass(frozen=True)
class Profile:
    """A profile as it is about to be started."""

    path: Path
    """Absolute."""
    name: str
    """File name without its ending: `09-brain`."""
    nodes: Mapping[str, NodeSpec]
    """In the order of the file; only those that run on this hardware."""
    document: ProfileDocument
    """All else that it says: title, panels, devices and so on."""
    domain: int
    """The one that counts, whoever chose it."""
    hardware: str
    used: tuple[str, ...] = ()
    """The devices that its nodes name, in the order of the file."""
    warnings: tuple[ProfileProblem, ...] = ()
    """What is allowed, and probably not meant."""
