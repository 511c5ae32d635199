"""Ports of killed nodes, kept from being used again.

A participant of Fast DDS listens on a shared-memory port that has the number of its UDP port. If
its process is killed, the next one takes the first UDP port that is free, so the same number, and
makes the shared memory anew; but who has already talked to the dead one goes on writing into the
old memory, for Fast DDS misses the death of a listener that was just at work. The newcomer then
never hears of them (seen with Fast DDS 2.14; Fast-DDS pull request 4728 tells of it). While the
UDP port is bound, newcomers take another number, and all is well.
"""

from __future__ import annotations

import os
import socket
from collections import deque
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

_MOST = 40
"""A domain has ports for some 120 participants, of whom each has two; the oldest are let go."""


class BurntPorts:
    """UDP ports that nobody else gets as long as this process lives."""

    def __init__(self) -> None:
        self._descriptors: deque[int] = deque()

    def keep(self, ports: Iterable[int]) -> None:
        """Bind those of these ports that are free."""
        for port in ports:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as bound:
                try:
                    bound.bind(("", port))
                except OSError:
                    continue
                self._descriptors.append(bound.detach())
        while len(self._descriptors) > _MOST:
            os.close(self._descriptors.popleft())
