"""Turning the bytes of a line into text that is safe to show: no control sequence survives.

Colours are dropped (they give the severity of a line that has no other sign of it), and so is the
"erase to end of line" of progress bars. Every other escape sequence stays and becomes visible: its
escape character is replaced by a picture character, as all control characters are. No sequence,
finished or not, reaches into the next line.
"""

from __future__ import annotations

import re

from launcher.status import Severity
from text.plain import plain

_COLOUR = re.compile(r"\x1b\[([0-9;:]*)m")
_ERASE = re.compile(r"\x1b\[[012]?K")
_COLOURS = {"31": Severity.ERROR, "91": Severity.ERROR, "33": Severity.WARN, "93": Severity.WARN}


def plain_text(data: bytes) -> tuple[str, Severity | None]:
    """Return a line's text, and the severity that its colour suggests, if any."""
    text = data.decode(errors="replace")
    severity = None
    if "\x1b" in text:
        severity = _suggested(text)
        text = _ERASE.sub("", _COLOUR.sub("", text))
    if "\t" in text:
        text = text.expandtabs(8)
    return plain(text), severity


def _suggested(text: str) -> Severity | None:
    for sequence in _COLOUR.finditer(text):
        for part in sequence.group(1).replace(":", ";").split(";"):
            if part in _COLOURS:
                return _COLOURS[part]
    return None
