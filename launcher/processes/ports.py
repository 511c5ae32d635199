"""Ports of killed nodes, kept from being used again.

A Fast DDS participant listens for data on a port in shared memory. If its process is killed, the
next participant takes the same number and creates the memory again. Participants that have already
talked to the dead one keep writing into the old memory, because Fast DDS does not notice the death
of a listener that was busy at that moment. The new participant then never receives anything from
them (seen with Fast DDS 2.14; see Fast-DDS pull request 4728 and issue 5469).

The port number follows from the participant id: the first id whose UDP port for discovery is free.
That port is the one before the data port (RTPS 2.5, 9.6.2.3), so we bind it. Binding the UDP data
port itself, or holding the lock of the shared memory port, does not help: in the first case new
participants still use the same shared memory, in the second Fast DDS logs errors in them once
somebody else has removed the port.

Where a file of another user occupies a port in shared memory, Fast DDS tries two ports further up,
again and again, until it finds one it can use. Then the participant id no longer determines the
port, and the next participant with the same id gets the port of the dead one. So no participant is
given an id whose port belongs to another user.
"""

from __future__ import annotations

import os
import socket
import stat
from collections import deque
from typing import TYPE_CHECKING

from launcher.processes.shared_memory import SHARED_MEMORY

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

FIRST = 7400
"""The lowest UDP port of all domains. Lower ports in shared memory announce nodes; what newcomers
miss there cannot be prevented in this way and matters little: names of nodes."""
_DOMAIN = 250
"""Number of ports of a domain."""
_FIRST_DATA = 11
"""Data port of the first participant, relative to the first port of the domain."""
_AVOIDED = 20
"""Participant ids that are checked: without multicast only the first ones of a domain are found."""
_MOST = 40
"""Most ports kept; a domain has ports for some 120 participants, so the oldest are released."""


class BlockedPorts:
    """Participant ids that nobody else can take while this process lives."""

    def __init__(self, folder: Path = SHARED_MEMORY) -> None:
        self._descriptors: deque[int] = deque()
        self._avoided: dict[int, int] = {}
        self._folder = folder

    def keep(self, ports: Iterable[int]) -> None:
        """Keep new participants from using these data ports."""
        for port in ports:
            if port >= FIRST and (descriptor := _bind(port - 1)) is not None:
                self._descriptors.append(descriptor)
        while len(self._descriptors) > _MOST:
            os.close(self._descriptors.popleft())

    def avoid_others(self, domain: int) -> None:
        """Keep new participants from ids whose port in shared memory belongs to another user."""
        first = FIRST + _DOMAIN * domain + _FIRST_DATA
        for port in range(first, first + 2 * _AVOIDED, 2):
            if port not in self._avoided and self._is_anothers(port):
                descriptor = _bind(port - 1)
                if descriptor is not None:
                    self._avoided[port] = descriptor

    def _is_anothers(self, port: int) -> bool:
        """Whether a file at this port in shared memory is in the way of this user's nodes."""
        name = f"fastrtps_port{port}"
        for path in (self._folder / name, self._folder / f"sem.{name}_mutex"):
            try:
                found = path.lstat()
            except OSError:
                continue
            if not stat.S_ISREG(found.st_mode) or found.st_uid != os.geteuid():
                return True
        return False


def _bind(port: int) -> int | None:
    """Return the descriptor of a socket bound to this port, None if the port is in use."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as bound:
        try:
            bound.bind(("", port))
        except OSError:
            return None
        return bound.detach()
