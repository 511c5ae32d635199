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
"""

from __future__ import annotations

import os
import socket
from collections import deque
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

FIRST = 7400
"""Of all domains. Below are ports for the news of which nodes there are; what a newcomer misses of
these is not to be prevented in this way, and of little weight: names of nodes."""
_MOST = 40
"""A domain has ports for some 120 participants; the oldest are let go."""


class BurntPorts:
    """Participants that nobody else becomes as long as this process lives."""

    def __init__(self) -> None:
        self._descriptors: deque[int] = deque()

    def keep(self, ports: Iterable[int]) -> None:
        """Let no newcomer have these ports for data."""
        for port in ports:
            if port < FIRST:
                continue
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as bound:
                try:
                    bound.bind(("", port - 1))
                except OSError:
                    continue
                self._descriptors.append(bound.detach())
        while len(self._descriptors) > _MOST:
            os.close(self._descriptors.popleft())
