"""What `ps` and /proc show for a forked process: its own title and its marks.

A forked process keeps the argument and environment areas of the process it was forked from. Here it
overwrites them in place, so that people, and the search for a run's processes, see a node and not a
copy of the supervisor. (setproctitle would write the title over the environment, and so over the
marks.) The program that such processes are forked from must be started with spare room:
`ROOM_ARGUMENT` and `room_for_marks`.
"""

from __future__ import annotations

import ctypes

from launcher.processes.table import NODE_MARK, RUN_MARK, SUPERVISOR_MARK, stat_fields

ROOM_ARGUMENT = "-" * 160
"""The last argument of a command line, which provides the room for titles."""
_ROOM = {RUN_MARK: "-" * 80, NODE_MARK: "-" * 255, SUPERVISOR_MARK: "-" * 90}

_ARG_START, _ARG_END, _ENV_START, _ENV_END = range(48, 52)  # fields of /proc/self/stat, proc(5)


def room_for_marks() -> dict[str, str]:
    """Return environment variables that provide room for the marks."""
    return dict(_ROOM)


def show_title(title: str) -> None:
    """Make this process appear as `title`."""
    areas = _areas()
    _write(areas[_ARG_START], areas[_ARG_END], title.encode())


def show_mark(mark: str, text: str) -> bool:
    """Set a mark of this process; return False if its environment has no room for it."""
    areas = _areas()
    start, end = areas[_ENV_START], areas[_ENV_END]
    room = f"{mark}={_ROOM[mark]}".encode()
    at = ctypes.string_at(start, end - start).find(room)
    if at < 0:
        return False
    value = start + at + len(mark) + 1
    _write(value, start + at + len(room) + 1, text.encode())
    return True


def _areas() -> dict[int, int]:
    with open("/proc/self/stat", "rb") as file:  # noqa: PTH123 - only once per node
        stat = file.read()
    fields = stat_fields(stat)
    return {number: int(fields[number - 3]) for number in range(_ARG_START, _ENV_END + 1)}


def _write(start: int, end: int, text: bytes) -> None:
    """Write `text`, cut if necessary, and zeros up to `end`."""
    room = end - start - 1
    if room > 0:
        ctypes.memmove(start, text[:room].ljust(room + 1, b"\0"), room + 1)
