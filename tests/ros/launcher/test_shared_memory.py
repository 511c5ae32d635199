"""What killed processes leave in /dev/shm does not hold up those that are started after them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from launcher.status import NodeState
from tests.ros.supervised import Launch, until_state
from tests.unfinished_shared_memory import make_old

if TYPE_CHECKING:
    from pathlib import Path

NODE = {"node": {"run": "nodes.hello"}}


async def test_nodes_start_where_a_process_was_killed_as_it_joined(
    unfinished: list[Path], start: Launch
) -> None:
    make_old(unfinished)
    client = await start(NODE)
    await until_state(client, "node", NodeState.READY)


@pytest.mark.usefixtures("unfinished")
async def test_nodes_that_a_killed_process_holds_up_are_let_go(start: Launch) -> None:
    """The files are young when the nodes start: they may yet be finished, and are waited for."""
    client = await start(NODE)
    await until_state(client, "node", NodeState.READY)
