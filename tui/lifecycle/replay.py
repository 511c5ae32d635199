"""A recording as a session: no nodes, and the panels that its topics can fill."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launcher.profile.panels import panels_for
from tui.session.watching import NodelessLink

if TYPE_CHECKING:
    from graph.replay.replay import Replay

REPLAY = "replay"
"""Shown in place of the hardware."""


def replayed(replay: Replay) -> NodelessLink:
    """Return the session of a recording, which its observer plays."""
    from launcher.status import SessionInfo

    bag = replay.bag
    session = SessionInfo(
        run_id=REPLAY,
        profile=str(bag.path),
        name=bag.name,
        title={"en": bag.name},
        hardware=REPLAY,
        panels=panels_for({topic.name for topic in bag.topics}),
        foreground=False,
    )
    return NodelessLink(session)
