"""The logs of one session: the nodes' output, and the supervisor's own lines about them."""

from __future__ import annotations

import heapq
import sys
import time
from collections.abc import Callable, Iterable
from typing import Any

from launcher.faults.telling import told_in
from launcher.logs.files import LogFiles
from launcher.logs.lines import RawLine, SeverityParser, plain_text
from launcher.logs.reader import PipeReader
from launcher.logs.ring import LogRing
from launcher.status import LogLine, Severity
from text.plain import plain
from text.sentences import say

DECK = "deck"
"""The node name under which the supervisor logs about itself, and the `source` of its lines."""
AGENT = "agent"
"""The same of what is said about agents."""
CRASH_LINES = 400
"""As many lines as the traceback of a crash, and what is printed after it, may have."""


class SessionLog:
    """Rings and files of all nodes."""

    def __init__(self, nodes: Iterable[str], files: LogFiles, on_line: Callable[[], None]) -> None:
        """`on_line` is called whenever there is a new line."""
        self.rings = {name: LogRing() for name in (DECK, AGENT, *nodes)}
        self._files = files
        self._on_line = on_line
        self.heard: Callable[[LogLine], None] = lambda _line: None
        """Called with each line that a node has written."""
        self.told: Callable[[str, dict[str, Any]], None] = lambda _node, _told: None
        """Called with what a node's program tells the supervisor, which is no line of its log."""

    def read(self, node: str, fd: int, source: str) -> PipeReader:
        """Read a node's pipe to its end; `source` is `stdout` or `stderr`."""
        parser = SeverityParser()

        def take(lines: list[RawLine]) -> None:
            self._take(node, source, parser, lines)

        return PipeReader(fd, lambda data: self._files.write(node, data), take)

    def say(self, node: str, severity: Severity, words: str) -> None:
        """Add a line from the supervisor about a node, itself (`DECK`) or an agent (`AGENT`)."""
        now = time.time()
        ring, source = self.rings[node], AGENT if node == AGENT else DECK
        ring.append(LogLine(node, ring.last_seq + 1, now, severity, words, "", source))
        stamped = f"[{severity.name}] [{now:.9f}] [{source}]: {plain(words)}\n"
        self._files.write(node, stamped.encode(errors="backslashreplace"))
        self._on_line()

    def last_words(self, node: str) -> str:
        """Return the node's own last line that tells why it ended, empty if there is none.

        That is the last error among its newest lines, else its last line.
        """
        lines = [line for line in self.rings[node].newest(200) if line.source != DECK and line.text]
        errors = [line for line in lines if line.severity.rank >= Severity.ERROR.rank]
        return (errors or lines)[-1].text if lines else ""

    def since_start(self, node: str) -> list[LogLine]:
        """Return the newest lines that the node's own last process has written."""
        lines: list[LogLine] = []
        for line in reversed(self.rings[node].newest(CRASH_LINES)):
            if line.source == DECK:
                if lines:
                    break
                continue
            lines.append(line)
        return lines[::-1]

    def newest(self, node: str | None, limit: int) -> list[LogLine]:
        """Return the newest lines of one node, or of all nodes in order of time; oldest first."""
        if node is not None:
            return self.rings[node].newest(limit)
        newest = [ring.newest(limit) for ring in self.rings.values()]
        return list(heapq.merge(*newest, key=lambda line: line.time_s))[-limit:] if limit else []

    def _take(self, node: str, source: str, parser: SeverityParser, lines: list[RawLine]) -> None:
        now = time.time()
        ring = self.rings[node]
        for raw in lines:
            data, told = told_in(raw.data)
            if told is not None:
                self.told(node, told)
                if not data.strip():
                    continue
            text, suggested = plain_text(data)
            parsed = parser.parse(text, now, suggested)
            shown = parsed.text
            if raw.lost:
                shown += say(" … [{count} more bytes, see the log file]", count=raw.lost)
            line = LogLine(
                node, ring.last_seq + 1, parsed.time_s, parsed.severity, shown, sys.intern(parsed.logger), source
            )
            ring.append(line)
            self.heard(line)
        self._on_line()
