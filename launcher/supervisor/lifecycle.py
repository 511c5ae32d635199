"""Waiting for a node with a lifecycle to be in a state, and bringing it there."""

from __future__ import annotations

import contextlib
import json
from typing import TYPE_CHECKING

from launcher.spawn_server.spawner import SpawnError, SpawnRequest
from launcher.supervisor.helper import helping
from launcher.supervisor.readiness import Seen, UnwatchableError
from text.nested import read_json

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from launcher.processes.exit import Reaper
    from launcher.spawn_server.spawner import Spawner
    from launcher.supervisor.readiness import ReadyCondition

LIFECYCLE = "lifecycle"
"""The kind of conditions that these are."""
ATTEMPTS = 3
"""After so many processes that ended without a word, the node counts as unwatchable."""


class NotBroughtUpError(Exception):
    """The node will not get into the wanted state."""

    def __init__(self, transition: str, state: str) -> None:
        """Store the transition that failed, empty if none was possible, and the state it is in."""
        super().__init__(transition, state)
        self.transition = transition
        self.state = state


class LifecycleWaits:
    """Each wait has a process of its own, which ends with it."""

    def __init__(self, spawner: Spawner, reaper: Reaper, env: Mapping[str, str | None]) -> None:
        """`env`: the variables that a process needs to join the right domain."""
        self._spawner = spawner
        self._reaper = reaper
        self._env = env

    async def until(self, condition: ReadyCondition, tell: Callable[[Seen], None]) -> None:
        """Return once the node is in the wanted state; until then `tell` gets every other state.

        Raises:
            NotBroughtUpError: if a transition to that state has failed.
            UnwatchableError: if the graph cannot be watched.
        """
        for _attempt in range(ATTEMPTS):
            if await self._one_process(condition, tell):
                return
        raise UnwatchableError

    async def _one_process(self, condition: ReadyCondition, tell: Callable[[Seen], None]) -> bool:
        """Listen to one process; return whether the state was reached before it ended."""
        wanted = json.dumps([condition.name, condition.type, condition.goes])
        request = SpawnRequest("lifecycle", "deck_lifecycle", "deck: lifecycle", (wanted,), "/", self._env)
        with contextlib.suppress(SpawnError, ValueError):
            async with helping(self._spawner, self._reaper, request) as reports:
                async for line in reports:
                    told = read_json(line)
                    if told["state"] == condition.type:
                        return True
                    if "failed" in told:
                        raise NotBroughtUpError(told["failed"], told["state"])
                    tell(Seen((told["state"],)))
        return False
