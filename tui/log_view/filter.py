"""Which lines of a log are shown: by node, by severity, by text."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from launcher.status import Severity


@dataclass(frozen=True)
class LogFilter:
    """A choice of lines. It never changes: every change of mind is a new one."""

    muted: frozenset[str] = frozenset()
    """Nodes whose lines are left out, unless one node is listened to alone."""
    only: str | None = None
    """The one node that is listened to; all others are mute."""
    minimum: Severity = Severity.DEBUG
    search: str = ""
    """Text to be found, in any case of its letters; empty finds nothing."""
    only_found: bool = False
    """Whether lines without that text are left out."""

    def shows_node(self, node: str) -> bool:
        """Whether lines of this node are shown at all."""
        if self.only is not None:
            return node == self.only
        return node not in self.muted

    @property
    def pattern(self) -> re.Pattern[str] | None:
        """What finds the text to be found; None if there is none."""
        return re.compile(re.escape(self.search), re.IGNORECASE) if self.search else None

    def toggled(self, node: str) -> LogFilter:
        """Mute this node, or let it speak again; listening to one alone ends with it."""
        return replace(self, muted=self.muted ^ {node}, only=None)

    def alone(self, node: str) -> LogFilter:
        """Mute all but this node; asked again for the same, back to what was muted before."""
        return replace(self, only=None if self.only == node else node)

    def all_nodes(self) -> LogFilter:
        """Let every node speak."""
        return replace(self, muted=frozenset(), only=None)

    def next_minimum(self) -> LogFilter:
        """Raise the lowest severity shown by one; after the highest comes the lowest."""
        levels = list(Severity)
        return replace(self, minimum=levels[(self.minimum.rank + 1) % len(levels)])
