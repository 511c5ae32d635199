"""What happens outside, as messages to the screens: the only way in which data reaches widgets.

The app posts them to every screen that has been opened once. Handlers are named as Textual
names them: `on_status_changed`, `on_log_arrived`, `on_graph_changed`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from textual.message import Message

if TYPE_CHECKING:
    from graph.data import GraphUpdate
    from launcher.status import LogLine, NodeStatus


class StatusChanged(Message, bubble=False):
    """The status of nodes has changed."""

    def __init__(self, nodes: Mapping[str, NodeStatus], changed: frozenset[str]) -> None:
        """Tell of all `nodes` in the profile's order, and of those that `changed`."""
        super().__init__()
        self.nodes = nodes
        self.changed = changed


class LogArrived(Message, bubble=False):
    """Lines of any nodes, in the order they came in.

    A screen that is opened later gets what came before in its first message.
    """

    def __init__(self, lines: tuple[LogLine, ...], skipped: Mapping[str, int]) -> None:
        """Carry `lines`, and how many were `skipped` of which node since the message before."""
        super().__init__()
        self.lines = lines
        self.skipped = skipped


class GraphChanged(Message, bubble=False):
    """The ROS graph as it is now; the screen in front gets all, others what they follow."""

    def __init__(self, update: GraphUpdate) -> None:
        """Carry the newest rows, and every sample since the message before."""
        super().__init__()
        self.update = update


class SessionChanged(Message, bubble=False):
    """A session was opened, or it has ended; the feed's `session` tells which."""

    def __init__(self, ended: str = "") -> None:
        """Carry the reason if it has `ended`."""
        super().__init__()
        self.ended = ended


class LanguageChanged(Message, bubble=False):
    """Every visible text is to be redrawn."""
