"""Parsing a log line: its severity, time and logger.

The format is the default of rcutils, `[{severity}] [{time}] [{name}]: {message}`. Following lines
without this prefix belong to the same message if they arrive at once; Python tracebacks are errors
up to their last line; the usual severity words of other programs are understood.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from launcher.status import Severity

_STAMPED = re.compile(r"\[(DEBUG|INFO|WARN|ERROR|FATAL)\] \[(\d{1,12}\.\d{1,9})\] \[([^\]]*)\]: ?(.*)", re.DOTALL)
_SEVERITIES = {severity.name: severity for severity in Severity}
_WORD = re.compile(
    r"\W*(DEBUG|INFO|WARN|WARNING|ERROR|CRITICAL|FATAL)(?=[\]:| ])"
    r"|\d{4}-\d\d-\d\d .{0,80}?\b(Warning|Error)\]"
)
_WORDS = {
    **_SEVERITIES,
    "WARNING": Severity.WARN,
    "CRITICAL": Severity.FATAL,
    "Warning": Severity.WARN,
    "Error": Severity.ERROR,
}
NEXT_PORT = "open_and_lock_file failed"
"""Fast DDS finds a port of its shared memory taken, and takes the next one: its log calls that an
error. On a busy machine somebody has removed the file of a port whose owner was silent for 1 s;
then each start of a node says so (open_port_internal in SharedMemGlobal.hpp of Fast DDS 2.14)."""
_TRACEBACK = "Traceback (most recent call last):"
_BETWEEN_TRACEBACKS = ("During handling of the above", "The above exception was the direct")

AT_ONCE_S = 0.05
LATEST_S = 4102444800.0
"""The year 2100: a later stamp is not from a wall clock."""
EARLIEST_S = 946684800.0
"""The year 2000: an earlier stamp is from a simulation."""


@dataclass(frozen=True)
class Parsed:
    """What a line of a node's output says, without the prefix of rcutils."""

    severity: Severity
    text: str
    time_s: float
    logger: str = ""


class SeverityParser:
    """Parses the lines of one stream, one after the other."""

    def __init__(self) -> None:
        self._message: tuple[Severity, str] | None = None
        self._read_at = float("-inf")
        self._in_traceback = False

    def parse(self, text: str, read_at: float, suggested: Severity | None = None) -> Parsed:
        """Parse a line that was read at unix time `read_at`.

        `suggested`: the severity that its colour suggests.
        """
        late = read_at - self._read_at > AT_ONCE_S
        self._read_at = read_at
        stamped = _STAMPED.match(text) if text[:1] == "[" else None
        if stamped is not None:
            name, stamp, logger, message = stamped.groups()
            time_s = float(stamp)
            if not EARLIEST_S < time_s < LATEST_S:
                time_s = read_at
            self._in_traceback = False
            self._message = (_SEVERITIES[name], logger)
            return Parsed(_SEVERITIES[name], message, time_s, logger)
        if late:
            self._message = None
        if NEXT_PORT in text:
            return Parsed(Severity.DEBUG, text, read_at)
        severity, logger = self._unstamped(text, suggested)
        return Parsed(severity, text, read_at, logger)

    def _unstamped(self, text: str, suggested: Severity | None) -> tuple[Severity, str]:
        if _TRACEBACK in text:
            self._in_traceback = True
            return Severity.ERROR, ""
        if self._in_traceback:
            # The first line that is not indented names the exception and ends the traceback.
            self._in_traceback = not text.strip() or text.startswith((" ", *_BETWEEN_TRACEBACKS))
            if not self._in_traceback:
                self._message = (Severity.ERROR, "")
            return Severity.ERROR, ""
        if suggested is not None:
            return suggested, ""
        word = _WORD.match(text)
        if word is not None:
            return _WORDS[word.group(1) or word.group(2)], ""
        if text.startswith(_BETWEEN_TRACEBACKS):
            self._in_traceback = True
            return Severity.ERROR, ""
        return self._message or (Severity.INFO, "")
