"""The DDS participants of a ROS domain on this machine, whoever's they are, as the kernel shows them.

DDS derives its ports from the domain (RTPS 2.2, 9.6.1.1): 250 of them, from 7400 + 250 * domain on.
A participant listens on two of them that follow from its number (RTPS 2.5, 9.6.2.3): an even one for
discovery, and the next for data. A single port says nothing: any program's socket may have it by chance;
nor does a pair into which others write and that nobody reads: whoever is forked by a program with a
participant inherits its sockets, and keeps them when it is gone.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from launcher.processes.owner import user_name

FIRST_PORT, PORTS_OF_A_DOMAIN = 7400, 250
_TABLES = ("/proc/net/udp", "/proc/net/udp6")
_NOBODY = "0000"
"""The port at the other end of a socket that hears everybody."""


@dataclass(frozen=True)
class Socket:
    """A UDP socket of this machine, as /proc/net/udp has it."""

    port: int
    uid: int
    inode: int
    is_listening: bool
    """Whether it is not connected to anybody."""
    unread: int = 0
    """Bytes that have arrived and that nobody has taken."""


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
    here, there = (fields[number].rpartition(":")[2] for number in (1, 2))
    unread = int(fields[4].rpartition(":")[2], 16)
    return Socket(int(here, 16), int(fields[7]), int(fields[9]), there == _NOBODY, unread)


FIRST_DISCOVERY = 10
"""Discovery port of the first participant, relative to the domain's first port."""
UNREAD_S = 1.0
"""A participant that lives reads at once what arrives, and after so long even on a busy machine."""
_LISTENER = "dds.udp."
"""Of Fast DDS's thread that reads from a port: its name ends with the number."""


@dataclass(frozen=True, order=True)
class LocalParticipant:
    """One participant on this machine."""

    port: int
    """Where it listens for data."""
    pid: int = 0
    """Its process; 0 if that cannot be known, as with other containers."""


class LocalParticipants:
    """The participants of a domain, whoever's they are."""

    def __init__(self, domain: int) -> None:
        self._domain = domain
        self._unread_since_s: dict[int, float] = {}
        """When each port was first seen with something unread, monotonic."""

    def look(self) -> list[LocalParticipant]:
        """Return those that are there now; none if the kernel shows no ports."""
        ports = range(first_port(self._domain), first_port(self._domain) + PORTS_OF_A_DOMAIN)
        sockets = {one.port: one for one in udp_sockets() if one.is_listening and one.port in ports}
        owners = _owners(sockets)
        return sorted(
            LocalParticipant(port, owners.get(port, 0))
            for port in _pairs(ports, sockets)
            if not self._is_left_behind(sockets[port - 1]) or _is_read(port - 1, owners.get(port, 0))
        )

    def _is_left_behind(self, socket: Socket) -> bool:
        """Whether others have written there for a while and nobody has read it."""
        if not socket.unread:
            self._unread_since_s.pop(socket.port, None)
            return False
        now = time.monotonic()
        return now - self._unread_since_s.setdefault(socket.port, now) > UNREAD_S


def _pairs(ports: range, sockets: Mapping[int, Socket]) -> set[int]:
    """Return the data ports beside which the port for discovery is the same user's."""
    return {
        port + 1
        for port in ports[FIRST_DISCOVERY::2]
        if port in sockets and port + 1 in sockets and sockets[port].uid == sockets[port + 1].uid
    }


def _owners(sockets: Mapping[int, Socket]) -> dict[int, int]:
    """Return the processes of these ports, as far as this user may see them."""
    found: dict[int, int] = {}
    if sockets:
        # A supervisor looks only where somebody else is in its domain.
        import psutil

        with suppress(OSError, psutil.Error):
            found = {one.laddr.port: one.pid for one in psutil.net_connections("udp") if one.pid and one.laddr}
    return {port: found[port] for port in sockets if port in found}


def _is_read(port: int, pid: int) -> bool:
    """Whether a process has a thread that would read from a port if it were not halted, or starved."""
    with suppress(OSError):
        for name in Path(f"/proc/{pid}/task").glob("*/comm"):
            with suppress(OSError):
                if name.read_text(errors="replace").strip() == f"{_LISTENER}{port}":
                    return True
    return False
