"""The newest log lines of a session, for screens that are opened later."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from launcher.status import LogLine

KEPT_LINES = 2000
"""As many as a log view shows: a screen has several, and is to take no more memory after hours."""
KEPT_CHARACTERS = 8_000_000


class LogHistory:
    """Lines in order of arrival, limited in number and in characters."""

    def __init__(self, lines: int = KEPT_LINES, characters: int = KEPT_CHARACTERS) -> None:
        self._lines: deque[LogLine] = deque()
        self._most_lines = lines
        self._most_characters = characters
        self._characters = 0

    def add(self, lines: Iterable[LogLine]) -> None:
        """Append lines, and drop the oldest ones beyond the limits."""
        for line in lines:
            self._lines.append(line)
            self._characters += len(line.text)
        while len(self._lines) > self._most_lines or self._characters > self._most_characters:
            self._characters -= len(self._lines.popleft().text)

    def __len__(self) -> int:
        return len(self._lines)

    def all(self) -> tuple[LogLine, ...]:
        """Return the stored lines, oldest first."""
        return tuple(self._lines)

    def clear(self) -> None:
        self._lines.clear()
        self._characters = 0
