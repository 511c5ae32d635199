"""Whose ports of a ROS domain are open on this machine, as the kernel shows them.

DDS derives its ports from the domain (RTPS 2.2, 9.6.1.1): 250 of them, from 7400 + 250 * domain on.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from launcher.processes.owner import user_name

FIRST_PORT, PORTS_OF_A_DOMAIN = 7400, 250
_TABLES = ("/proc/net/udp", "/proc/net/udp6")


class Socket(NamedTuple):
    """A UDP socket of this machine."""

    port: int
    uid: int


def first_port(domain: int) -> int:
    """Return the first port of a domain."""
    return FIRST_PORT + PORTS_OF_A_DOMAIN * domain


def other_users(domain: int, us: int | None = None) -> tuple[str, ...]:
    """Return the names of users other than `us` (default: this one) with ports of the domain."""
    ours = os.getuid() if us is None else us
    found = owners(udp_sockets(), domain)
    return tuple(sorted(user_name(uid) for uid in found - {ours}))


def owners(sockets: Iterable[Socket], domain: int) -> set[int]:
    """Return the uids that own ports of this domain."""
    ports = range(first_port(domain), first_port(domain) + PORTS_OF_A_DOMAIN)
    return {socket.uid for socket in sockets if socket.port in ports}


def udp_sockets() -> Iterator[Socket]:
    """Yield the UDP sockets of this machine, or of this container; none if the kernel is silent."""
    for table in _TABLES:
        try:
            lines = Path(table).read_text(encoding="ascii").splitlines()[1:]
        except OSError:
            continue
        yield from map(read_socket, lines)


def read_socket(line: str) -> Socket:
    """Read a line of /proc/net/udp."""
    fields = line.split()
    return Socket(int(fields[1].rpartition(":")[2], 16), int(fields[7]))
