"""The kernel's table of processes, read from /proc: parents, groups and sessions.

Times are kernel ticks since boot, as /proc gives them: two processes with the same number never
have the same start.
"""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from text.run_path import OWN_RUN_DIR, RUN_ID

TICKS_PER_S = os.sysconf("SC_CLK_TCK")

RUN_MARK = RUN_ID
"""Environment variable that says which run of Deck a process belongs to."""
NODE_MARK = "DECK_NODE"
"""Environment variable that says which node of that run a process is, or descends from."""

SUPERVISOR_MARK = "DECK_SUPERVISOR"
"""Environment variable of a supervisor: the id of its run, and the descriptor of its folder."""

GUARDIAN_NAME = "deck guardian"
"""The kernel's short name of every guardian, see `launcher.supervisor.guardian`."""

_EXEC_WITHIN_S = 0.1
_EXEC_LOOK_EVERY_S = 0.0005


@dataclass(frozen=True)
class Process:
    """A process as /proc/PID/stat has it; `started_ticks` with `pid` names it for good."""

    pid: int
    name: str
    """The kernel's short name, at most 15 bytes."""
    state: str
    """One letter: R S D Z T, see proc(5)."""
    parent: int
    group: int
    session: int
    started_ticks: int
    cpu_ticks: int
    """CPU time used so far, user and system."""
    threads: int = 1

    @property
    def zombie(self) -> bool:
        """Whether it has ended and is only waiting to be reaped.

        A process whose first thread alone has ended looks the same, but for its threads.
        """
        return self.state in "ZX" and self.threads <= 1

    @property
    def suspended(self) -> bool:
        """Whether a signal has stopped it, until another lets it go on."""
        return self.state == "T"


def read_process(pid: int) -> Process | None:
    """Return the process with this number, None if there is none."""
    try:
        stat = _read(pid, "stat")
    except (FileNotFoundError, ProcessLookupError):
        return None
    name = stat[stat.index(b"(") + 1 : stat.rindex(b")")]
    fields = stat_fields(stat)
    return Process(
        pid=pid,
        name=name.decode(errors="replace"),
        state=chr(fields[0][0]),
        parent=int(fields[1]),
        group=int(fields[2]),
        session=int(fields[3]),
        started_ticks=int(fields[19]),
        cpu_ticks=int(fields[11]) + int(fields[12]),
        threads=int(fields[17]),
    )


def _read(pid: int, file_name: str) -> bytes:
    with open(f"/proc/{pid}/{file_name}", "rb") as file:  # noqa: PTH123 - called for every process
        return file.read()


def stat_fields(stat: bytes) -> list[bytes]:
    """Return the fields of /proc/PID/stat, proc(5), from the third on."""
    # The name is in parentheses and may itself contain blanks and parentheses.
    return stat[stat.rindex(b")") + 2 :].split()


def process_numbers() -> list[int]:
    """Return the number of every process that this user can see."""
    # Path objects would cost more than all the rest.
    return [int(entry) for entry in os.listdir("/proc") if entry.isdigit()]  # noqa: PTH208


def processes() -> Iterator[Process]:
    """Yield every process that this user can see."""
    for pid in process_numbers():
        process = read_process(pid)
        if process is not None:
            yield process


def own_number(pid: int) -> int:
    """Return what a process takes for its pid: in a container it is another than out here."""
    with contextlib.suppress(OSError):
        for line in _read(pid, "status").splitlines():
            if line.startswith(b"NSpid:"):
                return int(line.split()[-1])
    return pid


def read_marks(pid: int) -> Mapping[str, str] | None:
    """Return Deck's variables in a process's environment; None if that cannot be read."""
    environ = _environ(pid)
    if environ is None:
        return None
    if b"DECK_" not in environ:
        return {}
    found = {}
    for entry in environ.split(b"\0"):
        name, _, value = entry.partition(b"=")
        if name in _MARKS:
            found[name.decode()] = value.decode(errors="replace")
    return found


def read_environment(pid: int, name: str) -> str:
    """Return one variable of a process's environment, empty if it is missing or not readable."""
    for entry in (_environ(pid) or b"").split(b"\0"):
        key, _, value = entry.partition(b"=")
        if key == name.encode():
            return value.decode(errors="replace")
    return ""


def _environ(pid: int) -> bytes | None:
    """Return a process's environment; None if it may not be read, or is not there yet.

    In the middle of execve(2) there is none for a moment. That must not be mistaken for a process
    of another user, so we wait for it.
    """
    deadline = time.monotonic() + _EXEC_WITHIN_S
    try:
        environ = _read(pid, "environ")
        while not environ:
            was_being_executed = _is_being_executed(pid)
            environ = _read(pid, "environ")
            if not was_being_executed:
                break
            if time.monotonic() > deadline:
                return None
            time.sleep(_EXEC_LOOK_EVERY_S)
    except OSError:
        return None
    return environ


def _is_being_executed(pid: int) -> bool:
    """Whether a process is in the middle of execve(2): it has memory, but no code in it yet."""
    fields = stat_fields(_read(pid, "stat"))
    return bool(int(fields[20])) and not int(fields[23])


_MARKS = frozenset(mark.encode() for mark in (RUN_MARK, NODE_MARK, SUPERVISOR_MARK, OWN_RUN_DIR))


def command_line(pid: int) -> str:
    """Return what `ps` shows as the command, empty if the process has gone."""
    try:
        with open(f"/proc/{pid}/cmdline", "rb") as file:  # noqa: PTH123
            return file.read(4096).replace(b"\0", b" ").decode(errors="replace").strip()
    except OSError:
        return ""


def boot_time_s() -> float:
    """Return when the machine was booted, in unix time, to the second."""
    return round(time.time() - time.clock_gettime(time.CLOCK_BOOTTIME))
