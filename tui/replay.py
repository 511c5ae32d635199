"""A recording as a session: no nodes, and the panels for which it has topics."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tui.watching import WatchLink

if TYPE_CHECKING:
    from graph.replay import Replay

REPLAY = "replay"
"""What stands in place of the hardware."""
PANELS = {
    "sonar": {"/sensor/sonar_front", "/sensor/sonar_rear"},
    "wheels": {"/wheel_commands", "/joint_states"},
    "camera": {"/camera/color/image_raw"},
    "head": {"/head_state"},
    "voice": {"/audio/mic_raw", "/audio/speaker_raw"},
}
"""Panel to the topics of which it needs one."""


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
                panels=tuple(panel for panel, needed in PANELS.items() if needed & topics),
                foreground=False,
            )
        )
