"""Other users of this machine who are in a ROS domain, as far as its UDP ports show.

DDS derives its ports from the domain (RTPS 2.2, 9.6.1.1): 250 of them, from 7400 + 250 * domain on.
The kernel shows who owns them, even where nothing else of another user's processes is visible.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.processes.owner import user_name

if TYPE_CHECKING:
    from collections.abc import Iterable

_FIRST_PORT, _PORTS_OF_A_DOMAIN = 7400, 250
_TABLES = ("/proc/net/udp", "/proc/net/udp6")


def other_users(domain: int, us: int | None = None) -> tuple[str, ...]:
    """Return the names of users other than `us` (default: this one) with ports of the domain."""
    ours = os.getuid() if us is None else us
    found: set[int] = set()
    for table in _TABLES:
        try:
            lines = Path(table).read_text(encoding="ascii").splitlines()[1:]
        except OSError:
            continue
        found |= owners(lines, domain)
    return tuple(sorted(user_name(uid) for uid in found - {ours}))


def owners(lines: Iterable[str], domain: int) -> set[int]:
    """Return the uids that own ports of this domain, from lines of /proc/net/udp."""
    first = _FIRST_PORT + _PORTS_OF_A_DOMAIN * domain
    found = set()
    for line in lines:
        fields = line.split()
        port = int(fields[1].rpartition(":")[2], 16)
        if first <= port < first + _PORTS_OF_A_DOMAIN:
            found.add(int(fields[7]))
    return found
