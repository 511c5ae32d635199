"""One row of the log as a strip, with matches, chosen lines and the mouse selection highlighted.

The columns in front of the text stay in place when long lines are shifted sideways.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.selection import Selection
from textual.strip import Strip

from launcher.status import Severity
from tui.log_view.index import folded
from tui.log_view.palette import Palette
from tui.log_view.ring import LogEntry
from tui.log_view.rows import LogColumns, gutter_texts

Span = tuple[int, int, Style]
CHOSEN, MORE = "▌", "›"


@dataclass(frozen=True)
class RowPainter:
    """Draws rows at one width, in one theme.

    Every character carries its position for the mouse: the entry's id, and how many characters of
    `gutter + text` come before it. So a selection stays with its lines whatever moves them.
    """

    palette: Palette
    columns: LogColumns
    width: int
    """Cells of the text."""
    shift: int
    """Cells that the text is shifted by; wrapped lines are not shifted."""
    fold: bool
    pattern: re.Pattern[str] | None

    def row(
        self, entry: LogEntry, part: int, text: str, node_style: Style, selection: Selection | None, *, chosen: bool
    ) -> Strip:
        """Row number `part` of an entry, with matches and the mouse selection."""
        under = self.palette.cursor if chosen else Style()
        lead = self._gutter(entry, node_style, under)
        if chosen and not part:
            lead[0] = Segment(CHOSEN + lead[0].text[1:], lead[0].style)
        lead_length = sum(len(segment.text) for segment in lead)
        start, piece, more = self._piece(text, part)
        spans: list[Span] = []
        if self.pattern and not entry.skipped:
            found = self.palette.found
            spans = [(*match.span(), found) for match in self.pattern.finditer(text)]
        selected = selection.get_span(entry.id) if selection else None
        if selected is not None:
            first, last = selected
            last = lead_length + len(text) if last < 0 else last
            spans.append((first - lead_length, last - lead_length, self.palette.selection))
            if not part:
                lead = _laid_over(lead, (first, last, self.palette.selection))
        places = [(first - start, last - start, style) for first, last, style in spans]
        body = painted(piece, self._text_style(entry) + under, places)
        if part:
            blank = (CHOSEN if chosen else " ").ljust(self.columns.gutter)
            gutter = Strip([Segment(blank, self.palette.muted + under)])
        else:
            gutter = Strip(lead).apply_offsets(0, entry.id)
        strips = [gutter, Strip(body).apply_offsets(lead_length + start, entry.id)]
        if more:
            strips.append(Strip([Segment(MORE, self.palette.muted + under)]))
        width = self.columns.gutter + self.width
        return Strip.join(strips).extend_cell_length(width, self.palette.base + under)

    def _gutter(self, entry: LogEntry, node_style: Style, under: Style) -> list[Segment]:
        when, word, node = gutter_texts(entry, self.columns)
        muted, node_style = self.palette.muted + under, node_style + under
        if entry.skipped or entry.rank <= Severity.INFO.rank:
            segments = [Segment(when + word, muted), Segment(node, node_style)]
        else:
            severity = self.palette.severities[entry.rank] + under
            segments = [Segment(when, muted), Segment(word[:-1], severity)]
            segments += [Segment(word[-1:], muted), Segment(node, node_style)]
        return [segment for segment in segments if segment.text]

    def _text_style(self, entry: LogEntry) -> Style:
        if entry.skipped:
            return self.palette.marker
        if entry.rank == Severity.DEBUG.rank:
            return self.palette.muted
        if not self.columns.word and entry.rank > Severity.INFO.rank:
            return self.palette.severities[entry.rank]
        return self.palette.base

    def _piece(self, text: str, part: int) -> tuple[int, str, bool]:
        """The start of the row's piece in the text, the piece, and whether more is cut off."""
        if self.fold:
            pieces = folded(text, self.width)
            part = min(part, len(pieces) - 1)
            return sum(map(len, pieces[:part])), pieces[part], False
        if text.isascii():
            rest = text[self.shift :]
            more = len(rest) > self.width
            return self.shift, rest[: self.width - more], more
        more = cell_len(text) > self.shift + self.width
        whole = Strip([Segment(text)])
        start = len(whole.crop(0, self.shift).text)
        return start, whole.crop(self.shift, self.shift + self.width - more).text, more


def _laid_over(segments: Iterable[Segment], span: Span) -> list[Segment]:
    """Segments with a style applied to a part of their combined text."""
    laid: list[Segment] = []
    at = 0
    start, end, over = span
    for text, style, _control in segments:
        laid += painted(text, style or Style(), [(start - at, end - at, over)])
        at += len(text)
    return laid


def painted(text: str, style: Style, spans: Iterable[Span]) -> list[Segment]:
    """The text as segments, with other styles applied to parts of it; later ones win."""
    marks = [(max(0, start), min(len(text), end), over) for start, end, over in spans]
    marks = [mark for mark in marks if mark[0] < mark[1]]
    if not marks:
        return [Segment(text, style)] if text else []
    cuts = sorted({0, len(text), *(mark[0] for mark in marks), *(mark[1] for mark in marks)})
    segments: list[Segment] = []
    for start, end in pairwise(cuts):
        piece = style
        for first, last, over in marks:
            if first <= start and end <= last:
                piece += over
        segments.append(Segment(text[start:end], piece))
    return segments
