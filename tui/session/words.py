"""A session and its nodes in words: its hardware, who has started it, and what starts a node from a shell."""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING

from launcher.errors import LauncherError
from text import ros2_words
from text.i18n import N_, _, localized
from text.plain import plain

if TYPE_CHECKING:
    from launcher.status import NodeStatus, SessionInfo


WORDS = {"mock": N_("mock"), "real": N_("real")}
"""The values of `--hardware`."""


def hardware_words(hardware: str) -> str:
    """Return `mock` or `real` in the current language; anything else unchanged."""
    return _(WORDS[hardware]) if hardware in WORDS else plain(hardware)


def started_words(session: SessionInfo) -> str:
    """Say who has started a session, where and when."""
    from launcher.processes.owner import who_words

    who = plain(localized(who_words(session.started_by)), 200)
    since = time.strftime("%H:%M", time.localtime(session.since_s))
    if session.foreground:
        return _("On another screen: {who}, since {since}").format(who=who, since=since)
    return _("In the background, started by {who} at {since}").format(who=who, since=since)


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
