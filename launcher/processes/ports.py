"""Ports of killed nodes, kept from being used again.

A participant of Fast DDS listens for data on a port in shared memory. If its process is killed, the
next one takes the same number and makes the memory anew; but who has already talked to the dead one
goes on writing into the old memory, for Fast DDS misses the death of a listener that was just at
work. The newcomer then never hears of them (seen with Fast DDS 2.14; Fast-DDS pull request 4728 and
issue 5469 tell of it).

The number comes from that of the participant: the first whose UDP port for discovery is free, and
that port is the one before the port for data (RTPS 2.5, 9.6.2.3). So that one is bound. To bind the
UDP port for data itself, or to keep the lock of the one in shared memory, does not do: the first
leaves newcomers on the same shared memory, by the second they log errors of Fast DDS once somebody
else has removed it.

Where a file of another user lies at a port in shared memory, Fast DDS goes two ports up, and up
again, until it can have one: then the number tells nothing, and the next one with the same number
has the port of the dead one. So nobody gets a number whose port is another user's.
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
"""Of all domains. Below are ports for the news of which nodes there are; what a newcomer misses of
these is not to be prevented in this way, and of little weight: names of nodes."""
_DOMAIN = 250
"""Ports of a domain."""
_FIRST_DATA = 11
"""Port for data of its first participant, counted from the first of the domain."""
_AVOIDED = 20
"""Participants that are looked at: without multicast only the first of a domain are found."""
_MOST = 40
"""A domain has ports for some 120 participants; the oldest are let go."""


class BurntPorts:
    """Participant ids that nobody else can take while this process lives."""

    def __init__(self, folder: Path = SHARED_MEMORY) -> None:
        self._descriptors: deque[int] = deque()
        self._avoided: dict[int, int] = {}
        self._folder = folder

    def keep(self, ports: Iterable[int]) -> None:
        """Let no newcomer have these ports for data."""
        for port in ports:
            if port >= FIRST and (descriptor := _bind(port - 1)) is not None:
                self._descriptors.append(descriptor)
        while len(self._descriptors) > _MOST:
            os.close(self._descriptors.popleft())

    def avoid_others(self, domain: int) -> None:
        """Let no newcomer have a number whose port in shared memory is another user's."""
        first = FIRST + _DOMAIN * domain + _FIRST_DATA
        for port in range(first, first + 2 * _AVOIDED, 2):
            if port not in self._avoided and self._is_anothers(port):
                descriptor = _bind(port - 1)
                if descriptor is not None:
                    self._avoided[port] = descriptor

    def _is_anothers(self, port: int) -> bool:
        """Whether something at this port in shared memory is in the way of this user's nodes."""
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
    """Return the descriptor of a socket that has this port, None if it is somebody's."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as bound:
        try:
            bound.bind(("", port))
        except OSError:
            return None
        return bound.detach()
