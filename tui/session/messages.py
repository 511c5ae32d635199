"""Events from outside as messages to the screens: the only way in which data reaches widgets.

The app posts them to every screen that has been opened. Textual derives the names of the handlers:
`on_status_changed`, `on_log_arrived`, `on_graph_changed`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from textual.message import Message

if TYPE_CHECKING:
    from graph.data import GraphUpdate
    from launcher.status import LogLine, NodeStatus


class StatusChanged(Message, bubble=False):
    """The status of some nodes has changed."""

    def __init__(self, nodes: Mapping[str, NodeStatus], changed: frozenset[str]) -> None:
        """Carry all `nodes` in the profile's order, and the names of those that `changed`."""
        super().__init__()
        self.nodes = nodes
        self.changed = changed


class LogArrived(Message, bubble=False):
    """Log lines of any nodes, in order of arrival.

    A screen that is opened later gets the earlier lines in its first message.
    """

    def __init__(self, lines: tuple[LogLine, ...], skipped: Mapping[str, int]) -> None:
        """Carry `lines`, and how many of each node were `skipped` since the previous message."""
        super().__init__()
        self.lines = lines
        self.skipped = skipped


class GraphChanged(Message, bubble=False):
    """A new update of the graph; the screen in front gets everything, others what they follow."""

    def __init__(self, update: GraphUpdate) -> None:
        """Carry the newest rows, and every sample since the previous message."""
        super().__init__()
        self.update = update


class PicturesChanged(Message):
    """Other pictures are shown than before: from a widget to the screen around it."""


class SessionChanged(Message, bubble=False):
    """A session was opened or has ended; the feed's `session` says which."""

    def __init__(self, ended: str = "") -> None:
        """Carry the reason if the session has `ended`."""
        super().__init__()
        self.ended = ended


class AgentsChanged(Message, bubble=False):
    """Agents have come or gone, or what they ask for has changed; the feed's `agents` says it."""


class LessonOpened(Message, bubble=False):
    """A profile was started; for the app, which remembers it."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.name = name


class LanguageChanged(Message, bubble=False):
    """All visible text has to be redrawn."""
