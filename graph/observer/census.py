"""Who is in the domain: by the middleware of this process, and by the kernel of this machine.

What the middleware has not found, or has lost in a load peak or in a cut of the network, it does
not know of. But each participant of Fast DDS holds a port in shared memory, whose number tells its
domain, and the kernel tells who has locked the file beside it.
"""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from graph.data import PROCESS_NUMBERS
from graph.scan.endpoints import publishers

if TYPE_CHECKING:
    from rclpy.node import Node

EVENTS = "/parameter_events"
"""Nearly every node publishes there, whatever else it does."""
PREFIX_BYTES = 12
"""Of an identifier: the participant, which begins with its vendor and its host, two bytes each."""
SHARED_MEMORY = Path("/dev/shm")
LOCKS = Path("/proc/locks")
FIRST, OF_DOMAIN, FIRST_DATA = 7400, 250, 11
"""Ports: the first of all, how many each domain has, the first for data (RTPS 2.5, 9.6.2.3)."""
MOST = 120
"""Participants of a domain on one machine."""


@dataclass(frozen=True)
class Census:
    """Who is there at one moment."""

    known: frozenset[bytes] = frozenset()
    """Participants with nodes whose names are known, without Deck's own of this screen."""
    missing: frozenset[int] = frozenset()
    """Processes of this machine, modulo `PROCESS_NUMBERS`, that are in the domain, and of which the
    middleware knows no node."""
    is_networked: bool = False
    """Whether nodes of other machines may be found."""

    @property
    def away(self) -> frozenset[bytes]:
        """Those on other machines."""
        return self.known if self.is_networked else frozenset()


def census(node: Node, own_name: str, domain: int, is_networked: bool) -> Census:
    """Count who is in the graph, and the programs of this domain that are not."""
    ends = [end for end in publishers(node, EVENTS) if end.is_named and end.gid]
    found = {end.process for end in ends}
    others = (end.gid[:PREFIX_BYTES] for end in ends if end.node != own_name)
    missing = living(domain) - found - {os.getpid() % PROCESS_NUMBERS}
    return Census(frozenset(others), frozenset(missing), is_networked)


def living(domain: int) -> frozenset[int]:
    """Return the processes here that listen in the domain; empty if nobody tells."""
    first = FIRST + OF_DOMAIN * domain + FIRST_DATA
    files = set()
    for port in range(first, first + 2 * MOST, 2):
        with suppress(OSError):
            file = (SHARED_MEMORY / f"fastrtps_port{port}_el").stat()
            files.add(_as_in_locks(file.st_dev, file.st_ino))
    if not files:
        return frozenset()
    found = set()
    with suppress(OSError, ValueError):
        for words in map(str.split, LOCKS.read_text().splitlines()):
            # `1: FLOCK ADVISORY WRITE 698 00:1b:709083 0 EOF`; one who waits has an arrow.
            if words[1] == "FLOCK" and words[5] in files:
                found.add(int(words[4]) % PROCESS_NUMBERS)
    return frozenset(found - {0})


def _as_in_locks(device: int, inode: int) -> str:
    return f"{os.major(device):02x}:{os.minor(device):02x}:{inode}"
