"""Log lines in a short form, to be sent and to be kept."""

from __future__ import annotations

import sys
from typing import Any

from launcher.status import LogLine, Severity
from text.packing import pack_text, unpack_text
from text.sentences import Words


def pack_line(line: LogLine) -> list[Any]:
    """Return a log line as JSON."""
    text = pack_text(line.text) if isinstance(line.text, Words) else line.text
    return [line.node, line.seq, line.time_s, line.severity.rank, text, line.logger, line.source]


_BY_RANK = {severity.rank: severity for severity in Severity}


def unpack_line(fields: list[Any]) -> LogLine:
    """Return the log line that `pack_line` was given."""
    node, seq, time_s, rank, text, logger, source = fields
    # Thousands of lines are kept, and these are the same in most of them.
    node, logger, source = map(sys.intern, (node, logger, source))
    return LogLine(node, seq, time_s, _BY_RANK[rank], unpack_text(text), logger, source)
