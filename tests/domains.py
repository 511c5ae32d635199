"""ROS domains for tests, each held by one test of this machine's at a time."""

from __future__ import annotations

import fcntl
import os
import socket
from pathlib import Path

from launcher.domain.participants import udp_sockets

DOMAINS = range(1, 102)
"""Linux's ephemeral ports leave these domains free (ROS 2 documentation, "The ROS_DOMAIN_ID")."""
SPARE = range(215, 231)
"""And these, for a machine on which somebody is in all the others."""


class DomainPool:
    """ROS domains that no other test run on this machine holds, by file locks.

    All runs together hand them out in turn, so that one comes back as late as can be: what a test
    has left in it, a discovery that is not over or a lease that has not run out, is gone by then.
    """

    def __init__(self, folder: Path, machine: str | None = None) -> None:
        """Hold none yet; `folder` is that of all runs of this user, `machine` that of all users.

        The latter names abstract sockets, which need no permission on a common folder.
        """
        self._machine = machine
        self._sockets: dict[int, socket.socket] = {}
        self._folder = folder
        self._folder.mkdir(exist_ok=True)
        self._held: dict[int, int] = {}

    def take(self) -> int:
        """Return a domain that is nobody else's until it is let go of.

        One in which somebody has ports, as a robot that runs, is the last choice.
        """
        strange = {domain_of(found.port) for found in udp_sockets()}
        for some, choice in ((DOMAINS, set(DOMAINS) - strange), (SPARE, set(SPARE) - strange), (DOMAINS, strange)):
            for _ in some:
                domain = self._next(some)
                if domain in choice and self._lock(domain):
                    return domain
        raise RuntimeError("every ROS domain is held by a test")

    def let_go(self, *domains: int) -> None:
        """Give domains back; all if none is named."""
        for domain in domains or tuple(self._held):
            os.close(self._held.pop(domain))
            if domain in self._sockets:
                self._sockets.pop(domain).close()

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


def domain_of(port: int) -> int:
    """Return the domain that a port belongs to (RTPS 2.5, section 9.6.2.3)."""
    return (port - 7400) // 250
