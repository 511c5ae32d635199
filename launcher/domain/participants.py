"""The DDS participants of a ROS domain on this machine, as the kernel shows them.

A participant listens on two UDP ports that follow from the domain and from its number (RTPS 2.5,
9.6.2.3): an even one for discovery, and the next for data. Fast DDS has the latter's number for its
port in shared memory as well, with a lock beside it (`launcher.processes.shared_memory`), of which
the kernel tells the process. A single port says nothing: any program's socket may have it by
chance; nor does a pair without a lock into which others write and that nobody reads: whoever is
forked by a program with a participant inherits its sockets, and keeps them when it is gone.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.domain.ports import PORTS_OF_A_DOMAIN, Socket, first_port, udp_sockets
from launcher.processes.shared_memory import SHARED_MEMORY, lock_of_port, names

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

FIRST_DISCOVERY = 10
"""Discovery port of the first participant, relative to the domain's first port."""
UNREAD_S = 1.0
"""A participant that lives reads at once what arrives, and after so long even on a busy machine."""
LOCKS = Path("/proc/locks")


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
        locked = _locked_ports(ports)
        found = {
            port: LocalParticipant(port, locked.get(port, 0))
            for port in _pairs(ports, sockets)
            if not self._is_left_behind(sockets[port - 1]) or port in locked
        }
        for port in locked.keys() - found.keys():
            _take_in_memory(found, LocalParticipant(port, locked[port]), sockets)
        return sorted(found.values())

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


def _take_in_memory(found: dict[int, LocalParticipant], one: LocalParticipant, sockets: Mapping[int, Socket]) -> None:
    """Add a participant whose port in shared memory has a number that no UDP port of it has.

    Either it speaks through shared memory alone, or somebody's file was in the way of its number.
    """
    held = _sockets_of(one.pid)
    for port, other in found.items():
        if not other.pid and sockets[port].inode in held:
            found[port] = LocalParticipant(port, one.pid)
            return
    found[one.port] = one


def _sockets_of(pid: int) -> set[int]:
    """Return the inodes of a process's sockets, as far as this user may see them."""
    found = set()
    folder = f"/proc/{pid}/fd"
    for descriptor in names(Path(folder)):
        try:
            target = os.readlink(f"{folder}/{descriptor}")  # noqa: PTH115
        except OSError:
            continue
        if target.startswith("socket:["):
            found.add(int(target[len("socket:[") : -1]))
    return found


def _locked_ports(ports: range) -> dict[int, int]:
    """Return the domain's ports in shared memory that live, with the pids of who holds them."""
    try:
        held = dict(_flocks(LOCKS.read_text(encoding="ascii").splitlines()))
    except OSError:
        return {}
    found = {}
    for name in names(SHARED_MEMORY):
        port = lock_of_port(name)
        if port is None or port not in ports:
            continue
        try:
            status = (SHARED_MEMORY / name).lstat()
        except OSError:
            continue
        device = status.st_dev
        file = f"{os.major(device):02x}:{os.minor(device):02x}:{status.st_ino}"
        if file in held:
            found[port] = held[file]
    return found


def _flocks(lines: Iterable[str]) -> Iterator[tuple[str, int]]:
    """Yield device with inode, and pid, of each flock(2), from lines of /proc/locks, proc(5)."""
    for line in lines:
        fields = line.split()
        if len(fields) > 5 and fields[1] == "FLOCK":
            yield fields[5], max(int(fields[4]), 0)
