"""Who is outside a session, on a real graph: known by the process, whatever its name."""

from __future__ import annotations

import sys
from functools import partial
from typing import TYPE_CHECKING

from tests.ros.observing import Peer
from tests.ros.supervised import running_pid
from tests.waiting import until
from tui.session.outside import Outside

if TYPE_CHECKING:
    from launcher.client.client import SupervisorClient
    from tests.ros.observing import Watcher
    from tests.ros.supervised import Launch

OTHER_NAME = [sys.executable, "-m", "nodes.hello", "--ros-args", "-r", "__node:=called_otherwise"]


def outside(watcher: Watcher, client: SupervisorClient) -> tuple[str, ...]:
    found = Outside()
    found.see(watcher.update, client.nodes, client.session.run_id)
    return found.now


def processes(watcher: Watcher, name: str) -> tuple[int, ...]:
    row = watcher.node(name)
    return row.processes if row else ()


async def test_it_is_told_by_the_process_and_not_by_the_name(
    start: Launch, watcher: Watcher, ros_domain: int
) -> None:
    client = await start({"ours": {"run": "nodes.hello"}, "key": {"exec": OTHER_NAME}})
    await running_pid(client, "ours")
    for name in ("/ours", "/called_otherwise"):
        await until(partial(processes, watcher, name), f"{name} and its process")
    assert outside(watcher, client) == ()
    by_hand = [Peer("by_hand", ros_domain), Peer("ours", ros_domain)]
    try:
        await until(
            lambda: outside(watcher, client) == ("/ours", "by_hand"), "a node and a namesake"
        )
    finally:
        for peer in by_hand:
            peer.close()
    await until(lambda: outside(watcher, client) == (), "nobody outside")
    assert watcher.node("/ours")
