"""Which lines of a log are shown: by node, severity and text."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from launcher.status import Severity


@dataclass(frozen=True)
class LogFilter:
    """Selects lines. It is immutable: every change returns a new one."""

    muted: frozenset[str] = frozenset()
    """Nodes whose lines are hidden, unless only one node is shown."""
    only: str | None = None
    """The only node that is shown; all others are muted."""
    minimum: Severity = Severity.DEBUG
    search: str = ""
    """Text to search for, ignoring case; if empty, there are no matches."""
    only_found: bool = False
    """Whether lines without that text are hidden."""

    def shows_node(self, node: str) -> bool:
        """Whether lines of this node are shown at all."""
        if self.only is not None:
            return node == self.only
        return node not in self.muted

    @property
    def pattern(self) -> re.Pattern[str] | None:
        """The pattern for the search text; None if there is none."""
        return re.compile(re.escape(self.search), re.IGNORECASE) if self.search else None

    def toggled(self, node: str) -> LogFilter:
        """Mute this node, or unmute it; this also ends showing a single node."""
        return replace(self, muted=self.muted ^ {node}, only=None)

    def alone(self, node: str) -> LogFilter:
        """Show only this node; if called again for it, restore the previous state."""
        return replace(self, only=None if self.only == node else node)

    def all_nodes(self) -> LogFilter:
        return replace(self, muted=frozenset(), only=None)

    def next_minimum(self) -> LogFilter:
        """Raise the lowest severity shown by one level; after the highest comes the lowest."""
        levels = list(Severity)
        return replace(self, minimum=levels[(self.minimum.rank + 1) % len(levels)])
