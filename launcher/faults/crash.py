"""Reading what a process has printed, where it has told nothing itself: its last traceback."""

from __future__ import annotations

import linecache
import os
import re
from typing import TYPE_CHECKING

from launcher.faults.meanings import warning_of
from launcher.faults.rules.ros import UNHEARD
from launcher.faults.stuck import MENDS, STILL_RUNS
from launcher.status import NodeFault
from text.plain import plain
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Sequence

_BLOCKED = re.compile(
    r"(?:callback|обработчик) (?P<name>\S+) (?:still runs after|не закончил и через) "
    r"(?P<seconds>[\d.]+) [sс](?: (?:in|в) (?P<waits_in>\w+))?: "
    r"(?P<file>.+), (?:line|строка) (?P<line>\d+)"
)
"""What `launcher.callback_watch` writes."""
_UNHEARD = re.compile(r"(?P<words>nothing fills this buffer), .*: asked in (?P<file>.+), line (?P<line>\d+)")
"""What the Buffer of `bridges/tf2_ros` writes."""
BEGIN = "Traceback (most recent call last):"
_FRAME = re.compile(r'^\s*File "(.+)", line (\d+)(?:, in .*)?$')
_EXCEPTION = re.compile(r"^[A-Za-z_][\w.]*(?:Error|Exception|Interrupt|Exit|Warning)(: .*)?$")
_LONG_NUMBER = re.compile(r"(\d{4})\d{30,}(\.\d+)?")
"""Such as the limits of a float64, written out, that rclpy puts into its sentence on a list."""


def crash_of(lines: Sequence[str], folder: str) -> NodeFault | None:
    """Return the fault that the last traceback among these lines tells of, None if there is none.

    Of its frames, the last one in a file of this folder counts, else the last one.
    """
    starts = [number for number, line in enumerate(lines) if line.strip() == BEGIN]
    syntax = _syntax_without_traceback(lines)
    begin = starts[-1] if starts else syntax
    if begin is None:
        return None
    frames: list[tuple[str, int, str]] = []
    for number in range(begin, len(lines)):
        found = _FRAME.match(lines[number])
        if found:
            source = lines[number + 1].strip() if number + 1 < len(lines) else ""
            frames.append((found[1], int(found[2]), source))
    exception = _exception(lines[begin:])
    if not frames or not exception:
        return None
    own = [frame for frame in frames if os.path.dirname(frame[0]) == folder] or frames  # noqa: PTH120
    file, line, source = own[-1]
    kind = "syntax" if exception.startswith(("SyntaxError", "Indentation", "TabError")) else "crash"
    return NodeFault(kind, file, line=line, source_line=source, exception=exception)


def warning_in(line: str, file: str) -> NodeFault | None:
    """Return the mistake in this file that a line of the log tells of while the node runs."""
    blocked = _BLOCKED.fullmatch(line)
    if blocked:
        where, number = blocked["file"], int(blocked["line"])
        words = say(STILL_RUNS, name=blocked["name"], seconds=blocked["seconds"])
        source = linecache.getline(where, number).strip()
        linecache.clearcache()
        mend = MENDS.get(blocked["waits_in"] or "", MENDS[""])
        return NodeFault("warning", where, number, 0, plain(source), words, say(mend))
    unheard = _UNHEARD.fullmatch(line)
    if unheard:
        where, number = unheard["file"], int(unheard["line"])
        source = linecache.getline(where, number).strip()
        linecache.clearcache()
        return NodeFault("warning", where, number, 0, plain(source), unheard["words"], say(UNHEARD))
    meaning = warning_of(line)
    return NodeFault("warning", file, exception=line, meaning=meaning) if meaning else None


def _syntax_without_traceback(lines: Sequence[str]) -> int | None:
    """Return where a syntax error begins that Python reports without `Traceback`."""
    for number in range(len(lines) - 1, -1, -1):
        if lines[number].startswith(("SyntaxError", "IndentationError", "TabError")):
            for above in range(number, -1, -1):
                if _FRAME.match(lines[above]):
                    return above
    return None


def _exception(lines: Sequence[str]) -> str:
    """Return the line that names the exception, which other lines may follow."""
    found = [line.strip() for line in lines if _EXCEPTION.match(line)]
    return _LONG_NUMBER.sub(r"\1…", found[-1]) if found else ""
