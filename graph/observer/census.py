"""Who is in the domain: by the middleware of this process, and by the kernel of this machine.

What the middleware has not found, or has lost in a load peak or in a cut of the network, it does
not know of. But each participant holds two UDP ports, whose numbers tell its domain, and the kernel
tells whose they are.
"""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import psutil

from graph.data import PROCESS_NUMBERS
from graph.scan.endpoints import publishers

if TYPE_CHECKING:
    from rclpy.node import Node

EVENTS = "/parameter_events"
"""Nearly every node publishes there, whatever else it does."""
PREFIX_BYTES = 12
"""Of an identifier: the participant, which begins with its vendor and its host, two bytes each."""
SOCKETS = Path("/proc/net/udp")
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
    ports = {port for data in range(first, first + 2 * MOST, 2) for port in (data - 1, data)}
    held = set()
    with suppress(OSError, ValueError):
        for words in map(str.split, SOCKETS.read_text().splitlines()[1:]):
            # `7: 0100007F:1D0B 00000000:0000 07 ... 0 0 709083`: the port in hexadecimal, the inode.
            if int(words[1].rpartition(":")[2], 16) in ports:
                held.add((int(words[1].rpartition(":")[2], 16), words[9]))
    return _holders(frozenset(held))


@lru_cache(maxsize=1)
def _holders(sockets: frozenset[tuple[int, str]]) -> frozenset[int]:
    """Return who has both ports of a participant; the kernel is asked once for the same sockets."""
    ports = {port for port, _ in sockets}
    held: set[tuple[int, int]] = set()
    if ports:
        with suppress(OSError, psutil.Error):
            held = {(one.laddr.port, one.pid) for one in psutil.net_connections("udp4") if one.pid and one.laddr}
    return frozenset(
        pid % PROCESS_NUMBERS for port, pid in held if port in ports and port % 2 and (port - 1, pid) in held
    )
