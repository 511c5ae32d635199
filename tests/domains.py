"""ROS domains for tests, each held by one test of this machine's at a time."""

from __future__ import annotations

import fcntl
import os
import re
import socket
from pathlib import Path

from launcher.processes.shared_memory import SHARED_MEMORY, names, port_numbers, sweep
from launcher.processes.shared_memory_held import release_held
from launcher.processes.shared_memory_unfinished import discard_unfinished

DOMAINS = range(1, 102)
"""Linux's ephemeral ports leave these domains free (ROS 2 documentation, "The ROS_DOMAIN_ID")."""
SPARE = range(215, 231)
"""And these, for a machine on which other users have left something in all the others."""
_PART = re.compile(r"(?:sem\.)?fastrtps_port(\d+)(?:_el|_mutex)?")
"""Whichever of them is another user's, the port cannot be opened."""


class DomainPool:
    """ROS domains that no other test run on this machine holds, by file locks.

    All runs together hand them out in turn, so that one comes back as late as can be: what a test
    has left in it, a discovery that is not over or a lease that has not run out, is gone by then.
    """

    def __init__(self, folder: Path, shared_memory: Path = SHARED_MEMORY, machine: str | None = None) -> None:
        """Hold none yet; `folder` is that of all runs of this user, `machine` that of all users.

        The latter names abstract sockets, which need no permission on a common folder.
        """
        self._machine = machine
        self._sockets: dict[int, socket.socket] = {}
        self._folder = folder
        self._shared_memory = shared_memory
        self._folder.mkdir(exist_ok=True)
        self._held: dict[int, int] = {}

    def take(self) -> int:
        """Return a domain that is nobody else's until it is let go of.

        Tests kill processes at any moment, and a node that a test starts by itself has no Deck
        that clears its way. Where another user has ports, with a node or without, it would be
        given other ones than tests reckon with: such a domain is the last choice, and so is one in
        which somebody's robot runs.
        """
        discard_unfinished(self._shared_memory)
        release_held(self._shared_memory)
        parts = list(filter(None, map(_PART.fullmatch, names(self._shared_memory))))
        alive = _held_files()
        strange = {
            domain_of(int(part[1])) for part in parts if self._is_strange(part[0]) or self._identity(part[0]) in alive
        }
        for some, choice in ((DOMAINS, set(DOMAINS) - strange), (SPARE, set(SPARE) - strange), (DOMAINS, strange)):
            for _ in some:
                domain = self._next(some)
                if domain in choice and self._lock(domain):
                    self._sweep(domain)
                    return domain
        raise RuntimeError("every ROS domain is held by a test")

    def let_go(self, *domains: int) -> None:
        """Give domains back, without the ports of killed nodes; all if none is named."""
        for domain in domains or tuple(self._held):
            self._sweep(domain)
            os.close(self._held.pop(domain))
            if domain in self._sockets:
                self._sockets.pop(domain).close()

    def _sweep(self, domain: int) -> None:
        """Remove what killed nodes have left; of a run that was killed before it let go, too."""
        ports = (number for number in self._ports() if domain_of(number) == domain)
        sweep([f"fastrtps_port{number}" for number in ports], self._shared_memory)
        self._remove_semaphores(domain)

    def _remove_semaphores(self, domain: int) -> None:
        """Remove what Fast DDS leaves of each port: no other user could open one of that number."""
        for name in names(self._shared_memory):
            part = _PART.fullmatch(name)
            if part is None or not name.startswith("sem.") or domain_of(int(part[1])) != domain:
                continue
            port = self._shared_memory / f"fastrtps_port{part[1]}"
            if not port.exists() and not self._is_strange(name):
                (self._shared_memory / name).unlink(missing_ok=True)

    def _ports(self) -> list[int]:
        found = names(self._shared_memory)
        return port_numbers(name for name in found if name.removeprefix("fastrtps_port").isdigit())

    def _is_strange(self, name: str) -> bool:
        try:
            owner = (self._shared_memory / name).lstat().st_uid
        except FileNotFoundError:
            return False
        return owner != os.geteuid()

    def _identity(self, name: str) -> tuple[int, int] | None:
        """Device and inode of a file; None if it has gone."""
        try:
            found = (self._shared_memory / name).lstat()
        except FileNotFoundError:
            return None
        return found.st_dev, found.st_ino

    def _lock(self, domain: int) -> bool:
        lock = os.open(self._folder / str(domain), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(lock)
            return False
        if not self._lock_for_all_users(domain):
            os.close(lock)
            return False
        self._held[domain] = lock
        return True

    def _lock_for_all_users(self, domain: int) -> bool:
        if self._machine is None:
            return True
        bound = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        try:
            bound.bind(f"\0{self._machine}-{domain}")
        except OSError:
            bound.close()
            return False
        self._sockets[domain] = bound
        return True

    def _next(self, some: range) -> int:
        """The domain whose turn it is, and it will be that of the next one."""
        with (self._folder / "turn").open("a+") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            file.seek(0)
            turn = int(file.read() or 0)
            file.truncate(0)
            file.write(str(turn + 1))
        return some[turn % len(some)]


def _held_files() -> set[tuple[int, int]]:
    """Device and inode of each file that somebody holds by a lock (proc_locks(5)).

    To try the lock of a port would be in the way of the node that is just making it.
    """
    found = set()
    for line in Path("/proc/locks").read_text().splitlines():
        major, minor, inode = line.split()[-3].split(":")
        found.add((os.makedev(int(major, 16), int(minor, 16)), int(inode)))
    return found


def domain_of(port: int) -> int:
    """Return the domain that a port belongs to (RTPS 2.5, section 9.6.2.3)."""
    return (port - 7400) // 250
