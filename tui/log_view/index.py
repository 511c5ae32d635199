"""The lines that a log view keeps, which of them are shown, on which rows, and which are chosen.

Rows are counted from the first shown line. A line takes one row, or as many as its text needs when
it is wrapped. When there are too many lines, the nodes that wrote most lose their oldest ones; a flood
from one node does not push out the lines of others. While somebody reads (`hold`), none of the lines
present are dropped: instead newer lines are, and a mark takes their place.
"""

from __future__ import annotations

import re
import sys
from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter

from rich.cells import cell_len, get_character_cell_size

from launcher.status import LogLine, Severity
from text.i18n import localized
from text.plain import plain
from tui.session.past import KEPT_LINES

LONGEST_TEXT = 16_384
"""Characters kept of one line; the file has the whole line."""
SLACK = 1.25
"""Dropping goes through all lines, so it is done only occasionally, for many at once."""
_OBJECT_BYTES = 130

SAID_BY_DECK = frozenset({"deck", "agent"})
"""The `source` of lines that can be translated."""


@dataclass(slots=True)
class LogEntry:
    """A line, or a mark for missing lines."""

    id: int
    node: str
    rank: int
    time_s: float
    text: str
    """The text without control characters."""
    skipped: int = 0
    """Number of missing lines for a mark; 0 for a line."""

    @property
    def size(self) -> int:
        return sys.getsizeof(self.text) + _OBJECT_BYTES


class LineRing:
    """Lines in order of arrival."""

    def __init__(self, max_lines: int = KEPT_LINES, max_bytes: int = 16 * 2**20) -> None:
        """Keep at most this many lines and bytes, and temporarily a quarter more."""
        self.max_lines, self.max_bytes = max_lines, max_bytes
        self.entries: list[LogEntry] = []
        self.counts: dict[str, list[int]] = {}
        """Lines received so far, by node and rank of the severity; missing ones do not count."""
        self._next_id = 0
        self._held = 0
        self._bytes = 0
        self._last_seq: dict[str, int] = {}

    def append(self, lines: Sequence[LogLine], skipped: Mapping[str, int]) -> list[LogEntry]:
        """Add lines; return them with marks where `seq` or `skipped` shows that any are missing."""
        start = len(self.entries)
        seen: Counter[str] = Counter()
        for line in lines:
            node, seq = line.node, line.seq
            last = self._last_seq.get(node)
            if last is not None and seq > last + 1:
                seen[node] += seq - last - 1
                self._add(node, line.time_s, skipped=seq - last - 1)
            self._last_seq[node] = seq
            rank = line.severity.rank
            self.counts.setdefault(node, [0] * len(Severity))[rank] += 1
            text = localized(line.text) if line.source in SAID_BY_DECK else line.text
            self._add(node, line.time_s, rank, text)
        for node, count in skipped.items():
            missing = count - seen[node]
            if missing > 0:
                if node in self._last_seq:
                    self._last_seq[node] += missing
                now_s = self.entries[-1].time_s if self.entries else 0.0
                self._add(node, now_s, skipped=missing)
        return self.entries[start:]

    def _add(self, node: str, time_s: float, rank: int = 0, text: str = "", skipped: int = 0) -> None:
        if len(text) > LONGEST_TEXT:
            text = f"{text[:LONGEST_TEXT]} … (+{len(text) - LONGEST_TEXT})"
        text = plain(text)
        self.entries.append(LogEntry(self._next_id, node, rank, time_s, text, skipped))
        self._next_id += 1
        self._bytes += self.entries[-1].size

    def clear(self) -> None:
        self.entries.clear()
        self.counts.clear()
        self._last_seq.clear()
        self._held = self._bytes = 0

    def hold(self) -> None:
        """Keep all lines that are present now."""
        self._held = len(self.entries)
        self._bytes = 0

    def release(self) -> None:
        """Allow the oldest lines to be dropped again."""
        self._held = 0
        self._bytes = sum(entry.size for entry in self.entries)

    @property
    def full(self) -> bool:
        """Whether it is time to call `trim`."""
        loose = len(self.entries) - self._held
        return loose > self.max_lines * SLACK or self._bytes > self.max_bytes * SLACK

    def trim(self) -> None:
        """Drop lines of the nodes that wrote most until the limits hold; marks stand for what is held up."""
        loose = self.entries[self._held :]
        sizes: Counter[str] = Counter()
        for entry in loose:
            sizes[entry.node] += entry.size
        over_lines = _surplus(Counter(entry.node for entry in loose), self.max_lines)
        over_bytes = _surplus(sizes, self.max_bytes)
        gaps: Counter[str] = Counter()
        kept: list[LogEntry] = []
        for entry in loose:
            node = entry.node
            if over_lines[node] <= 0 and over_bytes[node] <= 0:
                kept.append(entry)
                continue
            over_lines[node] -= 1
            over_bytes[node] -= entry.size
            gaps[node] += entry.skipped or 1
            if self._held and over_lines[node] <= 0 and over_bytes[node] <= 0:
                kept.append(LogEntry(entry.id, node, 0, entry.time_s, "", gaps[node]))
        self.entries[self._held :] = kept
        self._bytes = sum(entry.size for entry in kept)


