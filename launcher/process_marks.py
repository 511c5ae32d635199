"""What `ps` and /proc show of a forked node: a title of its own, and its marks.

A forked process keeps the argument and environment areas of the server that it was forked from.
Here it overwrites them in place, so that people and the search for a run's processes see a node
and not a copy of the server. (setproctitle would lay the title over the environment, and with it
over the marks.) The server's command line and `NODE_MARK` leave room for it.
"""

from __future__ import annotations

import ctypes

from launcher.process_table import NODE_MARK
from launcher.process_ties import set_short_name

TITLE_ROOM = 160
"""Bytes that the server's command line must have for titles."""
NODE_ROOM = 255
"""Bytes that the server's `NODE_MARK` must have for names of nodes."""

_ARG_START, _ARG_END, _ENV_START, _ENV_END = range(48, 52)  # fields of /proc/self/stat, proc(5)


def show_as(node: str, title: str) -> None:
    """Make this process appear as `title`, and as belonging to `node`."""
    areas = _areas()
    _write(areas[_ARG_START], areas[_ARG_END], title.encode())
    start, end = areas[_ENV_START], areas[_ENV_END]
    slot = NODE_MARK.encode() + b"=" + b"-" * NODE_ROOM
    at = ctypes.string_at(start, end - start).find(slot)
    if at >= 0:
        value = start + at + len(NODE_MARK) + 1
        _write(value, value + NODE_ROOM + 1, node.encode())
    set_short_name(node)


def _areas() -> dict[int, int]:
    with open("/proc/self/stat", "rb") as file:  # noqa: PTH123 - once per start of a node
        stat = file.read()
    fields = stat[stat.rindex(b")") + 2 :].split()
    return {number: int(fields[number - 3]) for number in range(_ARG_START, _ENV_END + 1)}


def _write(start: int, end: int, text: bytes) -> None:
    """Write `text`, cut if need be, and zeros up to `end`."""
    room = end - start - 1
    if room > 0:
        ctypes.memmove(start, text[:room].ljust(room + 1, b"\0"), room + 1)
