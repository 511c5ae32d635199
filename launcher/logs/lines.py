"""The lines of a node's output: split from the bytes of a pipe, made safe to show, given a severity.

Any chunks, any length, redrawn progress bars. Of control sequences none survives: colours are dropped
(they give the severity of a line that has no other sign of it), and so is the "erase to end of line" of
progress bars. Every other escape sequence stays and becomes visible. None reaches into the next line.

The format of severities is the default of rcutils, `[{severity}] [{time}] [{name}]: {message}`. Following
lines without this prefix belong to the same message if they arrive at once; Python tracebacks are errors
up to their last line; the usual severity words of other programs are understood.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from launcher.status import Severity
from text.plain import plain

MAX_LINE_BYTES = 32 * 1024
"""A longer line is cut; the log file has all of it."""

_ERASE = b"\x1b[K"
_NO_LETTERS = bytes(code for code in range(128) if not chr(code).isalpha())

IDLE_S = 1.0
"""An unfinished line is shown after this time: it is a prompt or a progress bar."""


@dataclass(frozen=True)
class RawLine:
    """One line as its process wrote it, without the line end."""

    data: bytes
    lost: int = 0
    """Bytes that were cut from its end."""


class LineAssembler:
    """The lines of one stream; holds at most twice `MAX_LINE_BYTES` and one chunk.

    A carriage return starts the line again. The text before it becomes a line of its own, unless
    the text after it has the same words with other numbers: of a progress bar the newest state is
    enough.
    """

    def __init__(self) -> None:
        self._rest = b""
        self._lost = 0
        self._waits_since = 0.0
        self._state: RawLine | None = None
        """The text before the newest carriage return."""
        self._words = ""

    @property
    def unfinished(self) -> bool:
        return bool(self._rest) or self._state is not None

    def feed(self, chunk: bytes, now: float) -> list[RawLine]:
        """Take a chunk that was read at `now`; return the lines that it completes."""
        if self._state is None:
            self._waits_since = now
        *ended, self._rest = (self._rest + chunk).split(b"\n")
        done = [line for whole in ended for line in self._ended(whole)]
        *states, self._rest = self._rest.split(b"\r")
        done += self._rewritten(states)
        if len(self._rest) > MAX_LINE_BYTES:
            self._lost += len(self._rest) - MAX_LINE_BYTES
            self._rest = self._rest[:MAX_LINE_BYTES]
        return done

    def flush(self, now: float, *, at_end: bool = False) -> list[RawLine]:
        """Return the unfinished line if it is older than `IDLE_S`, or if the stream is `at_end`.

        Text that is added to it later becomes a line of its own.
        """
        if not self.unfinished or (now - self._waits_since < IDLE_S and not at_end):
            return []
        self._waits_since = now
        if at_end:
            line, self._rest = self._rest, b""
            return self._ended(line)
        if self._state is not None:
            # The text after it may be half of the next state.
            state, self._state = self._state, None
            return [state]
        keep = len(self._rest) - _half_character(self._rest)
        line, self._rest = self._rest[:keep], self._rest[keep:]
        return [self._line(line)] if line else []

    def _ended(self, line: bytes) -> list[RawLine]:
        """Return a finished line, preceded by those that carriage returns split off from it."""
        if self._state is None and b"\r" not in line:
            return [self._line(line)]
        states = line.split(b"\r")
        done = self._rewritten(states)
        last, self._state = self._state, None
        return [*done, last or self._line(states[-1])]

    def _rewritten(self, states: list[bytes]) -> list[RawLine]:
        """Take the successive states of a line; return those that are not replaced as progress."""
        done: list[RawLine] = []
        for state in states:
            if state.replace(_ERASE, b"").strip():
                words = _words(state)
                if self._state is not None and words != self._words:
                    done.append(self._state)
                self._state, self._words = self._line(state), words
        return done

    def _line(self, line: bytes) -> RawLine:
        lost, self._lost = self._lost, 0
        if len(line) > MAX_LINE_BYTES:
            lost += len(line) - MAX_LINE_BYTES
            line = line[:MAX_LINE_BYTES]
        return RawLine(line, lost)


def _words(state: bytes) -> str:
    """Return the letters only: a progress bar changes numbers, bars and blanks."""
    if state.isascii():
        return state.translate(None, _NO_LETTERS).decode()
    return "".join(filter(str.isalpha, state.decode(errors="replace")))


def _half_character(data: bytes) -> int:
    """Return how many bytes at the end are the beginning of a UTF-8 character, 0 to 3."""
    for back in range(1, min(3, len(data)) + 1):
        byte = data[-back]
        if byte >= 0xC0:
            length = 2 if byte < 0xE0 else 3 if byte < 0xF0 else 4
            return back if back < length else 0
        if byte < 0x80:
            return 0
    return 0


_COLOUR = re.compile(r"\x1b\[([0-9;:]*)m")
_ERASED = re.compile(r"\x1b\[[012]?K")
_COLOURS = {"31": Severity.ERROR, "91": Severity.ERROR, "33": Severity.WARN, "93": Severity.WARN}


def plain_text(data: bytes) -> tuple[str, Severity | None]:
    """Return a line's text, and the severity that its colour suggests, if any."""
    text = data.decode(errors="replace")
    severity = None
    if "\x1b" in text:
        severity = _suggested(text)
        text = _ERASED.sub("", _COLOUR.sub("", text))
    if "\t" in text:
        text = text.expandtabs(8)
    return plain(text), severity


def _suggested(text: str) -> Severity | None:
    for sequence in _COLOUR.finditer(text):
        for part in sequence.group(1).replace(":", ";").split(";"):
            if part in _COLOURS:
                return _COLOURS[part]
    return None


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
