"""What killed processes leave in /dev/shm does not hold up those that are started after them."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from launcher.process_shm import SHARED_MEMORY
from launcher.status import NodeState
from tests.ros.supervised import Launch, until_state

if TYPE_CHECKING:
    from collections.abc import Iterator

    from launcher.client import SupervisorClient

PORT_BYTES = 52_400
"""As large as Fast DDS makes it."""
PARTICIPANTS = 4
NODE = {"node": {"run": "nodes.hello"}}


@pytest.fixture
def half_made(ros_domain: int) -> Iterator[list[Path]]:
    """The ports of this domain, as they are while Fast DDS makes them.

    The numbers are those of RTPS 2.5, section 9.6.2.3, for the unicast of users.
    """
    first = 7411 + 250 * ros_domain
    paths = [SHARED_MEMORY / f"fastrtps_port{first + 2 * at}" for at in range(PARTICIPANTS)]
    for path in paths:
        path.write_bytes(b"\1".ljust(PORT_BYTES, b"\0"))
    yield paths
    for path in paths:
        path.unlink(missing_ok=True)
        path.with_name(f"{path.name}_el").unlink(missing_ok=True)


async def told(client: SupervisorClient) -> bool:
    """Whether the log says what was in the way."""
    lines = await client.history("deck", 100)
    return any("half made by a process that was killed" in line.text for line in lines)


async def test_nodes_start_where_a_process_was_killed_as_it_joined(
    half_made: list[Path], start: Launch
) -> None:
    then = time.time() - 60.0
    for path in half_made:
        os.utime(path, (then, then))
    client = await start(NODE)
    await until_state(client, "node", NodeState.READY)
    assert await told(client)


@pytest.mark.usefixtures("half_made")
async def test_nodes_that_a_killed_process_holds_up_are_let_go(
    start: Launch,
) -> None:
    """The files are young when the nodes start: they may yet be finished, and are waited for."""
    client = await start(NODE)
    await until_state(client, "node", NodeState.READY)
    assert await told(client)
