"""The relay of camera pictures that a session has whose nodes can be seen from other machines."""

from __future__ import annotations

import asyncio
import contextlib
import json
import time
from typing import TYPE_CHECKING

from launcher.spawn_server.spawner import SpawnError, SpawnRequest
from launcher.supervisor.helper import helping

if TYPE_CHECKING:
    from launcher.processes.exit import Reaper
    from launcher.spawn_server.spawner import Spawner
    from launcher.supervisor.plan import Plan

MODULE = "graph.picture_relay"
AFTER_S, LONGEST_S = 3.0, 60.0
"""The nodes go first. So long after the end of one relay another is started: twice as long each
time, unless it has worked for a while."""


async def relay_pictures(plan: Plan, spawner: Spawner, reaper: Reaper) -> None:
    """Keep the relay running until this is cancelled; a local session needs none."""
    if plan.discovery == "localhost":
        return
    where = json.dumps([plan.domain, plan.discovery])
    request = SpawnRequest("module", "deck_relay", "deck: relay", (MODULE, where), "/", plan.env)
    after_s = AFTER_S
    while True:
        await asyncio.sleep(after_s)
        began_s = time.monotonic()
        with contextlib.suppress(SpawnError):
            async with helping(spawner, reaper, request) as words:
                async for _line in words:
                    pass
        lasted = time.monotonic() - began_s > LONGEST_S
        after_s = AFTER_S if lasted else min(2 * after_s, LONGEST_S)
