"""What agents have proposed: each proposal is carried out once, soon, or not at all."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from agents.refusal import refused

if TYPE_CHECKING:
    from agents.motion import Motion

EXECUTED_WITHIN_S = 60.0
"""An older proposal is about a situation that is no more."""
MAX_OPEN = 16
"""Most proposals of all agents that wait; older ones make way."""


@dataclass(frozen=True)
class Proposal:
    """What an agent has proposed."""

    id: str
    agent: str
    """The key of the agent, the only one that may have it carried out."""
    run_id: str
    """The session it was made for."""
    motion: Motion
    reason: str
    made_s: float
    """On the clock of the book."""


class ProposalBook:
    """The proposals that have not been carried out."""

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        self._now = now
        self._open: dict[str, Proposal] = {}
        self._last = 0

    def add(self, agent: str, run_id: str, motion: Motion, reason: str) -> Proposal:
        """Add a proposal; its id was never used before."""
        self._last += 1
        made = Proposal(f"p{self._last}", agent, run_id, motion, reason, self._now())
        self._open[made.id] = made
        while len(self._open) > MAX_OPEN:
            del self._open[next(iter(self._open))]
        return made

    def take(self, name: str, agent: str, run_id: str) -> Proposal:
        """Take a proposal out to carry it out.

        Raises:
            RefusedError: if it is not there any more, or belongs to another agent or session.
        """
        found = self._open.get(name)
        if found is None or found.agent != agent:
            raise refused(
                "there is no proposal {name!r}: each is carried out once, and an emergency stop "
                "ends them all; make a new one",
                name=name,
            )
        del self._open[name]
        if self._now() - found.made_s > EXECUTED_WITHIN_S:
            raise refused("the proposal is older than {seconds:g} s; make a new one", seconds=EXECUTED_WITHIN_S)
        if found.run_id != run_id:
            raise refused("the proposal was made for another session; make a new one")
        return found

    def clear(self) -> None:
        """Forget them all: an emergency stop."""
        self._open.clear()