def _surplus(amounts: Mapping[str, int], budget: int) -> Counter[str]:
    """How much each exceeds its share: the highest level whose sum of min(amount, level) stays within the budget."""
    level, rest = sys.maxsize, sorted(amounts.values())
    while rest:
        share = budget // len(rest)
        if rest[0] > share:
            level = share
            break
        budget -= rest.pop(0)
    return Counter({name: amount - level for name, amount in amounts.items() if amount > level})


_id_of = attrgetter("id")


_narrow = re.compile("[ -~\xa0-\xac\xae-\u02ff\u0370-\u0482\u048a-\u052f\u2010-\u2027\u2400-\u2421]*").fullmatch
"""Matches texts in which every character takes one cell."""
_EMOJI_STYLE = "\ufe0f"
"""Makes the character before it a wide emoji."""


def folded(text: str, width: int) -> list[str]:
    """Return the text cut into rows of at most `width` cells, and a blank at the end of a row.

    Rows end between words if the row is then at least half full; texts with wide or combining
    characters are cut between any two characters.
    """
    if not _narrow(text):
        return _cut_by_character(text, width)
    pieces: list[str] = []
    at, end = 0, len(text)
    while end - at > width:
        cut = text.rfind(" ", at + width // 2, at + width + 1) + 1 or at + width
        pieces.append(text[at:cut])
        at = cut
    if at < end or not pieces:
        pieces.append(text[at:])
    return pieces


def _cut_by_character(text: str, width: int) -> list[str]:
    """Return rows that are never too wide: each character has its own width, as if none were joined."""
    rows: list[str] = []
    start = used = 0
    for at, character in enumerate(text):
        size = 1 if character == _EMOJI_STYLE else get_character_cell_size(character)
        if used + size > width:
            rows.append(text[start:at])
            start, used = at, 0
        used += size
    return [*rows, text[start:]]


def folded_rows(text: str, width: int) -> int:
    """Return the number of rows that `folded` makes, without making them where possible."""
    if len(text) <= width and _narrow(text):
        return 1
    return len(folded(text, width))


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
        if self.only is not None:
            return node == self.only
        return node not in self.muted

    @property
    def pattern(self) -> re.Pattern[str] | None:
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


class LogIndex:
    """The shown lines in order, the rows that they take, and the matches of a search."""

    def __init__(self, text_of: Callable[[LogEntry], str]) -> None:
        self.text_of = text_of
        self.filter = LogFilter()
        self.fold_width: int | None = None
        """Cells of text in a row; None if lines are not wrapped."""
        self.shown: list[LogEntry] = []
        self.found: list[int] = []
        """Ids of the shown lines that contain the search text."""
        self.longest = 0
        """Cells of the longest text shown, or slightly more."""
        self._ends: list[int] = []

    @property
    def rows(self) -> int:
        if self.fold_width is None:
            return len(self.shown)
        return self._ends[-1] if self._ends else 0

    def extend(self, entries: Sequence[LogEntry]) -> int:
        """Add entries newer than all existing ones; return how many of them are shown."""
        chosen, pattern = self.filter, self.filter.pattern
        find = pattern.search if pattern else None
        visible = {node: chosen.shows_node(node) for node in {entry.node for entry in entries}}
        minimum, only_found = chosen.minimum.rank, chosen.only_found and find is not None
        before = len(self.shown)
        for entry in entries:
            if not visible[entry.node] or (entry.rank < minimum and not entry.skipped):
                continue
            if find and not entry.skipped and find(entry.text):
                self.found.append(entry.id)
            elif only_found:
                continue
            self.shown.append(entry)
        self._measure(self.shown[before:])
        return len(self.shown) - before

    def _measure(self, entries: Sequence[LogEntry]) -> None:
        width, text_of = self.fold_width, self.text_of
        if width is None:
            for entry in entries:
                if len(entry.text) > self.longest or not entry.text.isascii():
                    self.longest = max(self.longest, cell_len(text_of(entry)))
            return
        end, ends = self.rows, self._ends
        for entry in entries:
            end += folded_rows(text_of(entry), width)
            ends.append(end)

    def rebuild(self, entries: Sequence[LogEntry]) -> None:
        self.shown, self.found, self._ends, self.longest = [], [], [], 0
        self.extend(entries)

    def fold(self, width: int | None) -> None:
        self.fold_width, self._ends, self.longest = width, [], 0
        self._measure(self.shown)

    def locate(self, row: int) -> tuple[int, int]:
        """Index in `shown` of the line on this row, and the number of the row within the line."""
        if self.fold_width is None:
            return row, 0
        place = bisect_right(self._ends, row)
        return place, row - self.row_of(place)

    def row_of(self, place: int) -> int:
        if self.fold_width is None or place == 0:
            return place
        return self._ends[place - 1]

    def place_of(self, entry_id: int) -> int:
        """Index in `shown` of this entry, or of the next one that is shown."""
        return bisect_left(self.shown, entry_id, key=_id_of)

    def found_near(self, entry_id: int, step: int) -> int | None:
        """Id of the next match after (`step` 1) or before (-1) this line, wrapping at the ends."""
        if not self.found:
            return None
        if step > 0:
            at = bisect_right(self.found, entry_id)
            return self.found[at % len(self.found)]
        return self.found[bisect_left(self.found, entry_id) - 1]


class LineChoice:
    """A range of the lines in an index, by id; empty until one is chosen."""

    def __init__(self, index: LogIndex) -> None:
        self.cursor: int | None = None
        self._anchor: int | None = None
        self._index = index

    def move(self, entry_id: int, *, extend: bool) -> None:
        """Choose a line; with `extend`, all lines from where the choice began to it."""
        if not extend or self._anchor is None:
            self._anchor = self.cursor if extend and self.cursor is not None else entry_id
        self.cursor = entry_id

    def clear(self) -> None:
        self.cursor = self._anchor = None

    @property
    def _span(self) -> tuple[int, int]:
        if self.cursor is None or self._anchor is None:
            return 0, -1
        return min(self.cursor, self._anchor), max(self.cursor, self._anchor)

    def __contains__(self, entry_id: int) -> bool:
        first, last = self._span
        return first <= entry_id <= last

    @property
    def entries(self) -> Sequence[LogEntry]:
        first, last = self._span
        return self._index.shown[self._index.place_of(first) : self._index.place_of(last + 1)]

    @property
    def node(self) -> str | None:
        return next((entry.node for entry in self.entries if entry.id == self.cursor), None)

    @property
    def found_number(self) -> int:
        """Number of the match at the cursor, from 1; 0 if there is none."""
        found, cursor = self._index.found, self.cursor
        return found.index(cursor) + 1 if cursor in found else 0
