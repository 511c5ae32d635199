"""What starts a node of the session from a shell."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from launcher.errors import LauncherError
from text import ros2_words

if TYPE_CHECKING:
    from launcher.status import NodeStatus, SessionInfo


async def node_command(session: SessionInfo, node: NodeStatus) -> str:
    """Return the command line that runs this node as the session does."""
    if not node.command.startswith("nodes.") and not node.file:
        return node.command
    ros_args = await asyncio.to_thread(_ros_args, session, node.name)
    if node.file:
        return ros2_words.run_file(node.file, ros_args)
    return ros2_words.run(node.command, ros_args)


def _ros_args(session: SessionInfo, node: str) -> list[str]:
    """Return `--ros-args` of a node and what follows, as the profile has it now."""
    # Not needed for the first frame.
    from launcher.profile.load import load_profile

    try:
        profile = load_profile(session.profile, hardware=session.hardware)
    except (LauncherError, OSError):
        return ["--ros-args", "-r", f"__node:={node}"]
    return next((spec.ros_args() for spec in profile.nodes.values() if spec.name == node), [])
