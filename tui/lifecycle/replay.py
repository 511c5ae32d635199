"""A recording as a session: no nodes, and the panels for which it has topics."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tui.panels.registry import panels_for
from tui.session.watching import WatchLink

if TYPE_CHECKING:
    from graph.replay.replay import Replay

REPLAY = "replay"
"""What stands in place of the hardware."""


class ReplayLink(WatchLink):
    """Fits the seam of a session; there is nothing to start, stop or restart."""

    def __init__(self, replay: Replay) -> None:
        """`replay` is played by whoever observes the session."""
        from launcher.status import SessionInfo

        self.replay = replay
        bag = replay.bag
        topics = {topic.name for topic in bag.topics}
        super().__init__(
            SessionInfo(
                run_id=REPLAY,
                profile=str(bag.path),
                name=bag.name,
                title={"en": bag.name},
                hardware=REPLAY,
                panels=panels_for(topics),
                foreground=False,
            )
        )
