"""Ports of nodes that a test has killed or that hung, kept from those that are started next.

Whoever has talked to a killed node goes on talking to it: see `launcher.processes.ports`. A
launcher sees to that for the nodes that it starts anew; here it is a test that does.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from launcher.processes.ports import BlockedPorts
from launcher.processes.shared_memory import SHARED_MEMORY, held_segments, port_numbers, sweep

if TYPE_CHECKING:
    from collections.abc import Iterable

_BLOCKED = BlockedPorts()


def held_by(pids: Iterable[int]) -> set[str]:
    """Return what these processes hold in shared memory, before they are killed."""
    return {name for pid in pids for name in held_segments(pid)}


def burn(held: set[str], *, hung: bool = False) -> None:
    """Remove what is left of it, and let nobody have those ports, or any if the node has `hung`."""
    left = {name for name in held if (SHARED_MEMORY / f"{name}_el").exists()}
    # Also those that cannot be removed: a process that still writes there may hold the lock for a
    # moment, to see whether anybody else does.
    _BLOCKED.keep(port_numbers(held if hung else left))
    sweep(left)
