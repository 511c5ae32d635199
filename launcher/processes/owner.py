"""The owner of a process, in words: user, terminal, and where they have logged in from."""

from __future__ import annotations

import os
import pwd

from launcher.processes.table import read_environment, stat_fields
from launcher.status import Who
from text.sentences import Words, say

_PTS_MAJORS = range(136, 144)
_VT_MAJOR = 4


def who_words(who: Who) -> Words:
    """Describe a user in a few words."""
    if who.tty and who.host:
        return say("{user} on {tty} from {host} (pid {pid})", **vars(who))
    if who.tty:
        return say("{user} on {tty} (pid {pid})", **vars(who))
    if who.host:
        return say("{user} from {host} (pid {pid}, no terminal)", **vars(who))
    return say("{user} (pid {pid}, no terminal)", **vars(who))


def who_runs(pid: int) -> Who:
    """Return the owner of a process; fields that cannot be found out are empty."""
    try:
        with open(f"/proc/{pid}/stat", "rb") as file:  # noqa: PTH123 - like all reads of /proc
            tty = _terminal(int(stat_fields(file.read())[4]))
            user = user_name(os.fstat(file.fileno()).st_uid)
    except OSError:
        return Who(pid)
    host = read_environment(pid, "SSH_CONNECTION").split(" ")[0]
    return Who(pid, user, tty, host)


def _terminal(device: int) -> str:
    """Return the name of a terminal from its device number, see tty(4) and pts(4)."""
    major, minor = os.major(device), os.minor(device)
    if major in _PTS_MAJORS:
        return f"pts/{(major - _PTS_MAJORS.start) * 256 + minor}"
    return f"tty{minor}" if major == _VT_MAJOR else ""


def user_name(uid: int) -> str:
    """Return a user's name, or the uid if there is no name for it."""
    try:
        return pwd.getpwuid(uid).pw_name
    except KeyError:
        return str(uid)
